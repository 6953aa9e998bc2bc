#include "tests/faults/link_faults.h"

#include <algorithm>

namespace beckon::faults {

LinkFaults::LinkFaults(size_t hosts, uint64_t seed, const FaultRates& rates)
    : random_(seed), rates_(rates), sides_(hosts, 0) {}

void LinkFaults::Heal() { std::ranges::fill(sides_, 0); }

void LinkFaults::CutAtRandom() {
  if (sides_.size() < 2) return;
  do {
    std::ranges::generate(sides_, [this] { return static_cast<int>(random_() % sides_.size()); });
  } while (std::ranges::all_of(sides_, [this](int side) { return side == sides_[0]; }));
}

std::vector<Utime> LinkFaults::Deliveries(size_t from, size_t to) {
  if (!Connected(from, to) || Happens(rates_.loss)) return {};
  std::vector<Utime> deliveries(Happens(rates_.duplicate) ? 2 : 1, rates_.delay_us);
  for (Utime& delivery : deliveries) {
    if (Happens(rates_.reorder) && rates_.held_back_us > 0)
      delivery += static_cast<Utime>(1 + random_() % static_cast<uint64_t>(rates_.held_back_us));
  }
  return deliveries;
}

}  // namespace beckon::faults
