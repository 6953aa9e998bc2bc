#include "services/ui_bridge/web/access_token.h"

#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>

#include "services/ui_bridge/web/settings_store.h"

namespace beckon::ui_bridge::web {
namespace {

constexpr size_t kDigits = 32;

bool IsToken(const std::string& text) {
  return text.size() == kDigits && std::ranges::all_of(text, [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

bool IsPrivate(const std::string& path) {
  struct stat file {};
  return lstat(path.c_str(), &file) == 0 && S_ISREG(file.st_mode) && file.st_uid == geteuid() &&
         (file.st_mode & 077) == 0;
}

}  // namespace

Result<std::string> LoadOrMakeToken(const std::string& path) {
  if (IsPrivate(path)) {
    std::string kept;
    std::ifstream(path) >> kept;
    if (IsToken(kept)) return kept;
  }
  std::array<uint8_t, kDigits / 2> bytes;
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return Error{"the system gives no random numbers for a token"};
  std::string token;
  for (const uint8_t byte : bytes) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  if (auto written = WriteWhole(path, token + "\n"); !written) return written.error();
  return token;
}

}  // namespace beckon::ui_bridge::web
