#include "services/ui_bridge/web/http_server.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

namespace beckon::ui_bridge::web {
namespace {

constexpr Utime kSweep_us = 100'000;
constexpr int kMostAccepted = 32;       // in one go, so that others are served in between
constexpr int kMostUnsent = 32 * 1024;  // that the system holds: what is newer replaces the rest
constexpr uint64_t kListening = 0;      // instead of a connection's id

std::shared_ptr<const std::string> Shared(std::string bytes) {
  return std::make_shared<const std::string>(std::move(bytes));
}

/// As the HTML standard's "server-sent events" writes it; `data` holds no line feed.
std::string RenderEvent(const std::string& event, const std::string& data) {
  return "event: " + event + "\ndata: " + data + "\n\n";
}

}  // namespace

HttpServer::HttpServer(HttpServerConfig config, int listening, RunLoop& loop, const Clock& steady,
                       Handler handler)
    : config_(config),
      listening_(listening),
      loop_(loop),
      steady_(steady),
      handler_(std::move(handler)),
      epoll_(epoll_create1(EPOLL_CLOEXEC)) {
  epoll_event event{.events = EPOLLIN, .data = {.u64 = kListening}};
  if (epoll_ < 0 || epoll_ctl(epoll_, EPOLL_CTL_ADD, listening_, &event) < 0)
    throw std::system_error(errno, std::generic_category(), "epoll");
  loop_.AddFd(epoll_, [this] { Serve(); });
  sweep_ = loop_.Every(kSweep_us, [this] { Sweep(); });
}

HttpServer::~HttpServer() {
  loop_.Cancel(sweep_);
  loop_.RemoveFd(epoll_);
  for (auto& [id, connection] : connections_) close(connection->fd);
  close(epoll_);
  close(listening_);
}

void HttpServer::Serve() {
  std::array<epoll_event, 32> events;
  const int n = epoll_wait(epoll_, events.data(), events.size(), 0);
  for (int i = 0; i < n; ++i) {
    if (events[i].data.u64 == kListening) {
      Accept();
      continue;
    }
    const auto found = connections_.find(events[i].data.u64);
    if (found != connections_.end()) Handle(*found->second, events[i].events);
  }
}

void HttpServer::Accept() {
  for (int i = 0; i < kMostAccepted; ++i) {
    const int fd = accept4(listening_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd < 0) {
      if (errno == EMFILE || errno == ENFILE) MakeRoom();
      return;
    }
    const int on = 1;
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    setsockopt(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kMostUnsent, sizeof kMostUnsent);
    const uint64_t id = ++ids_;
    epoll_event event{.events = EPOLLIN | EPOLLRDHUP, .data = {.u64 = id}};
    if (epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event) < 0) {
      close(fd);
      continue;
    }
    const Utime now = steady_.Now();
    connections_[id] =
        std::make_unique<HttpConnection>(HttpConnection{.id = id,
                                                        .fd = fd,
                                                        .parser = HttpParser(config_.limits),
                                                        .opened = now,
                                                        .request_since = now,
                                                        .moved = now,
                                                        .told = now});
    ++counts_.accepted;
    if (connections_.size() > config_.connections) MakeRoom();
  }
}

/// Who has been quiet the longest goes; event streams, which are meant to be quiet, last.
void HttpServer::MakeRoom() {
  const auto quietest = std::ranges::min_element(connections_, {}, [](const auto& entry) {
    const HttpConnection& c = *entry.second;
    return std::pair(c.state == HttpConnection::State::kStream, c.moved);
  });
  if (quietest == connections_.end()) return;
  ++counts_.displaced;
  Close(*quietest->second);
}

void HttpServer::Handle(HttpConnection& connection, uint32_t events) {
  if ((events & (EPOLLHUP | EPOLLERR)) != 0) return Close(connection);
  if ((events & (EPOLLIN | EPOLLRDHUP)) != 0 && !connection.Read(steady_.Now()))
    return Close(connection);
  if (!Advance(connection)) return Close(connection);
  Update(connection);
}

/// Writes what waits, and answers requests one after the other as responses are taken away.
bool HttpServer::Advance(HttpConnection& connection) {
  for (;;) {
    if (!connection.Write(steady_.Now())) return false;
    if (connection.sending()) return true;
    if (connection.state == HttpConnection::State::kStream) {
      if (!std::exchange(connection.stale, false)) return true;
      connection.out.push_back(latest_);
      continue;
    }
    if (connection.state == HttpConnection::State::kLingering) return !connection.ended;
    if (connection.close_after) {
      // Closing with bytes unread would take the response away from the client.
      shutdown(connection.fd, SHUT_WR);
      connection.state = HttpConnection::State::kLingering;
      connection.moved = steady_.Now();
      return !connection.ended;
    }
    auto next = connection.parser.Next();
    if (std::holds_alternative<HttpIncomplete>(next)) {
      if (connection.parser.idle()) connection.request_since = 0;
      return !connection.ended;
    }
    if (const auto* refusal = std::get_if<HttpRefusal>(&next)) {
      Refuse(connection, *refusal);
    } else {
      Respond(connection, std::get<HttpRequest>(next));
    }
  }
}

