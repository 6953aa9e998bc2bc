// A network of one's own. Each test runs in a process of its own: what it enters it cannot leave.
#include "tools/beckon/private_bus.h"

#include <gtest/gtest.h>
#include <net/if.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <thread>

#include "services/base/bus.h"
#include "services/base/run_loop.h"

namespace beckon::tool {
namespace {

/// The child's exit code.
int InChild(const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = -1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

constexpr int kNotAllowed = 77;

/// Gives up root's privileges for good.
bool BecomeOrdinary() {
  if (geteuid() != 0) return true;
  if (setresgid(65534, 65534, 65534) != 0 || setresuid(65534, 65534, 65534) != 0) return false;
  return prctl(PR_SET_DUMPABLE, 1) == 0;  // else /proc/self stays root's
}

/// Whether a message published at `url` comes back.
bool Echoes(const std::string& url) {
  auto bus = Bus::Open(url);
  if (!bus) return false;
  RunLoop loop;
  bool heard = false;
  loop.AddFd((*bus)->fd(), [&bus] { (*bus)->HandleReadable(); });
  (*bus)->Subscribe<msg::TaskStatus>([&](const msg::TaskStatus&) {
    heard = true;
    loop.Stop();
  });
  msg::TaskStatus status;
  status.utime = 1;
  status.task_id = "t";
  if (!(*bus)->Publish(status)) return false;
  loop.After(5 * kSecond, [&loop] { loop.Stop(); });
  loop.Run();
  return heard;
}

TEST(PrivateBus, CarriesMessagesAndReachesNobodyElse) {
  const int result = InChild([] {
    const PrivateBus bus = EnterPrivateBus();
    if (!bus.isolated) return kNotAllowed;
    // Loopback alone: no other interface exists here.
    struct if_nameindex* interfaces = if_nameindex();
    int n = 0;
    for (auto* i = interfaces; i->if_index != 0; ++i) ++n;
    if_freenameindex(interfaces);
    if (n != 1) return 2;
    if (!bus.note.empty()) return 3;
    return Echoes(bus.lcm_url) ? 0 : 4;
  });
  if (result == kNotAllowed) GTEST_SKIP() << "this machine allows no network namespaces";
  EXPECT_EQ(result, 0);
}

TEST(PrivateBus, IsOpenToOrdinaryUsers) {
  const int result = InChild([] {
    if (!BecomeOrdinary()) return kNotAllowed;
    const PrivateBus bus = EnterPrivateBus();
    if (!bus.isolated) return kNotAllowed;
    return Echoes(bus.lcm_url) ? 0 : 4;
  });
  if (result == kNotAllowed)
    GTEST_SKIP() << "this machine allows ordinary users no network namespaces";
  EXPECT_EQ(result, 0);
}

TEST(PrivateBus, FallsBackToAPortOfItsOwnAndSaysSo) {
  const int result = InChild([] {
    // With two threads, a user namespace is refused; without privileges, so is a network alone.
    if (!BecomeOrdinary()) return kNotAllowed;
    RunLoop loop;
    std::thread second([&loop] { loop.Run(); });
    const PrivateBus bus = EnterPrivateBus();
    loop.Stop();
    second.join();
    if (bus.isolated) return 2;
    if (bus.note.find("ttl=0") == std::string::npos) return 3;
    return bus.lcm_url.find("ttl=0") != std::string::npos &&
                   bus.lcm_url.find(":7667") == std::string::npos
               ? 0
               : 4;
  });
  if (result == kNotAllowed) GTEST_SKIP() << "privileges cannot be dropped here";
  EXPECT_EQ(result, 0);
}

}  // namespace
}  // namespace beckon::tool
