// Endpoints that hear each other by multicast: messages are lost, doubled and late, the network
// falls apart and heals, endpoints are killed and stand still. Time is counted here.
#pragma once

#include <functional>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "services/base/utime.h"

namespace beckon::intention {

class UnreliableNetwork {
 public:
  static constexpr Utime kStep = 10'000;
  static constexpr Utime kMostDelay = 40'000;
  /// Of messages from one endpoint to another, however unlucky.
  static constexpr int kMostLostInARow = 2;

  UnreliableNetwork(size_t endpoints, uint64_t seed, double loss)
      : random_(seed), loss_(loss), endpoints_(endpoints) {}

  Utime now() const { return now_; }
  std::mt19937_64& random() { return random_; }
  uint64_t Below(uint64_t n) { return random_() % n; }
  bool Awake(size_t i) const { return endpoints_[i].alive && now_ >= endpoints_[i].paused_until; }
  bool Alive(size_t i) const { return endpoints_[i].alive; }
  bool Connected(size_t a, size_t b) const { return endpoints_[a].side == endpoints_[b].side; }

  void Kill(size_t i) {
    endpoints_[i].alive = false;
    ++endpoints_[i].run;
  }
  void Revive(size_t i) { endpoints_[i].alive = true; }
  void Pause(size_t i, Utime duration) { endpoints_[i].paused_until = now_ + duration; }
  void Move(size_t i, int side) { endpoints_[i].side = side; }

  /// Calls `deliver` with each endpoint that hears it, the sender too.
  void Send(size_t from, const std::function<void(size_t)>& deliver) {
    for (size_t to = 0; to < endpoints_.size(); ++to) {
      if (!Connected(from, to) || !endpoints_[to].alive || IsLost(from, to)) continue;
      const Delivery delivery{to, endpoints_[to].run, deliver};
      due_.emplace(now_ + Delay(from, to), delivery);
      if (loss_ > 0 && from != to && Below(20) == 0) due_.emplace(now_ + Delay(from, to), delivery);
    }
  }

  /// A step ahead. What came for one that stands still waits until it goes on.
  void Step() {
    now_ += kStep;
    std::multimap<Utime, Delivery> later;
    while (!due_.empty() && due_.begin()->first <= now_) {
      auto node = due_.extract(due_.begin());
      const Delivery& delivery = node.mapped();
      if (endpoints_[delivery.to].run != delivery.run) continue;  // killed since
      if (Awake(delivery.to)) {
        delivery.deliver(delivery.to);
      } else {
        later.insert(std::move(node));
      }
    }
    due_.merge(later);
  }

 private:
  struct Endpoint {
    bool alive = true;
    int run = 0;
    Utime paused_until = 0;
    int side = 0;  // of the cut
  };
  struct Delivery {
    size_t to;
    int run;
    std::function<void(size_t)> deliver;
  };

  Utime Delay(size_t from, size_t to) {
    return from == to ? 0 : 1 + static_cast<Utime>(Below(kMostDelay));
  }
  bool IsLost(size_t from, size_t to) {
    if (from == to) return false;
    int& row = lost_in_a_row_[{from, to}];
    const bool lost = row < kMostLostInARow && static_cast<double>(Below(1000)) < loss_ * 1000;
    row = lost ? row + 1 : 0;
    return lost;
  }

  std::mt19937_64 random_;
  const double loss_;
  std::vector<Endpoint> endpoints_;
  Utime now_ = 1000 * kSecond;
  std::multimap<Utime, Delivery> due_;
  std::map<std::pair<size_t, size_t>, int> lost_in_a_row_;
};

}  // namespace beckon::intention
