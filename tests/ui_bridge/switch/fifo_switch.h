// A switch made of a FIFO: what is written to it is what a kernel would send for a device.
#pragma once

#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace beckon::ui_bridge {

inline std::vector<uint8_t> EventBytes(int type, int code, int value, int64_t at_us = 1'000'000) {
  input_event event{};
  event.input_event_sec = at_us / 1'000'000;
  event.input_event_usec = at_us % 1'000'000;
  event.type = static_cast<__u16>(type);
  event.code = static_cast<__u16>(code);
  event.value = value;
  std::vector<uint8_t> bytes(sizeof event);
  std::memcpy(bytes.data(), &event, sizeof event);
  return bytes;
}

/// Its path is in a folder of its own, gone with it.
class FifoSwitch {
 public:
  FifoSwitch() {
    char name[] = "/tmp/beckon-switch-XXXXXX";
    folder_ = mkdtemp(name);
    path_ = folder_ + "/switch";
    mkfifo(path_.c_str(), 0600);
  }
  ~FifoSwitch() {
    Unplug();
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  const std::string& path() const { return path_; }

  /// Fails while nobody reads.
  bool Plug() {
    if (fd_ < 0) fd_ = open(path_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    return fd_ >= 0;
  }
  void Unplug() {
    if (fd_ >= 0) close(std::exchange(fd_, -1));
  }
  bool Write(std::span<const uint8_t> bytes) {
    return Plug() && write(fd_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  }
  /// 1 = down, 0 = up, 2 = repeated; with the SYN_REPORT that follows each.
  bool Key(int value, int code = KEY_SPACE) { return Key(value, code, stamp_us_ += 70'001); }
  bool Key(int value, int code, int64_t at_us) {
    auto bytes = EventBytes(EV_KEY, code, value, at_us);
    const auto report = EventBytes(EV_SYN, SYN_REPORT, 0, at_us);
    bytes.insert(bytes.end(), report.begin(), report.end());
    return Write(bytes);
  }

 private:
  std::string folder_;
  std::string path_;
  int fd_ = -1;
  int64_t stamp_us_ = 1'700'000'000'123'457;
};

}  // namespace beckon::ui_bridge
