#include "services/ui_bridge/web/page_files.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace beckon::ui_bridge::web {
namespace {

namespace fs = std::filesystem;

constexpr uintmax_t kMostBytes = 1 << 20;

const std::map<std::string, std::string>& ContentTypes() {
  static const std::map<std::string, std::string> types = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".ico", "image/x-icon"},
      {".webmanifest", "application/manifest+json"}};
  return types;
}

/// FNV-1a, 64 bit: tells one version of a file from another.
std::string Etag(const std::string& bytes) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  char text[24];
  std::snprintf(text, sizeof text, "\"%016llx\"", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace

Result<PageFiles> ReadPageFiles(const std::string& folder) {
  PageFiles files;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& path = entry->path();
    const auto type = ContentTypes().find(path.extension().string());
    if (!entry->is_regular_file() || type == ContentTypes().end()) continue;
    if (entry->file_size() > kMostBytes)
      return Error{path.string() + ": a file of the page may have 1 MB at most"};
    std::ostringstream bytes;
    if (std::ifstream file(path, std::ios::binary); !file || !(bytes << file.rdbuf()))
      return Error{path.string() + ": cannot be read, or is empty"};
    const std::string url = "/" + fs::relative(path, folder).generic_string();
    files[url == "/index.html" ? "/" : url] = {type->second, Etag(bytes.str()),
                                               std::make_shared<const std::string>(bytes.str())};
  }
  if (error) return Error{folder + ": the page's files cannot be read: " + error.message()};
  if (!files.contains("/"))
    return Error{folder + ": there is no index.html among the page's files"};
  return files;
}

}  // namespace beckon::ui_bridge::web
