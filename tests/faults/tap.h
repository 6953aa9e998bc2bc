// What an attacker on the network can do with LCM: hear every message as bytes, and say any.
#pragma once

#include <cstdint>
#include <deque>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "services/base/run_loop.h"
#include "tests/faults/lab.h"

namespace beckon::faults {

class Tap {
 public:
  static constexpr size_t kKept = 64;  // latest messages of each channel
  struct Channel {
    int64_t heard = 0;  // one's own too
    int64_t said = 0;
    std::deque<std::vector<uint8_t>> latest;
  };

  /// At a host of the lab; listens in `loop`, which must outlive it.
  Tap(const Lab& lab, size_t host, RunLoop& loop);
  ~Tap();

  void Say(const std::string& channel, std::span<const uint8_t> bytes);
  const std::map<std::string, Channel>& channels() const { return channels_; }

 private:
  void Hear(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  RunLoop& loop_;
  std::unique_ptr<lcm::LCM> lcm_;
  std::map<std::string, Channel> channels_;
};

}  // namespace beckon::faults
