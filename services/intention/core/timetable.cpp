#include "services/intention/core/timetable.h"

#include <array>
#include <cstdlib>

namespace beckon::intention {
namespace {

/// A want's weight for the slots at this distance: the standard deviation is half an hour.
constexpr std::array<double, 4> kKernel = {1, 0.6065, 0.1353, 0.0111};
/// Weight of what was wanted at a time from one time to the next.
constexpr double kForgetting = 0.98;
/// Share of the prior that comes back each session (fixed share, Herbster & Warmuth 1998).
constexpr double kShare = 0.005;

size_t Index(int i) { return static_cast<size_t>(i); }

}  // namespace

Timetable::Hour Timetable::At(Utime utime, const std::vector<double>& there) const {
  constexpr Utime kDay = Utime{24} * 3'600 * kSecond;
  Hour hour;
  if (utime == 0) return hour;
  hour.slot = static_cast<int>((utime % kDay + kDay) % kDay / (kDay / kSlots));
  if (unit_.empty()) return hour;
  for (int c = 0; c < tasks_.categories(); ++c) {
    hour.wanted += there[Index(c)] * category_counts_[CategoryCount(hour.slot, c)];
  }
  hour.trust = hour.wanted / (hour.wanted + unit_[Index(hour.slot)]);
  return hour;
}

double Timetable::Probability(const Hour& hour, int task) const {
  return hour.wanted > 0 ? counts_[Count(hour.slot, task)] / hour.wanted : 0;
}

void Timetable::Learn(const Hour& hour, int task, double habit, double reason, double other) {
  if (hour.slot < 0) return;
  const double timely = hour.trust * Probability(hour, task) + (1 - hour.trust) * habit;
  const double usual = by_the_clock_ * timely + (1 - by_the_clock_) * habit;
  by_the_clock_ *= (1 - kShare) * (reason * timely + other) / (reason * usual + other);
  by_the_clock_ += kShare * kPrior;
  if (unit_.empty()) {
    unit_.assign(kSlots, 1);
    counts_.assign(Count(kSlots, 0), 0);
    category_counts_.assign(CategoryCount(kSlots, 0), 0);
  }
  constexpr int kReach = static_cast<int>(kKernel.size()) - 1;
  for (int away = -kReach; away <= kReach; ++away) {
    Note((hour.slot + away + kSlots) % kSlots, task, kKernel[Index(std::abs(away))]);
  }
}

void Timetable::Note(int slot, int task, double weight) {
  double& unit = unit_[Index(slot)];
  unit /= 1 - (1 - kForgetting) * weight;
  counts_[Count(slot, task)] += weight * unit;
  category_counts_[CategoryCount(slot, tasks_.category(task))] += weight * unit;
}

}  // namespace beckon::intention
