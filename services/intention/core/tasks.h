// The tasks that a user's past and the scene know of, numbered, with what could be wanted when.
#pragma once

#include <span>
#include <vector>

#include "services/intention/core/policy.h"

namespace beckon::intention {

/// What is on the table, by category as numbered by Tasks.
struct Presence {
  static constexpr int kNotRecorded = -1;
  std::vector<int> instances;
  std::vector<double> there;  // 1 where there is an instance or it was not recorded, else 0
};

/// A task is an action with a category of object. Tasks, categories and actions are numbered
/// densely here, the tasks of a category one after another; tasks that are neither in the scene nor
/// were ever wanted do not matter.
class Tasks {
 public:
  Tasks(const Situation& situation, std::span<const PastSession> past);

  int count() const { return static_cast<int>(category_.size()); }
  int categories() const { return static_cast<int>(first_.size()) - 1; }
  int actions() const { return actions_; }
  int category(int task) const { return category_[static_cast<size_t>(task)]; }
  int action(int task) const { return action_[static_cast<size_t>(task)]; }
  /// The tasks of a category are first(c) .. first(c + 1) - 1.
  int first(int category) const { return first_[static_cast<size_t>(category)]; }
  /// By indices of Affordances; of a task that is known.
  int Find(int category, int action) const {
    return number_[static_cast<size_t>(category * kMaxActions + action)];
  }

  /// What was wanted was there.
  void Look(const PastSession& past, Presence& presence) const;
  Presence Look(const Situation& situation) const;

 private:
  std::vector<int> names_;  // of categories: index in Affordances
  std::vector<int> first_;
  std::vector<int> category_;
  std::vector<int> action_;
  std::vector<int> number_;  // of a task by indices of Affordances
  int actions_ = 0;
};

}  // namespace beckon::intention
