// A folder of keys that goes with the test.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "services/base/trust/key_folder.h"

namespace beckon::trust {

class TemporaryKeys {
 public:
  TemporaryKeys() {
    std::string name = (std::filesystem::temp_directory_path() / "beckon-keys-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  explicit TemporaryKeys(const std::string& node, Roles may = Roles::All()) : TemporaryKeys() {
    public_file_ = *folder().Make(node, may);
  }
  ~TemporaryKeys() { std::filesystem::remove_all(path_); }
  TemporaryKeys(const TemporaryKeys&) = delete;
  TemporaryKeys& operator=(const TemporaryKeys&) = delete;

  const std::string& path() const { return path_; }
  const std::string& public_file() const { return public_file_; }
  KeyFolder folder() const { return KeyFolder(path_); }

 private:
  std::string path_, public_file_;
};

}  // namespace beckon::trust
