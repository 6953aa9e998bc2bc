// The switch between the hosts of the lab: hands each Ethernet frame of a port to all the others,
// with the faults it is told.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "services/base/result.h"
#include "tests/faults/link_faults.h"

namespace beckon::faults {

class Relay {
 public:
  struct Counts {
    int64_t frames = 0;     // taken from a port
    int64_t delivered = 0;  // to one other port each
    int64_t dropped = 0;    // by the faults and the cuts
    int64_t doubled = 0;    // likewise
    int64_t overrun = 0;    // that the kernel dropped since the relay was too slow
  };

  /// Of one network interface a host, in the network of the calling thread.
  static Result<std::unique_ptr<Relay>> Start(const std::vector<std::string>& interfaces,
                                              uint64_t seed);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// Changes what happens from now on.
  void Change(const std::function<void(LinkFaults&)>& change);
  Counts counts();

 private:
  explicit Relay(size_t ports, uint64_t seed) : faults_(ports, seed) {}
  void Run();
  /// False where the port has nothing more.
  bool TakeFrame(size_t port);
  void Plan(size_t from, const std::vector<uint8_t>& frame);
  void DeliverDue();
  void Deliver(size_t to, const std::vector<uint8_t>& frame);
  int WaitMilliseconds() const;

  struct Delivery {
    size_t to;
    std::vector<uint8_t> frame;
  };

  std::vector<int> ports_;
  int wake_ = -1;     // eventfd that ends Run
  std::mutex mutex_;  // of faults_ and counts_
  LinkFaults faults_;
  Counts counts_;
  std::multimap<Utime, Delivery> due_;
  std::vector<uint8_t> buffer_ = std::vector<uint8_t>(70'000);
  SteadyClock steady_;
  std::thread thread_;
};

}  // namespace beckon::faults
