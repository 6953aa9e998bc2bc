#include "services/intention/core/instance_habit.h"

#include <numeric>

#include "services/intention/core/situation.h"

namespace beckon::intention {
namespace {

/// The nearest 7 times in 10, the next one 7 times in 10 of the rest, ..: as many pseudo-counts.
constexpr double kNearest = 0.7;
/// Pseudo-counts that any instance shares, so that none is out of reach however many there are.
constexpr double kAny = 0.02;
/// Pseudo-counts of the general habit beside those of a category.
constexpr double kGeneral = 1;
constexpr double kForgetting = 0.95;
constexpr std::array<double, 3> kWayPrior = {0.5, 0.4, 0.1};
/// Share of that prior that comes back each session.
constexpr double kShare = 0.02;

}  // namespace

InstanceHabit::InstanceHabit(int categories)
    : way_(kWayPrior), favourite_(static_cast<size_t>(categories)) {}

void InstanceHabit::Counts::Add(int place) {
  if (place >= static_cast<int>(n.size())) n.resize(static_cast<size_t>(place) + 1, 0);
  for (double& x : n) x *= kForgetting;
  n[static_cast<size_t>(place)] += 1;
}

std::array<double, InstanceHabit::kWays> InstanceHabit::Ways(int category, int rank,
                                                             int instances) const {
  const Counts& own = favourite_[static_cast<size_t>(category)];
  const int near_place = rank - 1, far_place = instances - rank;
  double prior = kNearest, near = 0, far = 0, near_sum = 0, far_sum = 0, own_sum = kGeneral;
  for (int place = 0; place < instances; ++place, prior *= 1 - kNearest) {
    const double pseudo = prior + kAny / instances;
    const double from_near = near_.Of(place) + pseudo, from_far = far_.Of(place) + pseudo;
    if (place == near_place) near = from_near;
    if (place == far_place) far = from_far;
    near_sum += from_near;
    far_sum += from_far;
    own_sum += own.Of(place);
  }
  std::array<double, kWays> ways{};
  ways[kFromNearest] = near / near_sum;
  ways[kFavourite] = (own.Of(near_place) + kGeneral * ways[kFromNearest]) / own_sum;
  ways[kFromFurthest] = far / far_sum;
  return ways;
}

std::vector<double> InstanceHabit::Predict(int category, int instances) const {
  std::vector<double> p;
  for (int rank = 1; rank <= instances; ++rank) {
    const auto ways = Ways(category, rank, instances);
    p.push_back(std::inner_product(ways.begin(), ways.end(), way_.begin(), 0.0));
  }
  return p;
}

void InstanceHabit::Learn(int category, int rank, int instances) {
  if (instances == 1 || rank < 1 || rank > kMaxThings) return;
  if (instances >= rank) {
    const auto ways = Ways(category, rank, instances);
    const double evidence = std::inner_product(ways.begin(), ways.end(), way_.begin(), 0.0);
    for (size_t way = 0; way < kWays; ++way) {
      way_[way] = (1 - kShare) * way_[way] * ways[way] / evidence + kShare * kWayPrior[way];
    }
    far_.Add(instances - rank);
  }
  near_.Add(rank - 1);
  favourite_[static_cast<size_t>(category)].Add(rank - 1);
}

}  // namespace beckon::intention
