// The page's socket outlives the move into another network, and reaches the program that serves it.
#include "tools/beckon/page_socket.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tools/beckon/child_process.h"
#include "tools/beckon/run_folder.h"

namespace beckon::tool {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

int PortOf(const PageSocket& page) {
  const std::string address = page.Address();
  return std::stoi(address.substr(address.rfind(':') + 1));
}

/// What a shell prints that was given the socket.
std::string Shell(const std::string& script, int listening_fd) {
  auto folder = RunFolder::Make("", "beckon-page-socket");
  ProcessSpec spec;
  spec.name = "shell";
  spec.program = "/bin/sh";
  spec.args = {"-c", script};
  spec.log_file = folder->path() + "/log";
  spec.listening_fd = listening_fd;
  auto shell = ChildProcess::Start(spec);
  EXPECT_TRUE(shell) << shell.error().message;
  const auto exit = shell->Wait(10'000);
  EXPECT_TRUE(exit && exit->code == 0);
  std::stringstream text;
  text << std::ifstream(spec.log_file).rdbuf();
  return text.str();
}

TEST(PageSocket, ListensOnLoopbackAlone) {
  const auto page = PageSocket::Listen(0);
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_THAT(page->Address(), StartsWith("http://127.0.0.1:"));
  const int client = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<uint16_t>(PortOf(*page)));
  EXPECT_EQ(connect(client, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  close(client);
}

TEST(PageSocket, FindsAnotherPortWhereNobodyAskedForThatOne) {
  const auto first = PageSocket::Listen(0);
  const auto second = PageSocket::Listen(0);
  ASSERT_TRUE(first && second);
  EXPECT_NE(PortOf(*first), PortOf(*second));
}

TEST(PageSocket, SaysWhichPortIsTaken) {
  const auto first = PageSocket::Listen(0);
  ASSERT_TRUE(first);
  const auto second = PageSocket::Listen(PortOf(*first));
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr("--port " + std::to_string(PortOf(*first))));
}

TEST(PageSocket, ReachesTheProgramThatServesIt) {
  const auto page = PageSocket::Listen(0);
  ASSERT_TRUE(page);
  const std::string said =
      Shell("echo $LISTEN_FDS; [ \"$LISTEN_PID\" -eq $$ ] && echo mine; readlink /proc/$$/fd/3",
            page->fd());
  EXPECT_THAT(said, StartsWith("1\nmine\nsocket:"));
}

TEST(PageSocket, ReachesNobodyElse) {
  const auto page = PageSocket::Listen(0);
  ASSERT_TRUE(page);
  const std::string said =
      Shell("echo \"<$LISTEN_FDS$LISTEN_PID>\"; readlink /proc/$$/fd/* || true", -1);
  EXPECT_THAT(said, StartsWith("<>\n"));
  const std::string self = "/proc/self/fd/" + std::to_string(page->fd());
  EXPECT_THAT(said, Not(HasSubstr(std::filesystem::read_symlink(self).string())));
}

}  // namespace
}  // namespace beckon::tool
