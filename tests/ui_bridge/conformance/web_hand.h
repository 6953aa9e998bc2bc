// Presses the page's buttons: the requests that a browser makes of them, over real sockets. Waits
// for no response, since the server runs in the same thread.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/ui_bridge/conformance/hand.h"

namespace beckon::ui_bridge::conformance {

class WebHand : public Hand {
 public:
  WebHand() : port_(FreePort()) {
    char name[] = "/tmp/beckon-web-hand-XXXXXX";
    folder_ = mkdtemp(name);
    std::ofstream(folder_ + "/index.html") << "<!doctype html><title>page</title>";
  }
  ~WebHand() override {
    for (const int fd : sockets_) close(fd);
    std::filesystem::remove_all(folder_);
  }

  std::string front_end() const override { return "web"; }
  std::vector<std::string> flags() const override { return {"--port", std::to_string(port_)}; }
  std::string config() const override {
    return "[web]\npage = \"" + folder_ + "\"\ndata = \"" + folder_ + "/data\"\n";
  }
  void Start() override { Send("GET", "/api/events?view=user"); }
  size_t Choose(const msg::Query& query, size_t option) override {
    Post("/api/answer", R"({"query_id": )" + std::to_string(query.id) + R"(, "option": )" +
                            std::to_string(option) + "}");
    return option;
  }
  bool Stop() override { return Post("/api/request", R"({"request": "stop"})"); }
  bool Resume() override {
    return Post("/api/request", R"({"request": "resume", "confirm": true})");
  }
  bool Undo() override { return Post("/api/request", R"({"request": "undo"})"); }

 private:
  static sockaddr_in Loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }

  static int FreePort() {
    sockaddr_in address = Loopback(0);
    auto* any = reinterpret_cast<sockaddr*>(&address);
    socklen_t size = sizeof address;
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (bind(fd, any, size) < 0 || getsockname(fd, any, &size) < 0)
      throw std::runtime_error("no port is free");
    close(fd);
    return ntohs(address.sin_port);
  }

  bool Post(const std::string& path, const std::string& body) {
    return Send(
        "POST", path,
        "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n",
        body);
  }

  bool Send(const std::string& method, const std::string& path, const std::string& headers = {},
            const std::string& body = {}) {
    const std::string text = method + " " + path +
                             " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) + "\r\n" +
                             headers + "\r\n" + body;
    const sockaddr_in address = Loopback(port_);
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockets_.push_back(fd);
    return connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
           send(fd, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }

  const int port_;
  std::string folder_;
  std::vector<int> sockets_;
};

}  // namespace beckon::ui_bridge::conformance