void HttpServer::Respond(HttpConnection& connection, const HttpRequest& request) {
  ++counts_.requests;
  ++connection.requests;
  HttpResponse response;
  try {
    response = handler_(request);
  } catch (const std::exception& e) {
    spdlog::error("web: {} {}: {}", request.method, request.path, e.what());
    return Refuse(connection, {500, "something went wrong here"});
  }
  const bool keep = request.keep_alive && (config_.requests_per_connection == 0 ||
                                           connection.requests < config_.requests_per_connection);
  connection.Say(RenderHead(response, keep && !response.event_stream));
  if (response.body && !response.body->empty() && request.method != "HEAD")
    connection.out.push_back(response.body);
  connection.request_since = 0;
  if (response.event_stream) return BecomeStream(connection);
  connection.close_after = !keep;
}

void HttpServer::Refuse(HttpConnection& connection, const HttpRefusal& refusal) {
  ++counts_.refused;
  HttpResponse response{.status = refusal.status, .content_type = "application/json"};
  response.headers = {{"X-Content-Type-Options", "nosniff"}, {"Cache-Control", "no-store"}};
  response.body = Shared(nlohmann::json{{"error", refusal.error}}.dump());
  connection.Say(RenderHead(response, false));
  connection.out.push_back(response.body);
  connection.close_after = true;
}

void HttpServer::BecomeStream(HttpConnection& connection) {
  if (streams() >= config_.streams) {
    HttpConnection* oldest = nullptr;
    for (auto& [id, other] : connections_) {
      if (other->state == HttpConnection::State::kStream && !other->close_after &&
          (oldest == nullptr || other->opened < oldest->opened))
        oldest = other.get();
    }
    if (oldest != nullptr) {
      ++counts_.displaced;
      EndStream(*oldest, "closed", "too many pages are open; this one was the oldest");
      Update(*oldest);
    }
  }
  connection.state = HttpConnection::State::kStream;
  connection.opened = steady_.Now();
  connection.stale = latest_ != nullptr;
}

/// A last word, if the socket takes it; nothing else is said on it.
void HttpServer::EndStream(HttpConnection& connection, const std::string& event,
                           const std::string& error) {
  connection.Say(RenderEvent(event, nlohmann::json{{"error", error}}.dump()));
  connection.state = HttpConnection::State::kOpen;
  connection.close_after = true;
}

void HttpServer::Publish(const std::string& event, const std::string& data) {
  latest_ = Shared(RenderEvent(event, data));
  std::vector<uint64_t> ended;
  for (auto& [id, connection] : connections_) {
    if (connection->state != HttpConnection::State::kStream) continue;
    connection->stale = true;
    if (!Advance(*connection)) {
      ended.push_back(id);
    } else {
      Update(*connection);
    }
  }
  for (const uint64_t id : ended) Close(*connections_.at(id));
}

/// Tells epoll what the connection waits for.
void HttpServer::Update(HttpConnection& connection) {
  uint32_t wanted = 0;
  if (!connection.ended && !connection.parser.full()) wanted |= EPOLLIN | EPOLLRDHUP;
  if (connection.sending()) wanted |= EPOLLOUT;
  if (wanted == connection.watched) return;
  connection.watched = wanted;
  epoll_event event{.events = wanted, .data = {.u64 = connection.id}};
  epoll_ctl(epoll_, EPOLL_CTL_MOD, connection.fd, &event);
}

void HttpServer::Close(HttpConnection& connection) {
  close(connection.fd);
  connections_.erase(connection.id);
}

void HttpServer::Sweep() {
  const Utime now = steady_.Now();
  for (auto next = connections_.begin(); next != connections_.end();) {
    HttpConnection& connection = *(next++)->second;
    SweepOne(connection, now);
  }
}

void HttpServer::SweepOne(HttpConnection& connection, Utime now) {
  if (connection.sending()) {
    if (now - connection.moved > config_.write_us) Close(connection);
    return;
  }
  switch (connection.state) {
    case HttpConnection::State::kStream:
      if (now - connection.told < config_.heartbeat_us) return;
      connection.Say(": heartbeat\n\n");
      return Handle(connection, 0);
    case HttpConnection::State::kLingering:
      if (now - connection.moved > config_.linger_us) Close(connection);
      return;
    case HttpConnection::State::kOpen:
      if (connection.request_since == 0) {
        if (now - connection.moved > config_.idle_us) Close(connection);
      } else if (now - connection.request_since > config_.request_us) {
        if (connection.parser.idle()) return Close(connection);  // it never asked anything
        Refuse(connection, {408, "the request did not come to its end in time"});
        Handle(connection, 0);
      }
  }
}

size_t HttpServer::streams() const {
  return static_cast<size_t>(std::ranges::count_if(connections_, [](const auto& entry) {
    return entry.second->state == HttpConnection::State::kStream;
  }));
}

size_t HttpServer::connections() const { return connections_.size(); }

}  // namespace beckon::ui_bridge::web
