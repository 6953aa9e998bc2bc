// Which task a user wants next, learnt from one confirmed session after another.
#pragma once

#include <array>
#include <vector>

#include "services/intention/core/habit.h"
#include "services/intention/core/tasks.h"
#include "services/intention/core/timetable.h"

namespace beckon::intention {

/// A want has one of four reasons: the same task again; what followed the last task before; what is
/// wanted at this time of day; or habit. How often it is which is the user's own: a grid of
/// possible users, weighed by how well each predicted this one (Bayes), with a little of the prior
/// coming back each session so that the weights follow a change (fixed share, Herbster & Warmuth
/// 1998). See docs/intention.md.
class Learner {
 public:
  /// `tasks` must outlive the learner.
  explicit Learner(const Tasks& tasks);

  /// P(task | what is there, when) for every task; 0 for those that are not there. `utime` 0: not
  /// known.
  std::vector<double> Predict(const std::vector<double>& there, Utime utime = 0) const;
  /// The task was wanted. `there` is 1 or 0 by category (Presence), 1 for the task's.
  void Learn(int task, const std::vector<double>& there, Utime utime = 0);

 private:
  /// How often the last task is wanted again where it is there.
  static constexpr std::array<double, 4> kRepeats = {0, 0.3, 0.6, 0.9};
  /// What followed n times is trusted n / (n + doubt); the last: never.
  static constexpr std::array<double, 3> kDoubts = {0.4, 4, 1e9};
  using Grid = std::array<std::array<double, kDoubts.size()>, kRepeats.size()>;

  /// What the last task says of the next one, given what is there.
  struct Past {
    double repeatable = 0;  // 1 where the last task can be wanted again, else 0
    double followers = 0;   // times that something followed it that is there
    std::array<double, kDoubts.size()> trust{};  // in those
  };
  /// Probabilities of the reasons.
  struct Reasons {
    double again = 0;
    double follows = 0;
    double habit = 0;  // or timetable
  };

  static Grid Prior();
  Past Recall(const std::vector<double>& there) const;
  /// Mean over the grid.
  Reasons Weigh(const Past& past) const;

  const Tasks& tasks_;
  Habit habit_;
  Timetable timetable_;
  Grid grid_ = Prior();  // posterior
  int last_ = -1;
  std::vector<std::vector<double>> followed_;  // by task, then by task that came next
};

}  // namespace beckon::intention
