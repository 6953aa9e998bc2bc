#include "services/intention/core/instance_habit.h"

#include <algorithm>
#include <numeric>

#include "services/intention/core/situation.h"

namespace beckon::intention {
namespace {

/// The nearest 7 times in 10, the next one 7 times in 10 of the rest, ..: as many pseudo-counts.
constexpr double kNearest = 0.7;
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

InstanceHabit::Choices InstanceHabit::Ways(int category, int instances) const {
  Choices ways;
  for (auto& way : ways) way.reserve(static_cast<size_t>(instances));
  const Counts& own = favourite_[static_cast<size_t>(category)];
  double prior = kNearest, sum = 0, own_sum = kGeneral;
  for (int place = 0; place < instances; ++place, prior *= 1 - kNearest) {
    ways[kFromNearest].push_back(near_.Of(place) + prior);
    ways[kFromFurthest].push_back(far_.Of(place) + prior);
    sum += ways[kFromNearest].back();
    own_sum += own.Of(place);
  }
  for (double& p : ways[kFromNearest]) p /= sum;
  std::reverse(ways[kFromFurthest].begin(), ways[kFromFurthest].end());
  const double far_sum =
      std::accumulate(ways[kFromFurthest].begin(), ways[kFromFurthest].end(), 0.0);
  for (double& p : ways[kFromFurthest]) p /= far_sum;
  for (int place = 0; place < instances; ++place) {
    const double general = ways[kFromNearest][static_cast<size_t>(place)];
    ways[kFavourite].push_back((own.Of(place) + kGeneral * general) / own_sum);
  }
  return ways;
}

std::vector<double> InstanceHabit::Predict(int category, int instances) const {
  std::vector<double> p(static_cast<size_t>(instances), 0);
  const Choices ways = Ways(category, instances);
  for (size_t way = 0; way < kWays; ++way) {
    for (size_t i = 0; i < p.size(); ++i) p[i] += way_[way] * ways[way][i];
  }
  return p;
}

void InstanceHabit::Learn(int category, int rank, int instances) {
  if (instances == 1 || rank < 1 || rank > kMaxThings) return;
  if (instances >= rank) {
    const Choices ways = Ways(category, instances);
    double evidence = 0;
    for (size_t way = 0; way < kWays; ++way) {
      way_[way] *= ways[way][static_cast<size_t>(rank) - 1];
      evidence += way_[way];
    }
    for (size_t way = 0; way < kWays; ++way) {
      way_[way] = (1 - kShare) * way_[way] / evidence + kShare * kWayPrior[way];
    }
    far_.Add(instances - rank);
  }
  near_.Add(rank - 1);
  favourite_[static_cast<size_t>(category)].Add(rank - 1);
}

}  // namespace beckon::intention
