// Requests out of bytes: what is right is read, whatever the pieces it comes in; all else is
// refused with the status that says why.
#include "services/ui_bridge/web/http_message.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/draws.h"

namespace beckon::ui_bridge::web {
namespace {

/// What the first request of these bytes is refused with; 200 where it is read, 0 where it is not
/// complete.
int StatusOf(const std::string& bytes) {
  HttpParser parser;
  parser.Feed(bytes);
  const auto next = parser.Next();
  if (const auto* refusal = std::get_if<HttpRefusal>(&next)) {
    EXPECT_FALSE(refusal->error.empty());
    return refusal->status;
  }
  return std::holds_alternative<HttpRequest>(next) ? 200 : 0;
}

const std::string kPost =
    "POST /api/answer?view=user&x=a%20b+c HTTP/1.1\r\nHost: localhost:8765\r\n"
    "Content-Type: application/json\r\nAccept: a\r\nAccept: b\r\nContent-Length: 5\r\n\r\n{\"a\"}";

TEST(HttpParser, ReadsARequest) {
  HttpParser parser;
  parser.Feed(kPost);
  const auto next = parser.Next();
  const auto& request = std::get<HttpRequest>(next);
  EXPECT_EQ(request.method, "POST");
  EXPECT_EQ(request.path, "/api/answer");
  EXPECT_EQ(request.Query("view"), "user");
  EXPECT_EQ(request.Query("x"), "a b c");
  EXPECT_EQ(request.Query("y"), "");
  EXPECT_EQ(request.Header("host"), "localhost:8765");
  EXPECT_EQ(request.Header("accept"), "a, b");
  EXPECT_EQ(request.body, "{\"a\"}");
  EXPECT_TRUE(request.keep_alive);
  EXPECT_TRUE(parser.idle());
}

TEST(HttpParser, ReadsTheSameWhereverTheBytesAreCut) {
  for (size_t cut = 1; cut < kPost.size(); ++cut) {
    HttpParser parser;
    parser.Feed(kPost.substr(0, cut));
    ASSERT_TRUE(std::holds_alternative<HttpIncomplete>(parser.Next())) << cut;
    ASSERT_FALSE(parser.idle());
    parser.Feed(kPost.substr(cut));
    const auto next = parser.Next();
    ASSERT_TRUE(std::holds_alternative<HttpRequest>(next)) << cut;
    ASSERT_EQ(std::get<HttpRequest>(next).body, "{\"a\"}");
  }
}

TEST(HttpParser, GivesPipelinedRequestsInOrder) {
  HttpParser parser;
  parser.Feed("\r\n" + kPost + "\r\n" + "GET /next HTTP/1.1\r\nHost: a\r\n\r\nGET /third");
  EXPECT_EQ(std::get<HttpRequest>(parser.Next()).path, "/api/answer");
  EXPECT_EQ(std::get<HttpRequest>(parser.Next()).path, "/next");
  EXPECT_TRUE(std::holds_alternative<HttpIncomplete>(parser.Next()));
}

TEST(HttpParser, ClosesAfterAnOldOrAClosingRequest) {
  HttpParser parser;
  parser.Feed("GET / HTTP/1.0\r\n\r\nGET / HTTP/1.1\r\nConnection: Close\r\n\r\n");
  EXPECT_FALSE(std::get<HttpRequest>(parser.Next()).keep_alive);
  EXPECT_FALSE(std::get<HttpRequest>(parser.Next()).keep_alive);
}

TEST(HttpParser, RefusesWhatIsNotPlainlyRight) {
  const std::string host = "Host: a\r\n\r\n";
  const std::string long_name(3000, 'a');
  const struct {
    std::string bytes;
    int status;
  } cases[] = {
      {"GET / HTTP/1.1\r\n" + host, 200},
      {"nonsense\r\n\r\n", 400},
      {"GET /\r\n\r\n", 400},
      {"GET  / HTTP/1.1\r\n" + host, 400},
      {"GET / HTTP/1.1 \r\n" + host, 400},
      {"G\001T / HTTP/1.1\r\n" + host, 400},
      {"GET / HTTP/2.0\r\n" + host, 505},
      {"GET / HTTQ/1.1\r\n" + host, 400},
      {"GET http://evil/ HTTP/1.1\r\n" + host, 400},
      {"GET * HTTP/1.1\r\n" + host, 400},
      {"GET /#a HTTP/1.1\r\n" + host, 400},
      {"GET /\xc3\xa4 HTTP/1.1\r\n" + host, 400},
      {"GET /?a=%zz HTTP/1.1\r\n" + host, 400},
      {"GET /?a=%2 HTTP/1.1\r\n" + host, 400},
      {"GET /?a=%00 HTTP/1.1\r\n" + host, 400},
      {"GET / HTTP/1.1\nHost: a\n\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost: a\rb\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost : a\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost: a\r\n folded\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\n: a\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nX: a\001b\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\nOrigin: a\r\nOrigin: a\r\n\r\n", 400},
      {"POST / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n", 400},
      {"POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n", 400},
      {"POST / HTTP/1.1\r\nContent-Length: +1\r\n\r\n", 400},
      {"POST / HTTP/1.1\r\nContent-Length: 1 2\r\n\r\n", 400},
      {"POST / HTTP/1.1\r\nContent-Length:\r\n\r\n", 400},
      {"POST / HTTP/1.1\r\nContent-Length: 16384\r\n\r\n", 0},
      {"POST / HTTP/1.1\r\nContent-Length: 16385\r\n\r\n", 413},
      {"POST / HTTP/1.1\r\nContent-Length: 99999999999999999999999\r\n\r\n", 413},
      {"POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n", 501},
      {"POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\nContent-Length: 1\r\n\r\n", 501},
      {"POST / HTTP/1.1\r\nExpect: 100-continue\r\nContent-Length: 1\r\n\r\n", 417},
      {"GET /" + long_name + " HTTP/1.1\r\n" + host, 414},
      {"GET / HTTP/1.1\r\nX: " + std::string(9000, 'a'), 431},
      {"GET /" + std::string(9000, 'a'), 414},
      {std::string(9000, '\0'), 414},
  };
  for (const auto& [bytes, status] : cases)
    EXPECT_EQ(StatusOf(bytes), status) << bytes.substr(0, 80);
  std::string many = "GET / HTTP/1.1\r\n";
  for (int i = 0; i < 65; ++i) many += "X" + std::to_string(i) + ": a\r\n";
  EXPECT_EQ(StatusOf(many + "\r\n"), 431);
}

TEST(HttpParser, GivesNothingAfterARefusal) {
  HttpParser parser;
  parser.Feed("bad\r\n\r\n" + kPost);
  EXPECT_TRUE(std::holds_alternative<HttpRefusal>(parser.Next()));
  parser.Feed(kPost);
  EXPECT_TRUE(std::holds_alternative<HttpIncomplete>(parser.Next()));
}

TEST(HttpParser, HoldsNoMoreThanItsLimitsWhateverComes) {
  HttpParser parser;
  while (!parser.full()) parser.Feed("GET / HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(std::holds_alternative<HttpRequest>(parser.Next()));
}

/// A request changed in a few places, in pieces of any size: read or refused, never more.
TEST(HttpParser, IsSoundForAnyBytes) {
  int read = 0, refused = 0;
  for (unsigned round = 0; round < 20'000; ++round) {
    Draws draws(round);
    std::string bytes = kPost + kPost;
    for (int i = draws.Between(0, 4); i > 0; --i) {
      const size_t at = draws.Index(bytes.size());
      static const std::string kOdd[] = {"\r\n", "\n", "\r", " ", ":", "%", "\r\n\r\n", "\xff"};
      switch (draws.Index(3)) {
        case 0:
          bytes[at] = static_cast<char>(draws());
          break;
        case 1:
          bytes.insert(at, draws.Any(kOdd));
          break;
        default:
          bytes.erase(at, draws.Index(8));
          break;
      }
    }
    HttpParser parser;
    for (size_t at = 0; at < bytes.size();) {
      const size_t n = std::min(bytes.size() - at, 1 + draws.Index(200));
      parser.Feed(std::string_view(bytes).substr(at, n));
      at += n;
      for (;;) {
        const auto next = parser.Next();
        if (std::holds_alternative<HttpIncomplete>(next)) break;
        if (const auto* request = std::get_if<HttpRequest>(&next)) {
          ++read;
          ASSERT_TRUE(request->path.starts_with('/'));
          ASSERT_LE(request->body.size(), bytes.size());
        } else {
          ++refused;
          const int status = std::get<HttpRefusal>(next).status;
          ASSERT_TRUE(status >= 400 && status < 600) << status;
        }
      }
    }
  }
  EXPECT_GT(read, 1000);
  EXPECT_GT(refused, 1000);
}

TEST(HttpHead, SaysLengthAndConnection) {
  HttpResponse response{.status = 404, .content_type = "application/json"};
  response.body = std::make_shared<const std::string>("{}");
  response.headers = {{"X", "y"}};
  EXPECT_EQ(RenderHead(response, false),
            "HTTP/1.1 404 Not Found\r\nContent-Type: application/json\r\nContent-Length: 2\r\n"
            "Connection: close\r\nX: y\r\n\r\n");
  response = {.content_type = "text/event-stream", .event_stream = true};
  EXPECT_EQ(RenderHead(response, true),
            "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\n\r\n");
}

}  // namespace
}  // namespace beckon::ui_bridge::web
