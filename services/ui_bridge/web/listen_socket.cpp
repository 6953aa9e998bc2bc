#include "services/ui_bridge/web/listen_socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>

namespace beckon::ui_bridge::web {
namespace {

constexpr int kFirstInherited = 3;  // SD_LISTEN_FDS_START
constexpr int kBacklog = 128;

Error SystemError(const std::string& what) { return Error{what + ": " + std::strerror(errno)}; }

/// Fills in where a socket listens.
Result<ListenSocket> Describe(int fd) {
  ListenSocket made{.fd = fd};
  sockaddr_storage storage{};
  socklen_t size = sizeof storage;
  auto* any = reinterpret_cast<sockaddr*>(&storage);
  if (getsockname(fd, any, &size) < 0) return SystemError("the page's socket");
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (any->sa_family == AF_INET) {
    const auto* v4 = reinterpret_cast<const sockaddr_in*>(any);
    inet_ntop(AF_INET, &v4->sin_addr, text.data(), text.size());
    made.port = ntohs(v4->sin_port);
    made.loopback = (ntohl(v4->sin_addr.s_addr) >> 24) == 127;
  } else if (any->sa_family == AF_INET6) {
    const auto* v6 = reinterpret_cast<const sockaddr_in6*>(any);
    inet_ntop(AF_INET6, &v6->sin6_addr, text.data(), text.size());
    made.port = ntohs(v6->sin6_port);
    made.loopback = IN6_IS_ADDR_LOOPBACK(&v6->sin6_addr);
  } else {
    return Error{"the page's socket is neither IPv4 nor IPv6"};
  }
  made.address = text.data();
  return made;
}

int Number(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? -1 : std::atoi(text);
}

}  // namespace

std::string ListenSocket::Url() const {
  const bool v6 = address.find(':') != std::string::npos;
  return "http://" + (v6 ? "[" + address + "]" : address) + ":" + std::to_string(port);
}

Result<ListenSocket> Listen(const std::string& address, int port) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0)
    return Error{"address '" + address +
                 "': expected a numeric address of this machine, e.g. 127.0.0.1"};
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  const int fd = socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return SystemError("no socket for the page");
  const int on = 1;
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const std::string where = address + " port " + std::to_string(port);
  if (bind(fd, found->ai_addr, found->ai_addrlen) < 0 || listen(fd, kBacklog) < 0) {
    const bool used = errno == EADDRINUSE;
    Error error = SystemError("the page cannot be served on " + where);
    if (used) error.message += "; choose another by --port, or 0 for any free one";
    close(fd);
    return error;
  }
  return Describe(fd);
}

bool IsSocketInherited() {
  const int pid = Number("LISTEN_PID");
  return Number("LISTEN_FDS") >= 1 && (pid == -1 || pid == getpid());
}

Result<ListenSocket> TakeInheritedSocket() {
  for (const char* name : {"LISTEN_FDS", "LISTEN_PID", "LISTEN_FDNAMES"}) unsetenv(name);
  int listening = 0, type = 0;
  socklen_t size = sizeof listening;
  if (getsockopt(kFirstInherited, SOL_SOCKET, SO_ACCEPTCONN, &listening, &size) < 0 ||
      getsockopt(kFirstInherited, SOL_SOCKET, SO_TYPE, &type, &size) < 0 || listening == 0 ||
      type != SOCK_STREAM)
    return Error{"LISTEN_FDS is set, but file descriptor 3 is no listening TCP socket"};
  fcntl(kFirstInherited, F_SETFD, FD_CLOEXEC);
  fcntl(kFirstInherited, F_SETFL, fcntl(kFirstInherited, F_GETFL) | O_NONBLOCK);
  return Describe(kFirstInherited);
}

}  // namespace beckon::ui_bridge::web
