#include "tools/beckon/page_socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace beckon::tool {
namespace {

constexpr int kBacklog = 128;

sockaddr_in Loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<uint16_t>(port));
  return address;
}

/// The socket, or errno as a negative number.
int TryPort(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return -errno;
  const int yes = 1;
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const sockaddr_in address = Loopback(port);
  if (bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      listen(fd, kBacklog) == 0) {
    return fd;
  }
  const int error = errno;
  close(fd);
  return -error;
}

}  // namespace

Result<PageSocket> PageSocket::Listen(int port) {
  int fd = TryPort(port == 0 ? kDefaultPort : port);
  if (fd < 0 && port == 0) fd = TryPort(0);
  if (fd >= 0) return PageSocket(fd);
  return Error{"--port " + std::to_string(port) + ": " + std::strerror(-fd) +
               "; choose another, or leave it out"};
}

PageSocket::PageSocket(PageSocket&& other) noexcept { *this = std::move(other); }

PageSocket& PageSocket::operator=(PageSocket&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

PageSocket::~PageSocket() {
  if (fd_ >= 0) close(fd_);
}

std::string PageSocket::Address() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
  return "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/";
}

void OpenInBrowser(const std::string& address) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  // A grandchild: the browser may outlive us, and nobody has to wait for it.
  const pid_t child = fork();
  if (child == 0) {
    if (fork() != 0) _exit(0);
    setsid();
    const int nothing = open("/dev/null", O_RDWR);
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, fd);
    execlp("xdg-open", "xdg-open", address.c_str(), nullptr);
    _exit(127);
  }
  if (child > 0) waitpid(child, nullptr, 0);
}

}  // namespace beckon::tool
