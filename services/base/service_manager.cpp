#include "services/base/service_manager.h"

#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace beckon {
namespace {

std::string Take(const char* name) {
  const char* value = std::getenv(name);
  const std::string taken = value == nullptr ? "" : value;
  unsetenv(name);
  return taken;
}

/// A socket that sends to `path` ('@': an abstract address); -1 where that is none.
int Connect(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() < 2 || path.size() >= sizeof address.sun_path) {
    errno = EINVAL;
    return -1;
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  if (path[0] == '@') address.sun_path[0] = '\0';
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd >= 0 && connect(fd, reinterpret_cast<const sockaddr*>(&address), size) == 0) return fd;
  if (fd >= 0) close(fd);
  return -1;
}

/// Half of what `usec` says, where it is meant for this process.
std::optional<Utime> AlivePeriod(const std::string& usec, const std::string& pid) {
  if (!pid.empty() && pid != std::to_string(getpid())) return {};
  Utime most_us = 0;
  const char* const end = usec.data() + usec.size();
  const auto [parsed, error] = std::from_chars(usec.data(), end, most_us);
  if (usec.empty() || error != std::errc() || parsed != end || most_us < 2) return {};
  return most_us / 2;
}

}  // namespace

ServiceManager ServiceManager::TakeFromEnvironment() {
  const std::string path = Take("NOTIFY_SOCKET");
  const std::string usec = Take("WATCHDOG_USEC"), pid = Take("WATCHDOG_PID");
  ServiceManager manager;
  if (path.empty()) return manager;
  manager.fd_ = Connect(path);
  if (manager.fd_ < 0) {
    spdlog::warn("the service manager cannot be told anything at NOTIFY_SOCKET={}: {}", path,
                 std::strerror(errno));
    return manager;
  }
  manager.alive_period_us_ = AlivePeriod(usec, pid);
  return manager;
}

ServiceManager::ServiceManager(ServiceManager&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), alive_period_us_(other.alive_period_us_) {}

ServiceManager::~ServiceManager() {
  if (fd_ >= 0) close(fd_);
}

void ServiceManager::Tell(const std::string& what) const {
  // Told or not, this process goes on: a manager that missed it acts by its own time limits.
  if (fd_ >= 0) send(fd_, what.data(), what.size(), MSG_NOSIGNAL);
}

}  // namespace beckon
