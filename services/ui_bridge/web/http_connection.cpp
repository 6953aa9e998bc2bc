#include "services/ui_bridge/web/http_connection.h"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <utility>

namespace beckon::ui_bridge::web {
namespace {

constexpr size_t kMostLingering = 256 * 1024;  // bytes after the last word

}  // namespace

void HttpConnection::Say(std::string bytes) {
  out.push_back(std::make_shared<const std::string>(std::move(bytes)));
}

bool HttpConnection::Read(Utime now) {
  std::array<char, 16384> bytes;
  const ssize_t n = recv(fd, bytes.data(), bytes.size(), 0);
  if (n < 0) return errno == EAGAIN || errno == EINTR;
  if (n == 0) {
    // Who says no more may still listen for the response; a stream's reader has left.
    ended = true;
    return state == State::kOpen;
  }
  moved = now;
  switch (state) {
    case State::kLingering:
      lingered += static_cast<size_t>(n);
      return lingered <= kMostLingering;
    case State::kStream:
      return true;  // nothing is asked on a stream
    case State::kOpen:
      if (request_since == 0) request_since = now;
      parser.Feed({bytes.data(), static_cast<size_t>(n)});
      return true;
  }
  return false;
}

bool HttpConnection::Write(Utime now) {
  while (sending()) {
    const std::string& front = *out.front();
    const ssize_t n = send(fd, front.data() + sent, front.size() - sent,
                           MSG_NOSIGNAL | (out.size() > 1 ? MSG_MORE : 0));
    if (n < 0) return errno == EAGAIN || errno == EINTR;
    moved = told = now;
    sent += static_cast<size_t>(n);
    if (sent < front.size()) return true;
    sent = 0;
    out.pop_front();
  }
  return true;
}

}  // namespace beckon::ui_bridge::web
