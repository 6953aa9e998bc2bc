// Serves HTTP on a listening socket from within the run loop: no thread of its own, so that a
// request is heard in the moment it is complete and nothing it does needs a lock. Nobody can hold
// it up: sockets never block, a request has to be complete within seconds, what is not taken away
// is dropped, and where all places are taken the connection that has been quiet the longest makes
// room.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "services/base/run_loop.h"
#include "services/ui_bridge/web/http_connection.h"

namespace beckon::ui_bridge::web {

struct HttpServerConfig {
  HttpLimits limits;
  size_t connections = 128;            // at once
  size_t streams = 16;                 // of those that are event streams; the oldest goes first
  Utime request_us = 5 * kSecond;      // from its first byte (or the connection) to its last
  Utime idle_us = 60 * kSecond;        // between requests
  Utime write_us = 10 * kSecond;       // without one byte taken of what waits to be sent
  Utime heartbeat_us = 2 * kSecond;    // of a quiet event stream
  Utime linger_us = kSecond;           // to read what comes after a refusal
  size_t requests_per_connection = 0;  // 0 = any number
};

struct HttpServerCounts {
  int64_t accepted = 0;
  int64_t requests = 0;
  int64_t refused = 0;    // malformed, too large or too slow
  int64_t displaced = 0;  // connections that made room
};

class HttpServer {
 public:
  /// Called in the loop's thread for each complete request.
  using Handler = std::function<HttpResponse(const HttpRequest&)>;

  /// Takes `listening`, a listening TCP socket, over. `loop`, `steady` outlive the server.
  HttpServer(HttpServerConfig config, int listening, RunLoop& loop, const Clock& steady,
             Handler handler);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// What every event stream is to know: sent to those that are open and, at once, to those that
  /// come. A stream that is slow gets the latest only.
  void Publish(const std::string& event, const std::string& data);

  /// Event streams that are open.
  size_t streams() const;
  size_t connections() const;
  const HttpServerCounts& counts() const { return counts_; }

 private:
  void Serve();
  void Accept();
  void MakeRoom();
  void Handle(HttpConnection& connection, uint32_t events);
  /// False where the connection is over.
  bool Advance(HttpConnection& connection);
  void Respond(HttpConnection& connection, const HttpRequest& request);
  void Refuse(HttpConnection& connection, const HttpRefusal& refusal);
  void BecomeStream(HttpConnection& connection);
  void EndStream(HttpConnection& connection, const std::string& event, const std::string& error);
  void Update(HttpConnection& connection);
  void Close(HttpConnection& connection);
  void Sweep();
  void SweepOne(HttpConnection& connection, Utime now);

  const HttpServerConfig config_;
  const int listening_;
  RunLoop& loop_;
  const Clock& steady_;
  const Handler handler_;
  int epoll_ = -1;
  bool accepting_ = true;
  RunLoop::TimerId sweep_ = 0;
  uint64_t ids_ = 0;
  std::map<uint64_t, std::unique_ptr<HttpConnection>> connections_;  // by id
  HttpConnection::Bytes latest_;                                     // event, as it is sent
  HttpServerCounts counts_;
};

}  // namespace beckon::ui_bridge::web
