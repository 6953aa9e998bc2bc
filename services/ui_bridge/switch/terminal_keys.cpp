#include "services/ui_bridge/switch/terminal_keys.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "services/base/raw_terminal.h"

namespace beckon::ui_bridge {
namespace {

class TerminalKeys final : public SwitchSource {
 public:
  TerminalKeys(RunLoop& loop, SwitchListener& listener) : loop_(loop), listener_(listener) {}
  ~TerminalKeys() override {
    Unwatch();
    RestoreTerminal();
  }

  void Start() override {
    MakeTerminalRaw();
    try {
      loop_.AddFd(STDIN_FILENO, [this] { Read(); });
      watching_ = true;
    } catch (const std::system_error&) {
      listener_.OnSourceNotice("Standard input is a file: there is no key to press.");
    }
  }

  std::string State() const override { return watching_ ? "ok" : "standard input is closed"; }

 private:
  void Read() {
    std::array<char, 64> bytes;
    const ssize_t n = read(STDIN_FILENO, bytes.data(), bytes.size());
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) return;
    if (n <= 0) {
      Unwatch();
      return listener_.OnSourceNotice("Standard input is closed: there is no key to press.");
    }
    const Utime now = clock_.Now();
    for (ssize_t i = 0; i < n; ++i) {
      switch (bytes[static_cast<size_t>(i)]) {
        case ' ':
          listener_.OnClick(now, scan::Switch::kMain);
          break;
        case '\n':
        case '\r':
          listener_.OnClick(now, scan::Switch::kSelect);
          break;
        case 's':
        case 'S':
          listener_.OnStopKey();
          break;
        default:
          break;
      }
    }
  }

  void Unwatch() {
    if (std::exchange(watching_, false)) loop_.RemoveFd(STDIN_FILENO);
  }

  RunLoop& loop_;
  SwitchListener& listener_;
  const SteadyClock clock_;
  bool watching_ = false;
};

}  // namespace

std::unique_ptr<SwitchSource> MakeTerminalKeys(RunLoop& loop, SwitchListener& listener) {
  return std::make_unique<TerminalKeys>(loop, listener);
}

}  // namespace beckon::ui_bridge
