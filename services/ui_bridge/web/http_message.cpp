#include "services/ui_bridge/web/http_message.h"

#include <algorithm>
#include <charconv>

namespace beckon::ui_bridge::web {
namespace {

constexpr std::string_view kEndOfHead = "\r\n\r\n";
constexpr size_t kMostQueryParts = 32;

bool IsTokenCharacter(char c) {
  constexpr std::string_view kPunctuation = "!#$%&'*+-.^_`|~";
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         kPunctuation.find(c) != std::string_view::npos;
}

bool IsToken(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, IsTokenCharacter);
}

/// Visible ASCII.
bool IsVisible(char c) { return c > 0x20 && c < 0x7f; }

/// Visible, blank, or beyond ASCII.
bool IsValueCharacter(char c) {
  const auto u = static_cast<unsigned char>(c);
  return u == '\t' || (u >= 0x20 && u != 0x7f);
}

std::string_view Trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  }
  return lower;
}

std::optional<int> HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return {};
}

using Refusal = std::optional<HttpRefusal>;

Refusal ReadQuery(std::string_view text, HttpRequest& request) {
  for (size_t parts = 0; !text.empty(); ++parts) {
    if (parts == kMostQueryParts) return HttpRefusal{400, "too many parts in the query"};
    const std::string_view part = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    const size_t equals = part.find('=');
    const auto name = DecodeQueryPart(part.substr(0, equals));
    const auto value = equals == std::string_view::npos ? std::optional<std::string>("")
                                                        : DecodeQueryPart(part.substr(equals + 1));
    if (!name || !value) return HttpRefusal{400, "the query is not well encoded"};
    request.query.emplace(*name, *value);
  }
  return {};
}

Refusal ReadRequestLine(std::string_view line, HttpRequest& request) {
  const size_t first = line.find(' ');
  const size_t second = line.find(' ', first == std::string_view::npos ? first : first + 1);
  if (second == std::string_view::npos || line.find(' ', second + 1) != std::string_view::npos)
    return HttpRefusal{400, "the request line is not METHOD TARGET VERSION"};
  const std::string_view method = line.substr(0, first);
  const std::string_view target = line.substr(first + 1, second - first - 1);
  const std::string_view version = line.substr(second + 1);
  if (!IsToken(method)) return HttpRefusal{400, "the method is no word"};
  if (version != "HTTP/1.1" && version != "HTTP/1.0")
    return HttpRefusal{version.starts_with("HTTP/") ? 505 : 400, "only HTTP/1.1 is spoken here"};
  if (!target.starts_with('/') || !std::ranges::all_of(target, IsVisible) ||
      target.find('#') != std::string_view::npos)
    return HttpRefusal{400, "the target is no path"};
  request.method = method;
  request.keep_alive = version == "HTTP/1.1";
  request.path = target.substr(0, target.find('?'));
  if (request.path.size() == target.size()) return {};
  return ReadQuery(target.substr(request.path.size() + 1), request);
}

Refusal ReadHeader(std::string_view line, HttpRequest& request) {
  const size_t colon = line.find(':');
  if (colon == std::string_view::npos || !IsToken(line.substr(0, colon)))
    return HttpRefusal{400, "a header is not NAME: VALUE"};
  const std::string_view value = Trimmed(line.substr(colon + 1));
  if (!std::ranges::all_of(value, IsValueCharacter))
    return HttpRefusal{400, "a header holds what no header may hold"};
  const auto [header, added] =
      request.headers.emplace(LowerCase(line.substr(0, colon)), std::string(value));
  if (added) return {};
  // Two of these are how requests are smuggled past one of two readers.
  for (const char* once : {"host", "content-length", "content-type", "origin", "cookie"}) {
    if (header->first == once)
      return HttpRefusal{400, "there are two headers '" + header->first + "'"};
  }
  header->second.append(", ").append(value);
  return {};
}

Refusal ReadHead(std::string_view head, const HttpLimits& limits, HttpRequest& request) {
  size_t lines = 0;
  while (!head.empty()) {
    const std::string_view line = head.substr(0, head.find("\r\n"));
    head.remove_prefix(std::min(head.size(), line.size() + 2));
    if (line.find_first_of("\r\n") != std::string_view::npos)
      return HttpRefusal{400, "a line ends in half an end of line"};
    if (lines == 0 && line.size() > limits.line_bytes)
      return HttpRefusal{414, "the request line is too long"};
    if (lines > limits.headers) return HttpRefusal{431, "too many headers"};
    if (auto refusal = lines++ == 0 ? ReadRequestLine(line, request) : ReadHeader(line, request))
      return refusal;
  }
  return {};
}

