// Where a run leaves its logs: a folder that goes when the run went well.
#pragma once

#include <string>

#include "services/base/result.h"

namespace beckon::tool {

class RunFolder {
 public:
  /// `path`, made where it is missing and kept; or, where empty, a new temporary folder named after
  /// `name`.
  static Result<RunFolder> Make(const std::string& path, const std::string& name);
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;
  /// Removes a temporary one, unless it is to be kept.
  ~RunFolder();

  const std::string& path() const { return path_; }
  void Keep() { temporary_ = false; }

 private:
  RunFolder(std::string path, bool temporary) : path_(std::move(path)), temporary_(temporary) {}

  std::string path_;
  bool temporary_;
};

}  // namespace beckon::tool
