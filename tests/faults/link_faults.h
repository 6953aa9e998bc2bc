// What a bad network does to each frame, decided by a seed: lost, doubled, late, cut off. Pure; the
// relay obeys.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "services/base/utime.h"

namespace beckon::faults {

/// Chances 0..1, of each frame on its way to each of the other hosts.
struct FaultRates {
  double loss = 0;
  double duplicate = 0;
  double reorder = 0;           // held back, so that later frames overtake it
  Utime held_back_us = 20'000;  // at most
  Utime delay_us = 0;           // of every frame
};

class LinkFaults {
 public:
  LinkFaults(size_t hosts, uint64_t seed, const FaultRates& rates = {});

  void SetRates(const FaultRates& rates) { rates_ = rates; }
  /// Host i is on side sides[i]; frames stay on their side.
  void Cut(const std::vector<int>& sides) { sides_ = sides; }
  /// A cut at random that leaves at least one host alone on its side.
  void CutAtRandom();
  void Heal();
  bool Connected(size_t from, size_t to) const { return sides_[from] == sides_[to]; }

  /// After how long a frame arrives: never (empty), once, or twice.
  std::vector<Utime> Deliveries(size_t from, size_t to);

 private:
  bool Happens(double chance) { return chance > 0 && chances_(random_) < chance; }

  std::mt19937_64 random_;
  std::uniform_real_distribution<double> chances_{0, 1};
  FaultRates rates_;
  std::vector<int> sides_;
};

}  // namespace beckon::faults
