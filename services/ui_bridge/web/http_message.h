// HTTP/1.1 as the page's server speaks it: requests out of bytes, and responses into bytes. A
// small, strict part of RFC 9110 and 9112: no chunked bodies, no folded lines, no bare line feeds,
// no absolute targets. What is not plainly right is refused with a status, never guessed at.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace beckon::ui_bridge::web {

struct HttpLimits {
  size_t line_bytes = 2048;   // request line; more is 414
  size_t head_bytes = 8192;   // request line and headers; more is 431
  size_t headers = 64;        // more is 431
  size_t body_bytes = 16384;  // more is 413
};

struct HttpRequest {
  std::string method;                          // upper case
  std::string path;                            // as it came, up to '?'; never decoded
  std::map<std::string, std::string> query;    // decoded; of a repeated name the first counts
  std::map<std::string, std::string> headers;  // names in lower case; repeated ones joined by ", "
  std::string body;
  bool keep_alive = false;  // the client takes another response after this one

  /// Empty where there is none.
  std::string Header(const std::string& lower_case_name) const;
  std::string Query(const std::string& name) const;
};

/// A request that is none: to be answered by `status`, then closed.
struct HttpRefusal {
  int status;
  std::string error;  // for people
};

/// The request is not complete.
struct HttpIncomplete {};

/// Takes bytes as they come, gives requests one after the other. After a refusal it gives nothing
/// more.
class HttpParser {
 public:
  explicit HttpParser(HttpLimits limits = {}) : limits_(limits) {}

  void Feed(std::string_view bytes);
  std::variant<HttpIncomplete, HttpRequest, HttpRefusal> Next();

  /// Nothing of a request has come yet.
  bool idle() const { return !head_ && buffer_.empty(); }
  /// A reader stops here, and goes on after Next.
  bool full() const { return buffer_.size() >= limits_.head_bytes + limits_.body_bytes; }

 private:
  /// Takes a whole head out of the buffer, if there is one.
  std::optional<HttpRefusal> TakeHead();

  const HttpLimits limits_;
  std::string buffer_;
  size_t scanned_ = 0;               // no end of a head begins before it
  std::optional<HttpRequest> head_;  // of the request whose body is being waited for
  size_t body_bytes_ = 0;            // that it announced
  bool refused_ = false;
};

struct HttpResponse {
  int status = 200;
  std::string content_type;  // empty: no body
  std::vector<std::pair<std::string, std::string>> headers;
  std::shared_ptr<const std::string> body;  // null: none
  bool event_stream = false;                // stays open; what is published follows the head
};

/// Status line and headers with the empty line; Content-Length unless it is an event stream.
std::string RenderHead(const HttpResponse& response, bool keep_alive);

/// %XX and '+'; none where a % is not followed by two digits, or for a NUL.
std::optional<std::string> DecodeQueryPart(std::string_view text);

}  // namespace beckon::ui_bridge::web