/// Length of the body, or a refusal.
std::variant<size_t, HttpRefusal> BodyLength(const HttpRequest& request, const HttpLimits& limits) {
  if (request.headers.contains("transfer-encoding"))
    return HttpRefusal{501, "only bodies with a Content-Length are read"};
  if (request.headers.contains("expect")) return HttpRefusal{417, "send the body without waiting"};
  const auto header = request.headers.find("content-length");
  if (header == request.headers.end()) return size_t{0};
  const std::string& text = header->second;
  if (text.empty() || !std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; }))
    return HttpRefusal{400, "the Content-Length is no number"};
  size_t length = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  if (error != std::errc() || length > limits.body_bytes)
    return HttpRefusal{413,
                       "the body is larger than " + std::to_string(limits.body_bytes) + " bytes"};
  return length;
}

const char* Reason(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 302:
      return "Found";
    case 304:
      return "Not Modified";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 409:
      return "Conflict";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 415:
      return "Unsupported Media Type";
    case 417:
      return "Expectation Failed";
    case 421:
      return "Misdirected Request";
    case 431:
      return "Request Header Fields Too Large";
    case 500:
      return "Internal Server Error";
    case 501:
      return "Not Implemented";
    case 503:
      return "Service Unavailable";
    case 505:
      return "HTTP Version Not Supported";
    default:
      return "Status";
  }
}

}  // namespace

std::string HttpRequest::Header(const std::string& lower_case_name) const {
  const auto found = headers.find(lower_case_name);
  return found == headers.end() ? std::string() : found->second;
}

std::string HttpRequest::Query(const std::string& name) const {
  const auto found = query.find(name);
  return found == query.end() ? std::string() : found->second;
}

void HttpParser::Feed(std::string_view bytes) {
  if (!refused_) buffer_.append(bytes);
}

std::optional<HttpRefusal> HttpParser::TakeHead() {
  // Before a request an empty line means nothing (RFC 9112, 2.2).
  while (buffer_.starts_with("\r\n")) buffer_.erase(0, 2), scanned_ = 0;
  const size_t end = buffer_.find(kEndOfHead, scanned_);
  if (end == std::string::npos) {
    scanned_ = buffer_.size() < kEndOfHead.size() ? 0 : buffer_.size() - kEndOfHead.size() + 1;
    if (buffer_.size() <= limits_.head_bytes) return {};
    const bool line = buffer_.find("\r\n") > limits_.line_bytes;
    return HttpRefusal{line ? 414 : 431, "the request's head is too long"};
  }
  scanned_ = 0;
  if (end > limits_.head_bytes) return HttpRefusal{431, "the request's head is too long"};
  HttpRequest request;
  if (auto refusal = ReadHead(std::string_view(buffer_).substr(0, end), limits_, request))
    return refusal;
  const auto length = BodyLength(request, limits_);
  if (const auto* refusal = std::get_if<HttpRefusal>(&length)) return *refusal;
  body_bytes_ = std::get<size_t>(length);
  const std::string connection = LowerCase(request.Header("connection"));
  if (connection.find("close") != std::string::npos) request.keep_alive = false;
  buffer_.erase(0, end + kEndOfHead.size());
  head_ = std::move(request);
  return {};
}

std::variant<HttpIncomplete, HttpRequest, HttpRefusal> HttpParser::Next() {
  if (refused_) return HttpIncomplete{};
  if (!head_) {
    if (auto refusal = TakeHead()) {
      refused_ = true;
      buffer_.clear();
      return *std::move(refusal);
    }
  }
  if (!head_ || buffer_.size() < body_bytes_) return HttpIncomplete{};
  HttpRequest request = *std::exchange(head_, std::nullopt);
  request.body = buffer_.substr(0, body_bytes_);
  buffer_.erase(0, body_bytes_);
  return request;
}

std::string RenderHead(const HttpResponse& response, bool keep_alive) {
  std::string head =
      "HTTP/1.1 " + std::to_string(response.status) + " " + Reason(response.status) + "\r\n";
  if (!response.content_type.empty()) head += "Content-Type: " + response.content_type + "\r\n";
  if (!response.event_stream && response.status != 304) {
    const size_t size = response.body ? response.body->size() : 0;
    head += "Content-Length: " + std::to_string(size) + "\r\n";
  }
  if (!keep_alive) head += "Connection: close\r\n";
  for (const auto& [name, value] : response.headers) head += name + ": " + value + "\r\n";
  return head + "\r\n";
}

std::optional<std::string> DecodeQueryPart(std::string_view text) {
  std::string decoded;
  for (size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '+') {
      c = ' ';
    } else if (c == '%') {
      if (i + 2 >= text.size()) return {};
      const auto high = HexDigit(text[i + 1]), low = HexDigit(text[i + 2]);
      if (!high || !low) return {};
      c = static_cast<char>(*high * 16 + *low);
      i += 2;
    }
    if (c == '\0') return {};
    decoded += c;
  }
  return decoded;
}

}  // namespace beckon::ui_bridge::web
