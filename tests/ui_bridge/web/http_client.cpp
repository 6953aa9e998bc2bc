#include "tests/ui_bridge/web/http_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>

namespace beckon::ui_bridge::web {
namespace {

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string LowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

Wire::Wire(int port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) < 0) {
    close(fd_);
    fd_ = -1;
  }
}

Wire::~Wire() {
  if (fd_ >= 0) close(fd_);
}

bool Wire::Send(const std::string& bytes) {
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t n = send(fd_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (n <= 0) return false;
    done += static_cast<size_t>(n);
  }
  return true;
}

void Wire::HalfClose() { shutdown(fd_, SHUT_WR); }

bool Wire::Fill(double deadline_s) {
  pollfd wait{.fd = fd_, .events = POLLIN, .revents = 0};
  const double left_s = deadline_s - Now_s();
  if (left_s <= 0 || poll(&wait, 1, static_cast<int>(left_s * 1000) + 1) <= 0) return false;
  char bytes[65536];
  const ssize_t n = recv(fd_, bytes, sizeof bytes, 0);
  if (n <= 0) return false;
  buffer_.append(bytes, static_cast<size_t>(n));
  return true;
}

std::optional<std::string> Wire::ReceiveBlock(double timeout_s) {
  const double deadline_s = Now_s() + timeout_s;
  for (;;) {
    for (const std::string end : {"\r\n\r\n", "\n\n"}) {
      const size_t at = buffer_.find(end);
      if (at == std::string::npos) continue;
      std::string block = buffer_.substr(0, at);
      buffer_.erase(0, at + end.size());
      return block;
    }
    if (!Fill(deadline_s)) return {};
  }
}

Reply Wire::Receive(double timeout_s) {
  const double deadline_s = Now_s() + timeout_s;
  const auto head = ReceiveBlock(timeout_s);
  if (!head || !head->starts_with("HTTP/1.1 ")) return {};
  Reply reply{.status = std::atoi(head->c_str() + 9)};
  for (size_t at = head->find("\r\n"); at != std::string::npos; at = head->find("\r\n", at)) {
    at += 2;
    const std::string line = head->substr(at, head->find("\r\n", at) - at);
    const size_t colon = line.find(": ");
    reply.headers[LowerCase(line.substr(0, colon))] = line.substr(colon + 2);
  }
  const size_t length = std::strtoul(reply.headers["content-length"].c_str(), nullptr, 10);
  while (buffer_.size() < length) {
    if (!Fill(deadline_s)) return {};
  }
  reply.body = buffer_.substr(0, length);
  buffer_.erase(0, length);
  return reply;
}

bool Wire::IsClosed(double timeout_s) {
  const double deadline_s = Now_s() + timeout_s;
  while (Fill(deadline_s)) buffer_.clear();
  return Now_s() < deadline_s;
}

std::string RequestText(int port, const std::string& method, const std::string& path,
                        const HeaderList& headers, const std::string& body) {
  std::string text = method + " " + path + " HTTP/1.1\r\n";
  bool host = false;
  for (const auto& [name, value] : headers) {
    text += name + ": " + value + "\r\n";
    host = host || name == "Host";
  }
  if (!host) text += "Host: 127.0.0.1:" + std::to_string(port) + "\r\n";
  if (!body.empty()) text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return text + "\r\n" + body;
}

Reply Ask(int port, const std::string& method, const std::string& path, const HeaderList& headers,
          const std::string& body) {
  Wire wire(port);
  if (!wire.connected() || !wire.Send(RequestText(port, method, path, headers, body))) return {};
  return wire.Receive();
}

Reply Get(int port, const std::string& path) { return Ask(port, "GET", path); }

Reply Send(int port, const std::string& method, const std::string& path, const Json& body) {
  return Ask(port, method, path, {{"Content-Type", "application/json"}}, body.dump());
}

Stream::Stream(int port, const std::string& query) : wire_(port) {
  wire_.Send(RequestText(port, "GET", "/api/events" + query));
  head_ = wire_.Receive();
}

std::optional<std::pair<std::string, std::string>> Stream::Next(double timeout_s) {
  const auto block = wire_.ReceiveBlock(timeout_s);
  if (!block) return {};
  if (block->starts_with(": heartbeat")) return {{"heartbeat", ""}};
  const size_t data = block->find("\ndata: ");
  if (!block->starts_with("event: ") || data == std::string::npos) return {{"garbled", *block}};
  std::pair<std::string, std::string> event{block->substr(7, data - 7), block->substr(data + 7)};
  if (event.first == "state") {
    state_ = Json::parse(event.second, nullptr, false);
    ++states_;
  }
  return event;
}

bool Stream::Until(const std::function<bool(const Json&)>& wanted, double timeout_s) {
  const double deadline_s = Now_s() + timeout_s;
  if (state_.is_object() && wanted(state_)) return true;
  while (Now_s() < deadline_s) {
    const auto event = Next(deadline_s - Now_s());
    if (!event) return false;
    if (event->first == "state" && wanted(state_)) return true;
  }
  return false;
}

}  // namespace beckon::ui_bridge::web
