#include "tests/faults/relay.h"

#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <arpa/inet.h>
#include <algorithm>
#include <cerrno>
#include <cstring>

namespace beckon::faults {
namespace {

constexpr int kBuffer = 8 << 20;
constexpr int kFramesInARow = 64;  // of one port, before the others' turn

/// A socket that hears and says whole frames of one interface.
Result<int> OpenPort(const std::string& interface) {
  const auto failed = [&] {
    return Error{"relay: " + interface + " cannot be opened: " + std::strerror(errno)};
  };
  const int fd = socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, htons(ETH_P_ALL));
  if (fd < 0) return failed();
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  packet_mreq everything{};
  everything.mr_ifindex = address.sll_ifindex;
  everything.mr_type = PACKET_MR_PROMISC;
  if (address.sll_ifindex == 0 ||
      bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
      setsockopt(fd, SOL_PACKET, PACKET_ADD_MEMBERSHIP, &everything, sizeof everything) != 0) {
    const Error error = failed();
    close(fd);
    return error;
  }
  // As much as the kernel grants.
  for (const int option : {SO_RCVBUF, SO_SNDBUF, SO_RCVBUFFORCE, SO_SNDBUFFORCE})
    setsockopt(fd, SOL_SOCKET, option, &kBuffer, sizeof kBuffer);
  return fd;
}

/// IPv4 and its address resolution; IPv6's chatter is of no interest.
bool IsWanted(const std::vector<uint8_t>& frame) {
  if (frame.size() < sizeof(ether_header)) return false;
  const int type = frame[12] << 8 | frame[13];
  return type == ETHERTYPE_IP || type == ETHERTYPE_ARP;
}

}  // namespace

Result<std::unique_ptr<Relay>> Relay::Start(const std::vector<std::string>& interfaces,
                                            uint64_t seed) {
  std::unique_ptr<Relay> relay(new Relay(interfaces.size(), seed));
  for (const auto& interface : interfaces) {
    auto port = OpenPort(interface);
    if (!port) return port.error();
    relay->ports_.push_back(*port);
  }
  relay->wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (relay->wake_ < 0) return Error{std::string("relay: no eventfd: ") + std::strerror(errno)};
  relay->thread_ = std::thread([&it = *relay] { it.Run(); });
  return relay;
}

Relay::~Relay() {
  const uint64_t end = 1;
  if (thread_.joinable() && write(wake_, &end, sizeof end) == sizeof end) thread_.join();
  for (const int port : ports_) close(port);
  if (wake_ >= 0) close(wake_);
}

void Relay::Change(const std::function<void(LinkFaults&)>& change) {
  const std::lock_guard lock(mutex_);
  change(faults_);
}

Relay::Counts Relay::counts() {
  const std::lock_guard lock(mutex_);
  for (const int port : ports_) {
    tpacket_stats stats{};  // since it was last asked for
    socklen_t length = sizeof stats;
    if (getsockopt(port, SOL_PACKET, PACKET_STATISTICS, &stats, &length) == 0)
      counts_.overrun += stats.tp_drops;
  }
  return counts_;
}

void Relay::Run() {
  std::vector<pollfd> polled;
  for (const int port : ports_) polled.push_back({.fd = port, .events = POLLIN, .revents = 0});
  polled.push_back({.fd = wake_, .events = POLLIN, .revents = 0});
  while (true) {
    poll(polled.data(), polled.size(), WaitMilliseconds());
    if (polled.back().revents != 0) return;
    for (size_t port = 0; port < ports_.size(); ++port) {
      if (polled[port].revents == 0) continue;
      for (int i = 0; i < kFramesInARow && TakeFrame(port); ++i) {
      }
    }
    DeliverDue();
  }
}

int Relay::WaitMilliseconds() const {
  if (due_.empty()) return -1;
  return static_cast<int>(std::max<Utime>(0, (due_.begin()->first - steady_.Now() + 999) / 1000));
}

bool Relay::TakeFrame(size_t port) {
  sockaddr_ll from{};
  socklen_t length = sizeof from;
  const ssize_t size = recvfrom(ports_[port], buffer_.data(), buffer_.size(), 0,
                                reinterpret_cast<sockaddr*>(&from), &length);
  if (size < 0) return false;
  if (from.sll_pkttype == PACKET_OUTGOING) return true;  // the relay's own
  const std::vector<uint8_t> frame(buffer_.begin(), buffer_.begin() + size);
  if (IsWanted(frame)) Plan(port, frame);
  return true;
}

void Relay::Plan(size_t from, const std::vector<uint8_t>& frame) {
  std::vector<size_t> at_once;
  {
    const std::lock_guard lock(mutex_);
    ++counts_.frames;
    for (size_t to = 0; to < ports_.size(); ++to) {
      if (to == from) continue;
      const auto deliveries = faults_.Deliveries(from, to);
      counts_.dropped += deliveries.empty() ? 1 : 0;
      counts_.doubled += deliveries.size() > 1 ? 1 : 0;
      for (const Utime delay : deliveries) {
        if (delay == 0) {
          at_once.push_back(to);
        } else {
          due_.emplace(steady_.Now() + delay, Delivery{to, frame});
        }
      }
    }
  }
  for (const size_t to : at_once) Deliver(to, frame);
}

void Relay::DeliverDue() {
  while (!due_.empty() && due_.begin()->first <= steady_.Now()) {
    const auto node = due_.extract(due_.begin());
    Deliver(node.mapped().to, node.mapped().frame);
  }
}

void Relay::Deliver(size_t to, const std::vector<uint8_t>& frame) {
  const bool sent =
      send(ports_[to], frame.data(), frame.size(), 0) == static_cast<ssize_t>(frame.size());
  const std::lock_guard lock(mutex_);
  ++(sent ? counts_.delivered : counts_.overrun);
}

}  // namespace beckon::faults
