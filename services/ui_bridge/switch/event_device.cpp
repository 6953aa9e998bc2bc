#include "services/ui_bridge/switch/event_device.h"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace beckon::ui_bridge {
namespace {

constexpr int kReadsAtOnce = 16;       // then the loop serves others first
constexpr Utime kOldest_us = kSecond;  // of what is read at once

std::string Why(int error) { return std::generic_category().message(error); }

/// What EVIOCGNAME or EVIOCGUNIQ say; empty where they fail.
std::string Ask(int fd, bool uniq) {
  std::array<char, 256> text{};
  const int n = ioctl(fd, uniq ? EVIOCGUNIQ(255) : EVIOCGNAME(255), text.data());
  return n > 0 ? std::string(text.data()) : std::string();
}

Result<int> OpenPath(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (fd >= 0) return fd;
  const std::string hint = errno == EACCES ? "; the user has to be in the group \"input\"" : "";
  return Error{path + ": " + Why(errno) + hint};
}

Result<int> OpenBy(const std::string& wanted, bool uniq) {
  std::error_code ignored;
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/input", ignored)) {
    if (entry.path().filename().string().starts_with("event")) paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  for (const auto& path : paths) {
    auto fd = OpenPath(path);
    if (!fd) continue;
    if (Ask(*fd, uniq) == wanted) return fd;
    close(*fd);
  }
  return Error{std::string("no device in /dev/input has the ") + (uniq ? "identity" : "name") +
               " '" + wanted + "'"};
}

Result<int> OpenDevice(const std::string& device) {
  if (device.starts_with("name:")) return OpenBy(device.substr(5), false);
  if (device.starts_with("uniq:")) return OpenBy(device.substr(5), true);
  return OpenPath(device);
}

class EventDevice final : public SwitchSource {
 public:
  EventDevice(const EventDeviceConfig& config, RunLoop& loop, SwitchListener& listener)
      : config_(config),
        loop_(loop),
        listener_(listener),
        map_(config.main, config.select),
        retry_us_(config.first_retry_us) {}
  ~EventDevice() override {
    Close();
    if (timer_) loop_.Cancel(*timer_);
  }

  void Start() override { TryOpen(); }

  std::string State() const override {
    std::string state = trouble_.empty() ? "ok" : trouble_;
    if (stream_.garbage() > 0) state += ", " + std::to_string(stream_.garbage()) + " odd bytes";
    return state;
  }

 private:
  void TryOpen() {
    timer_.reset();
    auto fd = OpenDevice(config_.device);
    if (!fd) return NotThere(fd.error().message);
    struct stat info {};
    fstat(*fd, &info);
    const bool fifo = S_ISFIFO(info.st_mode);
    if (!fifo && !S_ISCHR(info.st_mode)) {
      close(*fd);
      return NotThere(config_.device + ": expected an input device or a FIFO");
    }
    if (config_.grab && !fifo && ioctl(*fd, EVIOCGRAB, 1) != 0) {
      listener_.OnSourceNotice("The switch is shared with other programs: " + Why(errno) + ".");
    }
    fd_ = *fd;
    stream_.Reset();
    try {
      loop_.AddFd(fd_, [this] { Read(); });
    } catch (const std::system_error& error) {
      close(std::exchange(fd_, -1));
      return NotThere(config_.device + ": " + error.what());
    }
    if (!fifo) IsThere();  // a FIFO can be opened before anybody writes to it
  }

  void IsThere() {
    retry_us_ = config_.first_retry_us;
    if (std::exchange(there_, true)) return;
    if (!std::exchange(trouble_, {}).empty()) listener_.OnSourceNotice("The switch is back.");
  }

  void NotThere(const std::string& why) {
    there_ = false;
    if (trouble_.empty()) {
      listener_.OnSourceNotice("The switch is not there (" + why + "); waiting for it.");
    }
    trouble_ = why;
    timer_ = loop_.After(retry_us_, [this] { TryOpen(); });
    retry_us_ = std::min(2 * retry_us_, config_.last_retry_us);
  }

  void Read() {
    std::array<uint8_t, 64 * sizeof(input_event)> bytes;
    for (int i = 0; i < kReadsAtOnce; ++i) {
      const ssize_t n = read(fd_, bytes.data(), bytes.size());
      if (n > 0) {
        IsThere();
        Take(stream_.Feed({bytes.data(), static_cast<size_t>(n)}));
        if (fd_ < 0) return;
        continue;
      }
      if (n < 0 && errno == EINTR) continue;
      if (n < 0 && errno == EAGAIN) return;
      return Gone(n == 0 ? "it was closed" : Why(errno));
    }
  }

  /// What was read at once did not happen at once: the device's stamps tell it apart, whatever
  /// clock they are of.
  void Take(const std::vector<InputEvent>& events) {
    if (events.empty()) return;
    const Utime now = clock_.Now();
    const Utime last = events.back().device_us;
    for (const InputEvent& event : events) {
      const Utime ago = std::clamp<Utime>(last - event.device_us, 0, kOldest_us);
      if (event.kind == InputEvent::Kind::kLost) {
        map_.Reset();
        listener_.OnRelease(now);
      } else if (const auto edge = map_.OnKey(event)) {
        listener_.OnEdge(now - ago, edge->which, edge->down);
      }
    }
  }

  void Gone(const std::string& why) {
    Close();
    map_.Reset();
    listener_.OnRelease(clock_.Now());
    NotThere(config_.device + ": " + why);
  }

  void Close() {
    if (fd_ < 0) return;
    loop_.RemoveFd(fd_);
    close(std::exchange(fd_, -1));
  }

  const EventDeviceConfig config_;
  RunLoop& loop_;
  SwitchListener& listener_;
  const SteadyClock clock_;
  InputStream stream_;
  KeyMap map_;
  int fd_ = -1;
  bool there_ = false;
  std::string trouble_;  // why it is not there
  Utime retry_us_;
  std::optional<RunLoop::TimerId> timer_;
};

}  // namespace

std::unique_ptr<SwitchSource> MakeEventDevice(const EventDeviceConfig& config, RunLoop& loop,
                                              SwitchListener& listener) {
  return std::make_unique<EventDevice>(config, loop, listener);
}

}  // namespace beckon::ui_bridge
