#include "tools/beckon/run_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

namespace beckon::tool {

namespace fs = std::filesystem;

Result<RunFolder> RunFolder::Make(const std::string& path, const std::string& name) {
  std::error_code error;
  if (!path.empty()) {
    fs::create_directories(path, error);
    if (error) return Error{path + ": the folder cannot be made: " + error.message()};
    return RunFolder(fs::absolute(path).string(), false);
  }
  std::string pattern = (fs::temp_directory_path(error) / (name + "-XXXXXX")).string();
  if (mkdtemp(pattern.data()) == nullptr) {
    return Error{pattern + ": no temporary folder can be made: " + std::strerror(errno) +
                 "; set TMPDIR"};
  }
  return RunFolder(pattern, true);
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, false)) {}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (temporary_) fs::remove_all(path_, ignored);
}

}  // namespace beckon::tool
