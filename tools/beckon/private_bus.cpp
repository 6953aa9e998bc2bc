#include "tools/beckon/private_bus.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace beckon::tool {
namespace {

constexpr char kOptions[] = "?ttl=0&recv_buf_size=2097152";
constexpr int kDefaultPort = 7667;
constexpr int kFirstOwnPort = 20'000;
constexpr int kOwnPorts = 20'000;

Error SystemError(const std::string& what) { return Error{what + ": " + std::strerror(errno)}; }

bool WriteFile(const char* path, const std::string& text) {
  const int fd = open(path, O_WRONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool written = write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(fd);
  return written;
}

/// A user namespace in which we are who we were, and may make networks.
Status EnterOwnNetwork() {
  if (geteuid() == 0 && unshare(CLONE_NEWNET) == 0) return {};
  const uid_t uid = geteuid();
  const gid_t gid = getegid();
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0)
    return SystemError("the system allows no network of our own");
  const auto identity = [](unsigned id) {
    return std::to_string(id) + " " + std::to_string(id) + " 1";
  };
  WriteFile("/proc/self/setgroups", "deny");
  if (!WriteFile("/proc/self/uid_map", identity(uid)) ||
      !WriteFile("/proc/self/gid_map", identity(gid))) {
    return SystemError("the system allows no mapping of user ids");
  }
  return {};
}

struct Socket {
  int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ~Socket() {
    if (fd >= 0) close(fd);
  }
};

void SetAddress(sockaddr& target, const char* address) {
  sockaddr_in in{};
  in.sin_family = AF_INET;
  inet_pton(AF_INET, address, &in.sin_addr);
  std::memcpy(&target, &in, sizeof in);
}

PrivateBus OwnPort(const std::string& why) {
  PrivateBus bus;
  const int port = kFirstOwnPort + static_cast<int>(getpid() % kOwnPorts);
  bus.lcm_url = "udpm://239.255.76.67:" + std::to_string(port) + kOptions;
  bus.note = why + "; using port " + std::to_string(port) + " of this machine with ttl=0 instead";
  return bus;
}

}  // namespace

Status PrepareLoopback() {
  const Socket s;
  if (s.fd < 0) return SystemError("no socket");
  ifreq interface {};
  std::strcpy(interface.ifr_name, "lo");
  if (ioctl(s.fd, SIOCGIFFLAGS, &interface) != 0) return SystemError("loopback");
  interface.ifr_flags =
      static_cast<short>(interface.ifr_flags | IFF_UP | IFF_RUNNING | IFF_MULTICAST);
  if (ioctl(s.fd, SIOCSIFFLAGS, &interface) != 0) return SystemError("loopback up");

  rtentry route{};
  char device[] = "lo";
  SetAddress(route.rt_dst, "224.0.0.0");
  SetAddress(route.rt_genmask, "240.0.0.0");
  SetAddress(route.rt_gateway, "0.0.0.0");
  route.rt_flags = RTF_UP;
  route.rt_dev = device;
  if (ioctl(s.fd, SIOCADDRT, &route) != 0 && errno != EEXIST) return SystemError("multicast route");
  return {};
}

PrivateBus EnterPrivateBus() {
  if (auto entered = EnterOwnNetwork(); !entered) return OwnPort(entered.error().message);
  if (auto ready = PrepareLoopback(); !ready) {
    // We are in a network that carries nothing: no port would help.
    PrivateBus bus =
        OwnPort("the network of our own cannot be set up (" + ready.error().message + ")");
    return bus;
  }
  PrivateBus bus;
  bus.lcm_url = "udpm://239.255.76.67:" + std::to_string(kDefaultPort) + kOptions;
  bus.isolated = true;
  return bus;
}

}  // namespace beckon::tool
