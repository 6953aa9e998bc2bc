// Presses the game pad's buttons, so that the conformance kit can judge front_end_gamepad.cpp: a
// FIFO in the device's place.
#include <fcntl.h>
#include <linux/joystick.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/ui_bridge/conformance/conformance.h"

namespace beckon::ui_bridge::conformance {
namespace {

class GamepadHand final : public Hand {
 public:
  GamepadHand() {
    unlink(path_.c_str());
    if (mkfifo(path_.c_str(), 0600) != 0) throw std::runtime_error(path_ + ": no FIFO");
    fd_ = open(path_.c_str(), O_RDWR | O_CLOEXEC);
  }
  ~GamepadHand() override {
    close(fd_);
    unlink(path_.c_str());
  }

  std::string front_end() const override { return "gamepad"; }
  std::vector<std::string> flags() const override { return {"--gamepad", path_}; }
  void Start() override { Press(0); }
  /// Of three options it has buttons for the first and the last.
  size_t Choose(const msg::Query& query, size_t option) override {
    const bool yes = option == 0;
    Press(yes ? 0 : 1);
    return yes ? 0 : query.options.size() - 1;
  }
  bool Stop() override { return Press(3); }
  bool Resume() override { return Press(0); }
  bool Undo() override { return Press(2); }

 private:
  bool Press(uint8_t button) {
    for (const int16_t down : {1, 0}) {
      const js_event event{.time = 0, .value = down, .type = JS_EVENT_BUTTON, .number = button};
      if (write(fd_, &event, sizeof event) != sizeof event) return false;
    }
    return true;
  }

  const std::string path_ = "/tmp/beckon-gamepad-" + std::to_string(getpid());
  int fd_ = -1;
};

BECKON_FRONT_END_CONFORMANCE(GamepadHand);

}  // namespace
}  // namespace beckon::ui_bridge::conformance
