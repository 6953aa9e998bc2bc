// What a user wants at which time of day.
#pragma once

#include <vector>

#include "services/base/utime.h"
#include "services/intention/core/tasks.h"

namespace beckon::intention {

/// Counts wants by time of day, each less and less for the times around it too (Gaussian kernel).
/// A user who lives by the clock wants again what was wanted about now n times with probability
/// n / (n + 1); whether this one does is a posterior (Bayes, fixed share). Only the phase within 24
/// hours matters, so that no time zone has to be known. Everywhere `there` is 1 or 0 by category
/// (Presence). See docs/intention.md.
class Timetable {
 public:
  /// `tasks` must outlive the timetable.
  explicit Timetable(const Tasks& tasks) : tasks_(tasks) {}

  /// What is known of a time, given what is there.
  struct Hour {
    int slot = -1;      // of the day; -1: the time is not known
    double wanted = 0;  // that is there, in units of the slot
    double trust = 0;   // n / (n + 1), 0 where nothing is known
  };

  Hour At(Utime utime, const std::vector<double>& there) const;
  /// P(a want that is not the last task's doing comes from the timetable).
  double Reason(const Hour& hour) const { return by_the_clock_ * hour.trust; }
  /// P(task | hour, it comes from the timetable), of a task that is there; 0 where nothing is
  /// known.
  double Probability(const Hour& hour, int task) const;
  /// The task was wanted. `habit` is its probability by habit, `reason` that a want comes from
  /// habit or timetable, `other` that it does not and is this one.
  void Learn(const Hour& hour, int task, double habit, double reason, double other);

 private:
  static constexpr int kSlots = 48;  // half hours
  /// P(user lives by the clock) at first.
  static constexpr double kPrior = 0.2;

  size_t Count(int slot, int task) const {
    return static_cast<size_t>(slot * tasks_.count() + task);
  }
  size_t CategoryCount(int slot, int category) const {
    return static_cast<size_t>(slot * tasks_.categories() + category);
  }
  void Note(int slot, int task, double weight);

  const Tasks& tasks_;
  double by_the_clock_ = kPrior;  // posterior
  // Empty until a time is known. Old counts do not shrink, their slot's unit grows.
  std::vector<double> unit_;             // by slot
  std::vector<double> counts_;           // by slot and task
  std::vector<double> category_counts_;  // by slot and category: their sum
};

}  // namespace beckon::intention
