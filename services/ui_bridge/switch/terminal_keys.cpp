#include "services/ui_bridge/switch/terminal_keys.h"

#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>

namespace beckon::ui_bridge {
namespace {

/// As it was before; restored when the process exits by whatever return or exit().
std::optional<termios>& SavedTerminal() {
  static std::optional<termios> saved;
  return saved;
}

void RestoreTerminal() {
  if (const auto saved = std::exchange(SavedTerminal(), std::nullopt)) {
    tcsetattr(STDIN_FILENO, TCSANOW, &*saved);
  }
}

/// Each key at once and unseen. Ctrl-C still ends the program, which restores the terminal; what
/// would leave it without that (Ctrl-\\, Ctrl-Z) is off.
void MakeRaw() {
  termios terminal{};
  if (isatty(STDIN_FILENO) != 1 || tcgetattr(STDIN_FILENO, &terminal) != 0) return;
  static const bool registered = std::atexit(RestoreTerminal) == 0;
  (void)registered;
  SavedTerminal() = terminal;
  terminal.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  terminal.c_cc[VQUIT] = _POSIX_VDISABLE;
  terminal.c_cc[VSUSP] = _POSIX_VDISABLE;
  terminal.c_cc[VMIN] = 0;
  terminal.c_cc[VTIME] = 0;
  tcsetattr(STDIN_FILENO, TCSANOW, &terminal);
}

class TerminalKeys final : public SwitchSource {
 public:
  TerminalKeys(RunLoop& loop, SwitchListener& listener) : loop_(loop), listener_(listener) {}
  ~TerminalKeys() override {
    Unwatch();
    RestoreTerminal();
  }

  void Start() override {
    MakeRaw();
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
