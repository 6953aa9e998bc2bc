// The whole program on a terminal of its own: keys without Enter, and a terminal that is as before
// however it ends.
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>

#include <functional>
#include <string>

namespace beckon::ui_bridge {
namespace {

class OnATerminal {
 public:
  OnATerminal() {
    if (openpty(&master_, &slave_, nullptr, nullptr, nullptr) != 0) return;
    child_ = fork();
    if (child_ != 0) return;
    close(master_);
    login_tty(slave_);
    execl(BECKON_UI_BRIDGE, BECKON_UI_BRIDGE, "--front-end", "switch", "--lcm-url", "memq://",
          "--user", "ann", nullptr);
    _exit(127);
  }
  ~OnATerminal() {
    if (child_ > 0 && !ended_) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
    close(master_);
    close(slave_);
  }

  bool ok() const { return child_ > 0; }
  int child() const { return child_; }
  bool Raw() const {
    termios terminal{};
    tcgetattr(slave_, &terminal);
    return (terminal.c_lflag & (ICANON | ECHO)) == 0;
  }
  void Type(const std::string& keys) {
    ASSERT_EQ(write(master_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  /// Whether it showed `text` within 10 s.
  bool AwaitText(const std::string& text) {
    for (int i = 0; i < 1000 && seen_.find(text) == std::string::npos; ++i) {
      pollfd poll_fd{.fd = master_, .events = POLLIN, .revents = 0};
      if (poll(&poll_fd, 1, 10) <= 0) continue;
      char bytes[1024];
      const ssize_t n = read(master_, bytes, sizeof bytes);
      if (n > 0) seen_.append(bytes, static_cast<size_t>(n));
    }
    return seen_.find(text) != std::string::npos;
  }
  /// Awaits its end, while its output is read.
  bool AwaitEnd() {
    for (int i = 0; i < 1000 && !ended_; ++i) {
      pollfd poll_fd{.fd = master_, .events = POLLIN, .revents = 0};
      char bytes[1024];
      if (poll(&poll_fd, 1, 10) > 0) (void)!read(master_, bytes, sizeof bytes);
      ended_ = waitpid(child_, nullptr, WNOHANG) == child_;
    }
    return ended_;
  }
  const std::string& seen() const { return seen_; }

 private:
  int master_ = -1;
  int slave_ = -1;
  int child_ = -1;
  bool ended_ = false;
  std::string seen_;
};

TEST(TerminalKeys, LeaveTheTerminalAsItWasHoweverTheProgramEnds) {
  const std::pair<const char*, std::function<void(OnATerminal&)>> ways[] = {
      {"Ctrl-C", [](OnATerminal& terminal) { terminal.Type("\x03"); }},
      {"SIGTERM", [](OnATerminal& terminal) { kill(terminal.child(), SIGTERM); }},
      {"SIGINT", [](OnATerminal& terminal) { kill(terminal.child(), SIGINT); }},
  };
  for (const auto& [name, end] : ways) {
    OnATerminal terminal;
    ASSERT_TRUE(terminal.ok());
    ASSERT_FALSE(terminal.Raw()) << "before";
    ASSERT_TRUE(terminal.AwaitText("Space is the switch")) << terminal.seen();
    ASSERT_TRUE(terminal.AwaitText("> Stop")) << terminal.seen();
    EXPECT_TRUE(terminal.Raw()) << name;
    end(terminal);
    ASSERT_TRUE(terminal.AwaitEnd()) << name;
    EXPECT_FALSE(terminal.Raw()) << name;
  }
}

TEST(TerminalKeys, AreOneWordAPressWithoutEnter) {
  OnATerminal terminal;
  ASSERT_TRUE(terminal.ok());
  ASSERT_TRUE(terminal.AwaitText("> Stop")) << terminal.seen();
  terminal.Type("\x1c\x1a");  // Ctrl-\\, Ctrl-Z: no way out that leaves the terminal raw
  terminal.Type("s");
  EXPECT_TRUE(terminal.AwaitText("STOP."));
  EXPECT_TRUE(terminal.AwaitText("STOPPED  > Resume")) << terminal.seen();
}

}  // namespace
}  // namespace beckon::ui_bridge
