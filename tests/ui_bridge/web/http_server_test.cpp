// The server against clients that are slow, many, broken or hostile: a stop gets through at once.
#include "services/ui_bridge/web/http_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "services/ui_bridge/web/listen_socket.h"
#include "tests/draws.h"
#include "tests/ui_bridge/web/http_client.h"

namespace beckon::ui_bridge::web {
namespace {

using ::testing::HasSubstr;

HttpResponse Plain(std::string text, int status = 200) {
  HttpResponse response{.status = status, .content_type = "text/plain"};
  response.body = std::make_shared<const std::string>(std::move(text));
  return response;
}

/// A server in a thread of its own, with short deadlines.
class HttpServerTest : public ::testing::Test {
 protected:
  void Start(HttpServerConfig config) {
    auto socket = Listen("127.0.0.1", 0);
    ASSERT_TRUE(socket) << socket.error().message;
    port_ = socket->port;
    server_ = std::make_unique<HttpServer>(config, socket->fd, loop_, steady_,
                                           [this](const HttpRequest& r) { return Respond(r); });
    thread_ = std::thread([this] { loop_.Run(); });
  }
  static HttpServerConfig Quick() {
    HttpServerConfig config;
    config.request_us = 400'000;
    config.idle_us = 600'000;
    config.write_us = 700'000;
    config.linger_us = 300'000;
    config.heartbeat_us = 200'000;
    return config;
  }
  void SetUp() override { Start(Quick()); }
  void TearDown() override {
    if (thread_.joinable()) {
      loop_.Stop();
      thread_.join();
    }
    server_.reset();
    thread_ = {};
  }

  HttpResponse Respond(const HttpRequest& request) {
    if (request.path == "/api/events") {
      HttpResponse response{.content_type = "text/event-stream"};
      response.event_stream = true;
      return response;
    }
    if (request.path == "/throws") throw std::runtime_error("broken");
    if (request.path == "/large") return Plain(std::string(4'000'000, 'x'));
    if (request.path == "/stop") ++stops_;
    return Plain(request.method + request.path + request.body);
  }
  /// Runs in the loop's thread, waits for it.
  void InLoop(std::function<void()> work) {
    std::atomic<bool> done = false;
    loop_.Post([&] {
      work();
      done = true;
      done.notify_all();
    });
    done.wait(false);
  }
  void Publish(int n) {
    InLoop([&] { server_->Publish("state", "{\"n\":" + std::to_string(n) + "}"); });
  }
  HttpServerCounts Counts() {
    HttpServerCounts counts;
    InLoop([&] { counts = server_->counts(); });
    return counts;
  }
  size_t Streams() {
    size_t streams = 0;
    InLoop([&] { streams = server_->streams(); });
    return streams;
  }
  /// A stop on a connection of its own gets an answer within half a second.
  void ExpectStopGetsThrough() {
    const auto begin = std::chrono::steady_clock::now();
    const int before = stops_;
    EXPECT_EQ(Ask(port_, "POST", "/stop").status, 200);
    EXPECT_EQ(stops_, before + 1);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
  }

