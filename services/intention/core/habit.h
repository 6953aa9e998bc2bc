// What a user wants in general: sparse preferences that may have changed at any session.
#pragma once

#include <array>
#include <vector>

#include "services/intention/core/tasks.h"

namespace beckon::intention {

/// A Bayesian mixture over when the preferences last changed (Adams & MacKay, Bayesian Online
/// Changepoint Detection, 2007) and over how the user comes to want what. Preferences are
/// strengths: a task is chosen in proportion among what is on the table (Luce), so that a task that
/// was not there is not thought to be unwanted (Caron & Doucet 2012: gamma priors, gamma
/// posteriors). See docs/intention.md. Everywhere `there` is 1 or 0 by category (Presence).
class Habit {
 public:
  /// `tasks` must outlive the habit.
  explicit Habit(const Tasks& tasks);

  /// P(task | what is there) for every task; 0 for those that are not.
  std::vector<double> Predict(const std::vector<double>& there) const;
  /// Of one task that is there.
  double Probability(int task, const std::vector<double>& there);
  /// The task was wanted. `habit` is the probability that a want comes from habit, `other` that it
  /// does not and is this one: only as much is learnt as habit explains. Just before, Probability
  /// must have been asked of the same task.
  void Learn(int task, const std::vector<double>& there, double habit, double other);

 private:
  static constexpr size_t kEras = 4;
  static constexpr size_t kStyles = 8;

  /// The hypothesis that the preferences are what they are since some session.
  struct Era {
    double posterior = 0;
    double sessions = 0;                  // explained by habit
    double known = 0;                     // tasks that were wanted
    double spread = 0;                    // sessions / (sessions + kEvenness * known)
    std::vector<double> wanted;           // by task: how often
    std::vector<double> category_wanted;  // by category: its sum
    std::vector<double> category_known;   // by category: tasks that were wanted
    std::vector<double> exposure;         // by category: how much it was there to be wanted
    std::vector<double> appeal;           // by category: 1 / (kExposure + exposure)
  };
  /// Strength of a task in an era, but for its appeal:
  ///   wanted + concentration * newness[alike], or, where known tasks are wanted about evenly,
  ///   spread * (wanted + kEvenness * [was wanted]) + concentration * newness[alike].
  struct Style {
    double concentration = 0;  // how many new wants there are
    size_t alike = 0;          // 1: they resemble the known ones
    bool even = false;
    double prior = 0;
  };
  /// What the strengths of all tasks that are there add up from.
  struct Sums {
    double wanted = 0;
    double known = 0;
    std::array<double, 2> newness{};
  };

  static std::array<Style, kStyles> MakeStyles();
  void Clear(Era& era) const;
  Sums Add(const Era& era, const std::vector<double>& there) const;
  static double Total(const Era& era, const Style& style, const Sums& sums);
  /// P(a new want is the task), by Style::alike.
  std::array<double, 2> Newness(int task) const;
  void UpdateNewness();
  void BeginEra();

  const Tasks& tasks_;
  const std::array<Style, kStyles> styles_ = MakeStyles();
  std::array<double, kStyles> style_{};  // posterior
  std::array<Era, kEras> eras_;
  // How often categories and actions were wanted, decayed; where new wants resemble known ones they
  // come in proportion to both.
  std::vector<double> categories_wanted_;
  std::vector<double> actions_wanted_;
  double even_newness_ = 0;   // of a task, where new wants do not resemble known ones
  double alike_newness_ = 0;  // of a task, where they do, by unit of category times action
  std::array<std::vector<double>, 2> category_newness_;
  // Of the last Probability, by era.
  std::array<std::array<double, kStyles>, kEras> likelihood_{};
  std::array<Sums, kEras> sums_{};
};

}  // namespace beckon::intention
