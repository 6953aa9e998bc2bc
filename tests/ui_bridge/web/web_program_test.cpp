// The program itself: the address it prints, a port that it is given, a socket that it inherits,
// what it says of wrong settings.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <regex>

#include "services/ui_bridge/web/listen_socket.h"
#include "tests/ui_bridge/web/http_client.h"
#include "tests/ui_bridge/web/web_system.h"

namespace beckon::ui_bridge::web {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

/// beckon-ui-bridge --front-end web, on a bus of its own.
class Program {
 public:
  /// `listening`: handed over as systemd does.
  Program(const WebFolder& folder, const std::string& config, std::vector<std::string> args,
          int listening = -1) {
    const std::string file = folder.page() + "/web.toml";
    std::ofstream(file) << "[web]\npage = \"" << folder.page() << "\"\ndata = \"" << folder.data()
                        << "\"\n"
                        << config;
    args.insert(args.begin(), {BECKON_UI_BRIDGE, "--front-end", "web", "--lcm-url", "memq://",
                               "--user", "ann", "--config", file});
    int ends[2];
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    pid_ = fork();
    if (pid_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      if (listening >= 0) {
        dup2(listening, 3);
        fcntl(3, F_SETFD, 0);
        setenv("LISTEN_FDS", "1", 1);
        setenv("LISTEN_PID", std::to_string(getpid()).c_str(), 1);
      }
      std::vector<char*> argv;
      for (auto& arg : args) argv.push_back(arg.data());
      argv.push_back(nullptr);
      execv(argv[0], argv.data());
      _exit(127);
    }
    close(ends[1]);
    out_ = ends[0];
  }
  ~Program() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(out_);
  }

  /// Reads until the text is there, or the end.
  std::string Until(const std::string& text) {
    const auto begin = std::chrono::steady_clock::now();
    while (said_.find(text) == std::string::npos &&
           std::chrono::steady_clock::now() - begin < std::chrono::seconds(10)) {
      pollfd wait{.fd = out_, .events = POLLIN, .revents = 0};
      char bytes[4096];
      if (poll(&wait, 1, 100) <= 0) continue;
      const ssize_t n = read(out_, bytes, sizeof bytes);
      if (n <= 0) break;
      said_.append(bytes, static_cast<size_t>(n));
    }
    return said_;
  }
  /// SIGTERM; its exit code.
  int End() {
    kill(pid_, SIGTERM);
    return Wait();
  }
  int Wait() {
    int status = 0;
    waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
  int out_ = -1;
  std::string said_;
};

/// The number after "PAGE: http://ADDRESS:".
int PortOf(const std::string& said) {
  const size_t at = said.find(":", said.find("http://") + 7);
  return at == std::string::npos ? 0 : std::atoi(said.c_str() + at + 1);
}

TEST(WebProgram, PrintsWhereThePageIsAndServesItThere) {
  const WebFolder folder;
  Program program(folder, "", {"--port", "0"});
  const std::string said = program.Until("\n");
  EXPECT_THAT(said, HasSubstr("The page: http://127.0.0.1:"));
  ASSERT_GT(PortOf(said), 0) << said;
  EXPECT_EQ(Get(PortOf(said), "/").status, 200);
  EXPECT_EQ(Get(PortOf(said), "/api/state").json()["user"], "ann");
  EXPECT_EQ(program.End(), 0);
}

TEST(WebProgram, ServesOnASocketThatItInherits) {
  const WebFolder folder;
  const auto socket = Listen("127.0.0.1", 0);
  ASSERT_TRUE(socket);
  Program program(folder, "port = 1\n", {}, socket->fd);
  close(socket->fd);
  const Reply reply = Get(socket->port, "/");  // the socket takes it before the program runs
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(program.End(), 0);
}

TEST(WebProgram, SaysThatWhatItInheritedIsNoListeningSocket) {
  const WebFolder folder;
  const int file = open("/dev/null", O_RDONLY | O_CLOEXEC);
  Program program(folder, "", {}, file);
  close(file);
  EXPECT_THAT(program.Until("descriptor 3"), HasSubstr("file descriptor 3 is no listening"));
  EXPECT_EQ(program.Wait(), 2);
}

TEST(WebProgram, AsksForATokenWhereOthersReachIt) {
  const WebFolder folder;
  Program program(folder, "address = \"0.0.0.0\"\n", {"--port", "0"});
  const std::string said = program.Until("?token=") + program.Until("\n");
  ASSERT_THAT(said, HasSubstr("?token="));
  const std::string token = said.substr(said.find("?token=") + 7, 32);
  EXPECT_THAT(token, MatchesRegex("[0-9a-f]{32}"));
  const int port = PortOf(said.substr(said.find("The page:")));
  EXPECT_EQ(Get(port, "/").status, 401);
  EXPECT_EQ(Get(port, "/?token=" + token).status, 302);
  std::string kept;
  std::ifstream(folder.data() + "/token") >> kept;
  EXPECT_EQ(kept, token);
}

TEST(WebProgram, TakesEverySettingThatIsWrittenDownAndHasItsDefault) {
  const WebFolder folder;
  std::ifstream shipped(std::string(BECKON_SOURCE_DIR) + "/services/ui_bridge/web/web.toml");
  std::string config;
  int keys = 0;
  for (std::string line; std::getline(shipped, line);) {
    // Those that say where things are were written above.
    const bool here = line.starts_with("# page") || line.starts_with("# data");
    if (!std::regex_match(line, std::regex("# [a-z_]+ = .*")) || here) continue;
    config += line.substr(2) + "\n";
    ++keys;
  }
  EXPECT_EQ(keys, 10);
  Program program(folder, config, {"--check-config"});
  const std::string said = program.Until("\n");
  EXPECT_EQ(program.Wait(), 0) << said;
}

TEST(WebProgram, RefusesWrongSettingsInOneLine) {
  const WebFolder folder;
  const struct {
    const char* config;
    const char* said;
  } cases[] = {{"port = 70000\n", "port"},
               {"prot = 1\n", "prot"},
               {"address = \"example.org\"\n", "numeric address"},
               {"max_options = 1\n", "max_options"}};
  for (const auto& [config, said] : cases) {
    Program program(folder, config, {});
    EXPECT_THAT(program.Until(said), HasSubstr(said)) << config;
    EXPECT_EQ(program.Wait(), 2) << config;
  }
  std::filesystem::remove(folder.page() + "/index.html");
  Program program(folder, "port = 0\n", {});
  EXPECT_THAT(program.Until("index.html"), HasSubstr("index.html"));
  EXPECT_EQ(program.Wait(), 2);
}

}  // namespace
}  // namespace beckon::ui_bridge::web
