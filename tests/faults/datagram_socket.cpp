#include "tests/faults/datagram_socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace beckon::faults {
namespace {

constexpr int kLargest = 65'535;
constexpr int kBuffer = 4 << 20;

sockaddr_in Group() {
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(7667);
  inet_pton(AF_INET, "239.255.76.67", &group.sin_addr);
  return group;
}

void Must(int result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

}  // namespace

DatagramSocket::DatagramSocket(const Lab& lab, size_t host, bool stays) {
  lab.In(host, [&] {
    Must(fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0), "socket");
    const int yes = 1;
    Must(setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes), "SO_REUSEADDR");
    for (const int option : {SO_RCVBUF, SO_SNDBUF})
      setsockopt(fd_, SOL_SOCKET, option, &kBuffer, sizeof kBuffer);
    const uint8_t hops = stays ? 0 : 1;
    Must(setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_TTL, &hops, sizeof hops), "IP_MULTICAST_TTL");
    const sockaddr_in group = Group();
    Must(bind(fd_, reinterpret_cast<const sockaddr*>(&group), sizeof group), "bind");
    const ip_mreq membership{.imr_multiaddr = group.sin_addr, .imr_interface = {INADDR_ANY}};
    Must(setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership), "join");
  });
}

DatagramSocket::~DatagramSocket() {
  if (fd_ >= 0) close(fd_);
}

Datagram DatagramSocket::Hear() {
  Datagram datagram(kLargest);
  const ssize_t size = recv(fd_, datagram.data(), datagram.size(), 0);
  datagram.resize(static_cast<size_t>(std::max<ssize_t>(size, 0)));
  return datagram;
}

bool DatagramSocket::Say(std::span<const uint8_t> datagram) {
  const sockaddr_in group = Group();
  return sendto(fd_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&group),
                sizeof group) >= 0;
}

size_t DatagramSocket::Say(std::span<const Datagram> datagrams) {
  sockaddr_in group = Group();
  std::vector<iovec> parts(datagrams.size());
  std::vector<mmsghdr> messages(datagrams.size());
  for (size_t i = 0; i < datagrams.size(); ++i) {
    parts[i] = {const_cast<uint8_t*>(datagrams[i].data()), datagrams[i].size()};
    messages[i].msg_hdr.msg_name = &group;
    messages[i].msg_hdr.msg_namelen = sizeof group;
    messages[i].msg_hdr.msg_iov = &parts[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  const int sent = sendmmsg(fd_, messages.data(), static_cast<unsigned>(messages.size()), 0);
  return static_cast<size_t>(std::max(sent, 0));
}

}  // namespace beckon::faults
