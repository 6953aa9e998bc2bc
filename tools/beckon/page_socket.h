// The address at which a person's browser finds the page, made before the demo moves into a network
// of its own: a socket stays in the network in which it was made.
#pragma once

#include <string>

#include "services/base/result.h"

namespace beckon::tool {

/// A listening socket on this machine's loopback; closed with this object.
class PageSocket {
 public:
  /// `port` 0: kDefaultPort where it is free, else any.
  static Result<PageSocket> Listen(int port);
  static constexpr int kDefaultPort = 8765;

  PageSocket() = default;
  PageSocket(PageSocket&& other) noexcept;
  PageSocket& operator=(PageSocket&& other) noexcept;
  ~PageSocket();

  int fd() const { return fd_; }
  /// "http://127.0.0.1:8765/".
  std::string Address() const;

 private:
  explicit PageSocket(int fd) : fd_(fd) {}
  int fd_ = -1;
};

/// Asks the desktop for a browser; nothing happens where there is no desktop. Call it before the
/// process moves into another network.
void OpenInBrowser(const std::string& address);

}  // namespace beckon::tool
