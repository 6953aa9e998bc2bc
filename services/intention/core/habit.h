// What a user wants in general: sparse preferences that may have changed at any session.
#pragma once

#include <array>
#include <vector>

#include "services/intention/core/tasks.h"

namespace beckon::intention {

/// A Bayesian mixture over when the preferences last changed (Adams & MacKay, Bayesian Online
/// Changepoint Detection, 2007) and over how the user comes to want something new. Preferences are
/// strengths: a task is chosen in proportion among what is on the table (Luce), so that a task that
/// was not there is not thought to be unwanted (Caron & Doucet 2012: gamma priors, gamma
/// posteriors). See docs/intention.md.
class Habit {
 public:
  explicit Habit(const Tasks& tasks);

  /// P(task | what is present) for every task; 0 for those that are not there.
  std::vector<double> Predict(const std::vector<int>& present);
  /// Of one task that is present; Learn of the same task may follow.
  double Probability(int task, const std::vector<int>& present);
  /// The task was wanted: with probability `habit` out of habit, and `other` is the probability
  /// that it would be wanted, and for another reason.
  void Learn(int task, const std::vector<int>& present, double habit, double other);

 private:
  static constexpr int kEras = 5;
  static constexpr int kStyles = 6;

  /// The hypothesis that the preferences are what they are since some session. Strength of a task:
  /// (wanted + concentration * newness) * appeal.
  struct Era {
    double posterior = 0;
    std::vector<double> wanted;           // by task
    std::vector<double> category_wanted;  // by category: its sum
    std::vector<double> exposure;         // by category: how much it was there to be wanted
    std::vector<double> appeal;           // by category: 1 / (kExposure + exposure)
  };
  /// How new wants come about: how many there are and whether they resemble known ones.
  struct Style {
    double concentration = 0;
    bool alike = false;
    double prior = 0;
  };
  /// Of an era, over what is present.
  struct Strengths {
    double wanted = 0;
    std::array<double, 2> newness{};
  };

  void Clear(Era& era) const;
  Strengths Present(const Era& era, const std::vector<int>& present) const;
  /// Recomputes where new wants come from.
  void UpdateNewness();
  void Change(Era& newest);

  const Tasks& tasks_;
  std::array<Era, kEras> eras_;
  std::array<Style, kStyles> styles_{};
  std::array<double, kStyles> style_{};  // posterior
  // Where a new want comes from, by task, and its sum by category: 0 evenly, 1 in proportion to how
  // often its category and how often its action were wanted.
  std::array<std::vector<double>, 2> newness_;
  std::array<std::vector<double>, 2> category_newness_;
  std::vector<double> categories_wanted_;
  std::vector<double> actions_wanted_;
  // Of the last Probability: by era and style, and by era what is present.
  std::array<std::array<double, kStyles>, kEras> likelihood_{};
  std::array<Strengths, kEras> strengths_{};
};

}  // namespace beckon::intention
