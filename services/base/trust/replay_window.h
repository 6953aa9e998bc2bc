// Which counters of a sender were seen: each is good once, and those that come too far behind are
// taken for old. Counters of seal_t have large gaps, so a set and not RFC 6479's bitmap.
#pragma once

#include <cstdint>
#include <set>

namespace beckon::trust {

class ReplayWindow {
 public:
  /// So many messages may overtake one another.
  static constexpr size_t kSize = 256;

  bool IsFresh(int64_t counter) const { return counter > floor_ && !seen_.contains(counter); }

  void Note(int64_t counter) {
    if (!IsFresh(counter)) return;
    seen_.insert(counter);
    if (seen_.size() <= kSize) return;
    floor_ = *seen_.begin();
    seen_.erase(seen_.begin());
  }

 private:
  int64_t floor_ = -1;  // everything up to here is old
  std::set<int64_t> seen_;
};

}  // namespace beckon::trust
