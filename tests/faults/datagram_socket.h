// Bare datagrams on LCM's group, from a host of the lab: what an attacker can do without LCM.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tests/faults/lab.h"
#include "tests/faults/mutator.h"

namespace beckon::faults {

class DatagramSocket {
 public:
  /// With `stays` nothing that is said leaves the host.
  DatagramSocket(const Lab& lab, size_t host, bool stays);
  ~DatagramSocket();
  DatagramSocket(const DatagramSocket&) = delete;

  int fd() const { return fd_; }
  /// The next that is waiting; empty where none is (or it is empty).
  Datagram Hear();
  /// False where the kernel had no room for it.
  bool Say(std::span<const uint8_t> datagram);
  /// Many at once; how many the kernel took.
  size_t Say(std::span<const Datagram> datagrams);

 private:
  int fd_ = -1;
};

}  // namespace beckon::faults
