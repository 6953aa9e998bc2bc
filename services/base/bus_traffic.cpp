#include "services/base/bus_traffic.h"

#include <utility>

namespace beckon {
namespace {

/// A gap of more than a minute of frames is no loss.
constexpr int64_t kLongestGap = 1800;

}  // namespace

void ChannelTraffic::NoteSeq(int64_t seq) {
  const int64_t before = std::exchange(newest_seq, seq);
  if (before <= 0 || seq <= before) return;
  const int64_t missing = seq - before - 1;
  if (missing <= kLongestGap) lost += missing;
}

int64_t ChannelTraffic::Refused() const {
  int64_t sum = 0;
  for (const auto& [reason, count] : refused) sum += count;
  return sum;
}

void ChannelTraffic::ForgetPeaks() { age_us_max = wait_us_max = handler_us_max = 0; }

}  // namespace beckon
