// `beckon top` in a terminal: draws, follows its size, and leaves it as it was.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>

#include "tools/beckon/child_process.h"

namespace beckon::tool {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

/// A terminal that nobody sits at, with `beckon top` in it. The bus is one of its own memory.
class TopTerminal : public ::testing::Test {
 protected:
  void SetUp() override {
    master_ = posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_GE(master_, 0);
    ASSERT_EQ(grantpt(master_), 0);
    ASSERT_EQ(unlockpt(master_), 0);
    const std::string slave = ptsname(master_);
    slave_ = open(slave.c_str(), O_RDWR | O_NOCTTY);
    ASSERT_GE(slave_, 0);
    Resize(24, 80);
    ASSERT_EQ(tcgetattr(slave_, &before_), 0);
    ProcessSpec spec;
    spec.name = "top";
    spec.program = BECKON_BIN_DIR "/beckon";
    spec.args = {"top", "--lcm-url", "memq://"};
    spec.stdin_file = slave;
    spec.log_file = slave;
    auto started = ChildProcess::Start(spec);
    ASSERT_TRUE(started.ok()) << started.error().message;
    top_.emplace(*std::move(started));
  }
  void TearDown() override {
    top_.reset();
    close(slave_);
    close(master_);
  }

  void Resize(unsigned short rows, unsigned short columns) const {
    const winsize size{.ws_row = rows, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
    ASSERT_EQ(ioctl(master_, TIOCSWINSZ, &size), 0);
  }
  /// Reads until `text` was drawn; all that was drawn since the last call.
  std::string ReadUntil(const std::string& text) const {
    std::string drawn;
    while (drawn.find(text) == std::string::npos) {
      pollfd fd{.fd = master_, .events = POLLIN, .revents = 0};
      if (poll(&fd, 1, 20'000) != 1) break;
      std::array<char, 4096> bytes;
      const ssize_t n = read(master_, bytes.data(), bytes.size());
      if (n <= 0) break;
      drawn.append(bytes.data(), static_cast<size_t>(n));
    }
    return drawn;
  }
  void Press(char key) const { ASSERT_EQ(write(master_, &key, 1), 1); }
  void ExpectLeftAsItWas() {
    EXPECT_THAT(ReadUntil("\x1b[?1049l"), EndsWith("\x1b[?25h\x1b[?1049l"));
    const auto exit = top_->Wait(20'000);
    ASSERT_TRUE(exit);
    EXPECT_EQ(exit->code, 0) << exit->Text();
    termios after{};
    ASSERT_EQ(tcgetattr(slave_, &after), 0);
    EXPECT_EQ(after.c_lflag, before_.c_lflag);
    EXPECT_EQ(after.c_cc[VSUSP], before_.c_cc[VSUSP]);
  }

  int master_ = -1, slave_ = -1;
  termios before_{};
  std::optional<ChildProcess> top_;
};

TEST_F(TopTerminal, DrawsAndLeavesByQ) {
  EXPECT_THAT(ReadUntil("q leaves"), HasSubstr("beckon top"));
  termios raw{};
  ASSERT_EQ(tcgetattr(slave_, &raw), 0);
  EXPECT_EQ(raw.c_lflag & ICANON, 0u);
  Press('c');
  Press('q');
  ExpectLeftAsItWas();
}

TEST_F(TopTerminal, LeavesTheTerminalAsItWasWhenASignalEndsIt) {
  ReadUntil("q leaves");
  top_->Signal(SIGINT);
  ExpectLeftAsItWas();
}

TEST_F(TopTerminal, FollowsTheTerminalsSize) {
  ReadUntil("q leaves; sort by: s service, h host, c CPU, m memory");
  Resize(10, 20);
  std::string drawn;
  // The page that was on its way may still have the old size.
  for (int page = 0; page < 10 && drawn.find("\r\nq leaves; sort by: s\x1b[K") == std::string::npos;
       ++page)
    drawn = ReadUntil("\x1b[J");
  EXPECT_THAT(drawn, HasSubstr("\r\nq leaves; sort by: s\x1b[K"));
  Press('q');
  ExpectLeftAsItWas();
}

}  // namespace
}  // namespace beckon::tool
