// The socket the page is served on: made here, or inherited from whoever started the program.
#pragma once

#include <string>

#include "services/base/result.h"

namespace beckon::ui_bridge::web {

struct ListenSocket {
  int fd = -1;          // listening, non-blocking, closed on exec; the caller's
  std::string address;  // "127.0.0.1", "::1"
  int port = 0;
  bool loopback = false;  // only this machine reaches it

  /// Without a path, e.g. "http://127.0.0.1:8765".
  std::string Url() const;
};

/// Listens on a numeric address; port 0 = any that is free.
Result<ListenSocket> Listen(const std::string& address, int port);

/// Whether a socket was handed over for this process by systemd's protocol: LISTEN_PID names it (or
/// is not set) and LISTEN_FDS is at least 1.
bool IsSocketInherited();
/// That socket, file descriptor 3. It is taken once; the variables go, so that no child believes
/// that they are meant for it.
Result<ListenSocket> TakeInheritedSocket();

}  // namespace beckon::ui_bridge::web
