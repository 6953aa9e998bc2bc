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

}  // namespace

Learner::Learner(const Tasks& tasks)
    : tasks_(tasks), habit_(tasks), timetable_(tasks), followed_(Index(tasks.count())) {}

Learner::Grid Learner::Prior() {
  Grid prior;
  for (auto& row : prior) {
    row.fill((1 - kNothingFollows) / (kDoubts.size() - 1) / kRepeats.size());
    row.back() = kNothingFollows / kRepeats.size();
  }
  return prior;
}

Learner::Past Learner::Recall(const std::vector<double>& there) const {
  Past past;
  if (last_ < 0) return past;
  past.repeatable = there[Index(tasks_.category(last_))];
  const std::vector<double>& next = followed_[Index(last_)];
  for (size_t t = 0; t < next.size(); ++t) {
    past.followers += there[Index(tasks_.category(static_cast<int>(t)))] * next[t];
  }
  for (size_t d = 0; d < kDoubts.size(); ++d) {
    past.trust[d] = past.followers / (past.followers + kDoubts[d]);
  }
  return past;
}

Learner::Reasons Learner::Weigh(const Past& past) const {
  Reasons mean;
  for (size_t r = 0; r < kRepeats.size(); ++r) {
    const double again = past.repeatable * kRepeats[r];
    for (size_t d = 0; d < kDoubts.size(); ++d) {
      mean.again += grid_[r][d] * again;
      mean.follows += grid_[r][d] * (1 - again) * past.trust[d];
      mean.habit += grid_[r][d] * (1 - again) * (1 - past.trust[d]);
    }
  }
  return mean;
}

std::vector<double> Learner::Predict(const std::vector<double>& there, Utime utime) const {
  const Past past = Recall(there);
  const Reasons reasons = Weigh(past);
  std::vector<double> p = habit_.Predict(there);
  const Timetable::Hour hour = timetable_.At(utime, there);
  const double timetable = timetable_.Reason(hour);
  for (size_t t = 0; t < p.size(); ++t) {
    const int task = static_cast<int>(t);
    const double timely = there[Index(tasks_.category(task))] * timetable_.Probability(hour, task);
    p[t] = reasons.habit * (timetable * timely + (1 - timetable) * p[t]);
  }
  if (last_ >= 0) p[Index(last_)] += reasons.again;
  if (past.followers <= 0) return p;
  const std::vector<double>& next = followed_[Index(last_)];
  for (size_t t = 0; t < p.size(); ++t) {
    const double here = there[Index(tasks_.category(static_cast<int>(t)))];
    p[t] += reasons.follows * here * next[t] / past.followers;
  }
  return p;
}

void Learner::Learn(int task, const std::vector<double>& there, Utime utime) {
  const Past past = Recall(there);
  const Reasons reasons = Weigh(past);
  const double habit = habit_.Probability(task, there);
  const Timetable::Hour hour = timetable_.At(utime, there);
  const double timetable = timetable_.Reason(hour);
  const double timely = timetable * timetable_.Probability(hour, task);
  const double usual = timely + (1 - timetable) * habit;
  const double same = task == last_ ? 1 : 0;
  const double next =
      past.followers > 0 ? followed_[Index(last_)][Index(task)] / past.followers : 0;
  const double other = reasons.again * same + reasons.follows * next;
  const double evidence = reasons.habit * usual + other;
  habit_.Learn(task, there, reasons.habit * (1 - timetable), reasons.habit * timely + other);
  timetable_.Learn(hour, task, habit, reasons.habit, other);

  static const Grid kPrior = Prior();
  for (size_t r = 0; r < kRepeats.size(); ++r) {
    const double again = past.repeatable * kRepeats[r];
    for (size_t d = 0; d < kDoubts.size(); ++d) {
      const double likelihood =
          again * same + (1 - again) * (past.trust[d] * next + (1 - past.trust[d]) * usual);
      grid_[r][d] *= (1 - kShare) * likelihood / evidence;
      grid_[r][d] += kShare * kPrior[r][d];
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