  RunLoop loop_;
  const SteadyClock steady_;
  std::unique_ptr<HttpServer> server_;
  std::thread thread_;
  int port_ = 0;
  std::atomic<int> stops_ = 0;
};

TEST_F(HttpServerTest, AnswersOneRequestAfterTheOtherOnAConnection) {
  Wire wire(port_);
  for (int i = 0; i < 100; ++i) {
    wire.Send(RequestText(port_, "POST", "/a", {}, std::to_string(i)));
    const Reply reply = wire.Receive();
    ASSERT_EQ(reply.status, 200);
    ASSERT_EQ(reply.body, "POST/a" + std::to_string(i));
  }
  EXPECT_EQ(Counts().accepted, 1);
}

TEST_F(HttpServerTest, AnswersPipelinedRequestsInOrder) {
  std::string all;
  for (int i = 0; i < 200; ++i) all += RequestText(port_, "POST", "/a", {}, std::to_string(i));
  Wire wire(port_);
  std::thread writer([&] { wire.Send(all); });
  for (int i = 0; i < 200; ++i) ASSERT_EQ(wire.Receive().body, "POST/a" + std::to_string(i));
  writer.join();
}

TEST_F(HttpServerTest, SendsHeadersAloneToHead) {
  Wire wire(port_);
  wire.Send(RequestText(port_, "HEAD", "/abc"));
  const auto head = wire.ReceiveBlock();
  ASSERT_TRUE(head);
  EXPECT_THAT(*head, HasSubstr("Content-Length: 8"));
  wire.Send(RequestText(port_, "GET", "/next"));
  EXPECT_EQ(wire.Receive().body, "GET/next");
}

TEST_F(HttpServerTest, SpeaksToOldAndHalfClosedClientsAndCloses) {
  Wire old(port_);
  old.Send("GET /old HTTP/1.0\r\n\r\n");
  EXPECT_EQ(old.Receive().body, "GET/old");
  EXPECT_TRUE(old.IsClosed());
  Wire half(port_);
  half.Send(RequestText(port_, "GET", "/half"));
  half.HalfClose();
  EXPECT_EQ(half.Receive().body, "GET/half");
  EXPECT_TRUE(half.IsClosed());
}

TEST_F(HttpServerTest, AnswersAndThenClosesWhatIsWrong) {
  const struct {
    std::string bytes;
    int status;
  } cases[] = {
      {"nonsense\r\n\r\n", 400},
      {"GET / HTTP/3.0\r\n\r\n", 505},
      {"POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 501},
      {"POST / HTTP/1.1\r\nContent-Length: 1000000\r\n\r\n" + std::string(100'000, 'x'), 413},
      {"GET / HTTP/1.1\r\nX: " + std::string(50'000, 'x'), 431},
      {"GET /" + std::string(50'000, 'x'), 414},
      {"GET /throws HTTP/1.1\r\nHost: a\r\n\r\n", 500},
  };
  for (const auto& [bytes, status] : cases) {
    Wire wire(port_);
    wire.Send(bytes);
    const Reply reply = wire.Receive();
    EXPECT_EQ(reply.status, status) << bytes.substr(0, 60);
    EXPECT_NE(reply.json()["error"].get<std::string>(), "");
    EXPECT_EQ(reply.headers.at("connection"), "close");
    EXPECT_TRUE(wire.IsClosed()) << status;
  }
  ExpectStopGetsThrough();
}

TEST_F(HttpServerTest, GivesUpOnARequestThatDoesNotEndHowevertItDrips) {
  for (const std::string& begin :
       {std::string("GET /slow HTTP/1.1\r\nX: "),
        std::string("POST /slow HTTP/1.1\r\nHost: a\r\nContent-Length: 10000\r\n\r\n")}) {
    Wire wire(port_);
    wire.Send(begin);
    const auto start = std::chrono::steady_clock::now();
    Reply reply;
    while (reply.status == 0 &&
           std::chrono::steady_clock::now() - start < std::chrono::seconds(5)) {
      wire.Send("a");
      reply = wire.Receive(0.05);
    }
    EXPECT_EQ(reply.status, 408);
    EXPECT_TRUE(wire.IsClosed());
  }
  EXPECT_EQ(Counts().refused, 2);
}

TEST_F(HttpServerTest, ClosesConnectionsThatNeverAskAndThoseThatAreIdle) {
  Wire silent(port_);
  EXPECT_TRUE(silent.IsClosed());
  Wire idle(port_);
  idle.Send(RequestText(port_, "GET", "/a"));
  EXPECT_EQ(idle.Receive().status, 200);
  EXPECT_TRUE(idle.IsClosed());
}

TEST_F(HttpServerTest, DropsWhoDoesNotTakeTheResponse) {
  Wire lazy(port_);
  std::string all;
  for (int i = 0; i < 4; ++i) all += RequestText(port_, "GET", "/large");
  lazy.Send(all);
  Wire other(port_);
  for (int i = 0; i < 100; ++i) {
    size_t open = 0;
    InLoop([&] { open = server_->connections(); });
    if (open == 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // no event tells a drop
  }
  ADD_FAILURE() << "still there after 5 s";
}

TEST_F(HttpServerTest, TellsStreamsTheLatestAtOnceThenEveryChangeAndThatItIsAlive) {
  Publish(1);
  Stream stream(port_);
  EXPECT_EQ(stream.head().headers.at("content-type"), "text/event-stream");
  ASSERT_TRUE(stream.Until([](const Json& s) { return s["n"] == 1; }));
  for (int n = 2; n < 20; ++n) {
    Publish(n);
    ASSERT_TRUE(stream.Until([n](const Json& s) { return s["n"] == n; })) << n;
  }
  const auto next = stream.Next(2);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->first, "heartbeat");
}

TEST_F(HttpServerTest, TellsASlowStreamTheLatestOnly) {
  TearDown();
  HttpServerConfig patient = Quick();
  patient.write_us = 20 * kSecond;
  Start(patient);
  Stream stream(port_);
  ASSERT_EQ(stream.head().status, 200);
  const std::string padding(200'000, 'x');
  for (int n = 1; n <= 200; ++n)
    InLoop([&] { server_->Publish("state", Json{{"n", n}, {"padding", padding}}.dump()); });
  ASSERT_TRUE(stream.Until([](const Json& s) { return s["n"] == 200; }, 10));
  EXPECT_LT(stream.states(), 150) << "40 MB were not kept for it";
}

TEST_F(HttpServerTest, ClosesTheOldestOfTooManyStreamsWithAWord) {
  std::vector<std::unique_ptr<Stream>> streams;
  for (int i = 0; i < 16; ++i) streams.push_back(std::make_unique<Stream>(port_));
  for (const auto& stream : streams) ASSERT_EQ(stream->head().status, 200);
  EXPECT_EQ(Streams(), 16u);
  Stream newest(port_);
  std::optional<std::pair<std::string, std::string>> event;
  do {
    event = streams[0]->Next();
  } while (event && event->first == "heartbeat");
  ASSERT_TRUE(event);
  EXPECT_EQ(event->first, "closed");
  EXPECT_THAT(event->second, HasSubstr("error"));
  EXPECT_FALSE(streams[0]->Next()) << "closed";
  EXPECT_EQ(Streams(), 16u);
  Publish(5);
  EXPECT_TRUE(newest.Until([](const Json& s) { return s["n"] == 5; }));
  EXPECT_TRUE(streams[1]->Until([](const Json& s) { return s["n"] == 5; }));
}

TEST_F(HttpServerTest, LetsAStopThroughWhile200ConnectionsAnd50StreamsAreOpen) {
  std::vector<std::unique_ptr<Stream>> streams;
  for (int i = 0; i < 50; ++i) streams.push_back(std::make_unique<Stream>(port_));
  std::vector<std::unique_ptr<Wire>> wires;
  for (int i = 0; i < 200; ++i) {
    wires.push_back(std::make_unique<Wire>(port_));
    ASSERT_TRUE(wires.back()->connected());
    if (i % 3 == 0) wires.back()->Send("POST /a HTTP/1.1\r\nContent-Le");
    if (i % 40 == 0) ExpectStopGetsThrough();
  }
  ExpectStopGetsThrough();
  const auto counts = Counts();
  EXPECT_GE(counts.accepted, 250);
  EXPECT_GT(counts.displaced, 0);
  Publish(1);
  EXPECT_TRUE(streams.back()->Until([](const Json& s) { return s["n"] == 1; }))
      << "a stream is not pushed out by connections that ask nothing";
}

TEST_F(HttpServerTest, IsNotHeldUpByClientsThatComeAndGoAtAnyMoment) {
  for (unsigned round = 0; round < 300; ++round) {
    Draws draws(round);
    Wire wire(port_);
    const std::string request = RequestText(port_, "POST", "/a", {}, "body");
    wire.Send(request.substr(0, draws.Index(request.size() + 1)));
    if (draws.OneIn(3)) wire.HalfClose();
    if (draws.OneIn(3)) wire.Receive(0.01);
  }
  ExpectStopGetsThrough();
}

/// Requests with bytes changed, in pieces, on real sockets: each connection is answered or closed.
TEST_F(HttpServerTest, IsSoundForAnyBytes) {
  int answered = 0;
  for (unsigned round = 0; round < 500; ++round) {
    Draws draws(round);
    std::string bytes = RequestText(port_, "POST", "/a", {{"X", "y"}}, "body");
    for (int i = draws.Between(0, 3); i > 0; --i)
      bytes[draws.Index(bytes.size())] = static_cast<char>(draws());
    Wire wire(port_);
    const size_t cut = draws.Index(bytes.size());
    wire.Send(bytes.substr(0, cut));
    wire.Send(bytes.substr(cut));
    wire.HalfClose();
    const Reply reply = wire.Receive();
    if (reply.status != 0) ++answered;
    ASSERT_TRUE(wire.IsClosed()) << round;
  }
  EXPECT_GT(answered, 300);
  ExpectStopGetsThrough();
}

TEST(ListenSocket, SaysWhereItListensAndThatAPortIsTaken) {
  const auto socket = Listen("127.0.0.1", 0);
  ASSERT_TRUE(socket);
  EXPECT_TRUE(socket->loopback);
  EXPECT_EQ(socket->Url(), "http://127.0.0.1:" + std::to_string(socket->port));
  const auto taken = Listen("127.0.0.1", socket->port);
  ASSERT_FALSE(taken);
  EXPECT_THAT(taken.error().message, HasSubstr("--port"));
  close(socket->fd);
  for (const char* wrong : {"", "localhost", "300.0.0.1", "example.org", "192.0.2.1"})
    EXPECT_FALSE(Listen(wrong, 0)) << wrong;
}

}  // namespace
}  // namespace beckon::ui_bridge::web
