// One client of the server: its socket, what came of its next request, what waits to be sent to it.
#pragma once

#include <sys/epoll.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "services/base/utime.h"
#include "services/ui_bridge/web/http_message.h"

namespace beckon::ui_bridge::web {

struct HttpConnection {
  enum class State {
    kOpen,      // requests are read and answered
    kStream,    // events are sent
    kLingering  // all is said; what still comes is read away, so that the client gets the last word
  };
  using Bytes = std::shared_ptr<const std::string>;

  uint64_t id;  // never used again
  int fd;       // non-blocking; the server's
  HttpParser parser;
  State state = State::kOpen;
  std::deque<Bytes> out;
  size_t sent = 0;           // of out.front()
  bool close_after = false;  // what waits to be sent
  bool ended = false;        // the client says no more
  bool stale = false;        // the stream has to be told the latest
  size_t lingered = 0;       // bytes read away
  size_t requests = 0;
  uint32_t watched = EPOLLIN | EPOLLRDHUP;  // what epoll was told
  Utime opened;
  Utime request_since;  // first byte of a request that is not complete; 0 = none
  Utime moved;          // last byte received or taken
  Utime told;           // last byte of a stream

  bool sending() const { return !out.empty(); }
  void Say(std::string bytes);
  /// Both take what the socket gives or takes without waiting; false where the connection is over.
  bool Read(Utime now);
  bool Write(Utime now);
};

}  // namespace beckon::ui_bridge::web
