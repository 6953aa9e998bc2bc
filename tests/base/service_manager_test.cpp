// What a service manager hears of a process and its loop.
#include "services/base/service_manager.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "services/base/run_loop.h"

namespace beckon {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// The service manager's end, announced in the environment.
class Manager {
 public:
  explicit Manager(const std::string& path = "@beckon-manager-" + std::to_string(getpid())) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    if (path[0] == '@') address.sun_path[0] = '\0';
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
    EXPECT_EQ(bind(fd_, reinterpret_cast<sockaddr*>(&address), size), 0) << std::strerror(errno);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  ~Manager() {
    close(fd_);
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) unsetenv(name);
  }

  int fd() const { return fd_; }

  /// What was told since the last time.
  std::vector<std::string> Heard() const {
    std::vector<std::string> heard;
    std::array<char, 256> bytes;
    for (ssize_t n; (n = recv(fd_, bytes.data(), bytes.size(), 0)) > 0;)
      heard.emplace_back(bytes.data(), static_cast<size_t>(n));
    return heard;
  }

 private:
  int fd_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
};

TEST(ServiceManager, HearsThatTheLoopRunsAndLivesAndStops) {
  const Manager manager;
  setenv("WATCHDOG_USEC", "4000", 1);
  setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
  RunLoop loop(/*handle_signals=*/true);
  EXPECT_THAT(manager.Heard(), IsEmpty()) << "ready before the loop runs";
  std::vector<std::string> heard;
  loop.AddFd(manager.fd(), [&] {
    for (auto& what : manager.Heard()) heard.push_back(std::move(what));
    if (heard.size() >= 3) loop.Stop();
  });
  loop.Run();
  EXPECT_THAT(heard, ElementsAre("READY=1", "WATCHDOG=1", "WATCHDOG=1"));
  EXPECT_THAT(manager.Heard(), ElementsAre("STOPPING=1"));
}

TEST(ServiceManager, HearsNothingOfALoopThatIsStuck) {
  const Manager manager;
  setenv("WATCHDOG_USEC", "2000", 1);
  RunLoop loop(/*handle_signals=*/true);
  loop.Post([&] {
    manager.Heard();
    pollfd next{.fd = manager.fd(), .events = POLLIN, .revents = 0};
    EXPECT_EQ(poll(&next, 1, 50), 0) << "a datagram came while the loop did not turn";
    loop.Stop();
  });
  loop.Run();
}

TEST(ServiceManager, IsFoundAtAPathAndTakenOutOfTheEnvironment) {
  const std::string path = ::testing::TempDir() + std::to_string(getpid()) + "_manager";
  {
    const Manager manager(path);
    setenv("WATCHDOG_USEC", "30000000", 1);
    const auto told = ServiceManager::TakeFromEnvironment();
    EXPECT_EQ(told.alive_period_us(), 15 * kSecond);
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"})
      EXPECT_EQ(std::getenv(name), nullptr) << name;
    told.TellReady();
    EXPECT_THAT(manager.Heard(), ElementsAre("READY=1"));
  }
  std::filesystem::remove(path);
}

TEST(ServiceManager, ThatWatchesAnotherProcessIsNotToldThatThisOneLives) {
  const Manager manager;
  setenv("WATCHDOG_USEC", "4000", 1);
  setenv("WATCHDOG_PID", std::to_string(getpid() + 1).c_str(), 1);
  EXPECT_FALSE(ServiceManager::TakeFromEnvironment().alive_period_us());
}

TEST(ServiceManager, IsNotWaitedFor) {
  const Manager manager;  // reads nothing
  const auto told = ServiceManager::TakeFromEnvironment();
  for (int i = 0; i < 10'000; ++i) told.TellAlive();
  EXPECT_FALSE(manager.Heard().empty());
}

TEST(ServiceManager, NeedNotBeThereNorMakeSense) {
  ServiceManager().TellReady();
  EXPECT_FALSE(ServiceManager::TakeFromEnvironment().alive_period_us());
  const std::string too_long(200, '/');
  for (const std::string& nowhere : {std::string("@"), std::string("/nowhere/socket"), too_long}) {
    setenv("NOTIFY_SOCKET", nowhere.c_str(), 1);
    setenv("WATCHDOG_USEC", "4000", 1);
    const auto told = ServiceManager::TakeFromEnvironment();
    EXPECT_FALSE(told.alive_period_us()) << nowhere;
    told.TellReady();
  }
  for (const char* usec : {"", "0", "-5", "soon", "4000x", "99999999999999999999"}) {
    const Manager manager;
    setenv("WATCHDOG_USEC", usec, 1);
    EXPECT_FALSE(ServiceManager::TakeFromEnvironment().alive_period_us()) << usec;
  }
}

}  // namespace
}  // namespace beckon
