#include "services/intention/core/learner.h"

namespace beckon::intention {
namespace {

/// Half of the new users do not let one task follow another.
constexpr double kNothingFollows = 0.5;
/// Share of the grid's prior that comes back each session: about once in 200 a user changes ways.
constexpr double kShare = 0.005;
/// Weight of what followed a task from one time to the next.
constexpr double kForgetting = 0.95;

size_t Index(int i) { return static_cast<size_t>(i); }

/// Trust in what followed n times.
double Trust(double n, double doubt) { return n / (n + doubt); }

}  // namespace

Learner::Learner(const Tasks& tasks)
    : tasks_(tasks), habit_(tasks), followed_(Index(tasks.count())) {}

Learner::Grid Learner::Prior() {
  Grid prior;
  for (auto& row : prior) {
    row.fill((1 - kNothingFollows) / (kDoubts.size() - 1) / kRepeats.size());
    row.back() = kNothingFollows / kRepeats.size();
  }
  return prior;
}

bool Learner::LastIsPresent(const std::vector<int>& present) const {
  return last_ >= 0 && present[Index(tasks_.category(last_))] != 0;
}

double Learner::Followers(const std::vector<int>& present) const {
  double sum = 0;
  if (last_ < 0) return sum;
  const std::vector<double>& next = followed_[Index(last_)];
  for (size_t t = 0; t < next.size(); ++t) {
    if (present[Index(tasks_.category(static_cast<int>(t)))] != 0) sum += next[t];
  }
  return sum;
}

Learner::Reasons Learner::Weigh(const std::vector<int>& present, double followers) const {
  Reasons mean;
  const bool can_repeat = LastIsPresent(present);
  for (size_t r = 0; r < kRepeats.size(); ++r) {
    const double again = can_repeat ? kRepeats[r] : 0;
    for (size_t d = 0; d < kDoubts.size(); ++d) {
      const double follows = (1 - again) * Trust(followers, kDoubts[d]);
      mean.again += grid_[r][d] * again;
      mean.follows += grid_[r][d] * follows;
      mean.habit += grid_[r][d] * (1 - again - follows);
    }
  }
  return mean;
}

std::vector<double> Learner::Predict(const std::vector<int>& present) {
  const double followers = Followers(present);
  const Reasons reasons = Weigh(present, followers);
  std::vector<double> p = habit_.Predict(present);
  for (double& x : p) x *= reasons.habit;
  if (followers > 0) {
    const std::vector<double>& next = followed_[Index(last_)];
    for (size_t t = 0; t < p.size(); ++t) {
      if (present[Index(tasks_.category(static_cast<int>(t)))] != 0) {
        p[t] += reasons.follows * next[t] / followers;
      }
    }
  }
  if (LastIsPresent(present)) p[Index(last_)] += reasons.again;
  return p;
}

void Learner::Learn(int task, const std::vector<int>& present) {
  const double followers = Followers(present);
  const Reasons reasons = Weigh(present, followers);
  const bool can_repeat = LastIsPresent(present);
  const double habit = habit_.Probability(task, present);
  const double same = task == last_ ? 1 : 0;
  const double next = followers > 0 ? followed_[Index(last_)][Index(task)] / followers : 0;
  const double other = reasons.again * same + reasons.follows * next;
  const double evidence = reasons.habit * habit + other;
  habit_.Learn(task, present, reasons.habit, other);

  const Grid prior = Prior();
  for (size_t r = 0; r < kRepeats.size(); ++r) {
    const double again = can_repeat ? kRepeats[r] : 0;
    for (size_t d = 0; d < kDoubts.size(); ++d) {
      const double trust = Trust(followers, kDoubts[d]);
      const double p = again * same + (1 - again) * (trust * next + (1 - trust) * habit);
      grid_[r][d] = (1 - kShare) * grid_[r][d] * p / evidence + kShare * prior[r][d];
    }
  }
  if (last_ >= 0) {
    std::vector<double>& row = followed_[Index(last_)];
    row.resize(Index(tasks_.count()), 0);
    for (double& x : row) x *= kForgetting;
    row[Index(task)] += 1;
  }
  last_ = task;
}

}  // namespace beckon::intention
