// A client on real sockets for tests: raw bytes, whole requests, event streams. Every wait has a
// deadline.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace beckon::ui_bridge::web {

using Json = nlohmann::ordered_json;
using HeaderList = std::vector<std::pair<std::string, std::string>>;

struct Reply {
  int status = 0;                              // 0: none came
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;

  Json json() const { return Json::parse(body, nullptr, false); }
};

/// A connection to 127.0.0.1; closed with it.
class Wire {
 public:
  explicit Wire(int port);
  ~Wire();
  Wire(Wire&& other) noexcept : fd_(std::exchange(other.fd_, -1)), buffer_(other.buffer_) {}
  Wire(const Wire&) = delete;

  bool connected() const { return fd_ >= 0; }
  /// False where the other side is gone.
  bool Send(const std::string& bytes);
  /// Says no more, still listens.
  void HalfClose();
  /// The next response with its body; status 0 where none comes.
  Reply Receive(double timeout_s = 5);
  /// Up to a blank line, without it; nothing where none comes.
  std::optional<std::string> ReceiveBlock(double timeout_s = 5);
  /// Whether the other side closes in time; what comes before is read away.
  bool IsClosed(double timeout_s = 5);

 private:
  /// False at the end, or when time is over.
  bool Fill(double deadline_s);

  int fd_ = -1;
  std::string buffer_;
};

/// A whole request on a connection of its own, with a right Host unless `headers` names one.
Reply Ask(int port, const std::string& method, const std::string& path,
          const HeaderList& headers = {}, const std::string& body = {});
Reply Get(int port, const std::string& path);
/// With the Content-Type of JSON.
Reply Send(int port, const std::string& method, const std::string& path, const Json& body);
std::string RequestText(int port, const std::string& method, const std::string& path,
                        const HeaderList& headers = {}, const std::string& body = {});

/// An event stream as a page reads it.
class Stream {
 public:
  explicit Stream(int port, const std::string& query = "");
  const Reply& head() const { return head_; }
  /// Reads until a state is as wanted; nothing after `timeout_s`. The latest is `state`.
  bool Until(const std::function<bool(const Json&)>& wanted, double timeout_s = 5);
  /// The next event's name and data, heartbeats as "heartbeat"; nothing at the end.
  std::optional<std::pair<std::string, std::string>> Next(double timeout_s = 5);
  const Json& state() const { return state_; }
  int states() const { return states_; }

 private:
  Wire wire_;
  Reply head_;
  Json state_;
  int states_ = 0;
};

}  // namespace beckon::ui_bridge::web
