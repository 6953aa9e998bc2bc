#include "tools/beckon/log_tools.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace beckon::tool {
namespace {

namespace fs = std::filesystem;

/// The sync word that every event of an LCM log begins with.
constexpr std::array<unsigned char, 4> kSync{0xed, 0xa1, 0xda, 0x01};

Status Become(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  for (const auto& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  execvp(argv[0], argv.data());
  return Error{command[0] + " cannot be started: " + std::strerror(errno) +
               "; install the package liblcm-bin"};
}

}  // namespace

Status Record(const std::string& log, const std::string& lcm_url) {
  if (fs::exists(log))
    return Error{"--out " + log + ": exists already; choose another name or remove it"};
  if (lcm_url.starts_with("udpm:") && lcm_url.find("recv_buf_size=") == std::string::npos) {
    return Error{"--lcm-url " + lcm_url +
                 ": without recv_buf_size=2097152 most frames are lost; add it"};
  }
  return Become({"lcm-logger", "--lcm-url=" + lcm_url, log});
}

Status Replay(const std::string& log, const std::string& lcm_url, double speed) {
  std::ifstream file(log, std::ios::binary);
  if (!file)
    return Error{log + ": cannot be read; expected a log of lcm-logger or 'beckon record'"};
  std::array<char, 4> head{};
  if (!file.read(head.data(), head.size()) ||
      std::memcmp(head.data(), kSync.data(), head.size()) != 0) {
    return Error{log + ": is no LCM log; expected a log of lcm-logger or 'beckon record'"};
  }
  return Become({"lcm-logplayer", "--speed=" + std::to_string(speed), "--lcm-url=" + lcm_url, log});
}

}  // namespace beckon::tool
