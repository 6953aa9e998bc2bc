// The files of the page, read into memory once: what is not among them cannot be asked for.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "services/base/result.h"

namespace beckon::ui_bridge::web {

struct PageFile {
  std::string content_type;
  std::string etag;  // of its content, quoted
  std::shared_ptr<const std::string> bytes;
};

/// By path: "/" (index.html), "/page.js", "/i18n/de.json".
using PageFiles = std::map<std::string, PageFile>;

/// All *.html *.js *.css *.json *.svg *.png *.ico *.webmanifest below `folder`; anything else in it
/// is left out. Fails where there is no index.html, or a file is larger than 1 MB.
Result<PageFiles> ReadPageFiles(const std::string& folder);

}  // namespace beckon::ui_bridge::web
