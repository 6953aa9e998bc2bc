#include "services/base/raw_terminal.h"

#include <termios.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <utility>

namespace beckon {
namespace {

std::optional<termios>& SavedTerminal() {
  static std::optional<termios> saved;
  return saved;
}

}  // namespace

void RestoreTerminal() {
  if (const auto saved = std::exchange(SavedTerminal(), std::nullopt)) {
    tcsetattr(STDIN_FILENO, TCSANOW, &*saved);
  }
}

void MakeTerminalRaw() {
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

}  // namespace beckon
