#include "services/intention/core/habit.h"

#include <algorithm>
#include <numeric>

namespace beckon::intention {
namespace {

/// P(the preferences change after a session).
constexpr double kChange = 0.01;
/// Of the Dirichlet priors: a new user wants a few things, some or many.
constexpr std::array<double, 3> kConcentrations = {1, 4, 16};
/// P(new wants resemble the known ones), at first.
constexpr double kAlike = 0.3;
/// Share of the styles' prior that comes back each session (Herbster & Warmuth 1998).
constexpr double kStyleShare = 0.01;
/// Prior exposure of a category, in sessions; the middle concentration.
constexpr double kExposure = 4;
/// Of categories and actions when new wants are thought to resemble known ones.
constexpr double kPseudoCount = 0.3;
constexpr double kForgetting = 0.98;

size_t Index(int i) { return static_cast<size_t>(i); }

}  // namespace

Habit::Habit(const Tasks& tasks) : tasks_(tasks) {
  size_t i = 0;
  for (const double concentration : kConcentrations) {
    for (const bool alike : {false, true}) {
      styles_[i] = {concentration, alike, (alike ? kAlike : 1 - kAlike) / kConcentrations.size()};
      style_[i] = styles_[i].prior;
      ++i;
    }
  }
  for (Era& era : eras_) Clear(era);
  eras_[0].posterior = 1;
  newness_.fill(std::vector<double>(Index(tasks.count()), 1.0 / std::max(1, tasks.count())));
  category_newness_.fill(std::vector<double>(Index(tasks.categories()), 0));
  for (int t = 0; t < tasks.count(); ++t) {
    category_newness_[0][Index(tasks.category(t))] += newness_[0][Index(t)];
  }
  categories_wanted_.assign(Index(tasks.categories()), 0);
  actions_wanted_.assign(Index(tasks.actions()), 0);
  UpdateNewness();
}

void Habit::Clear(Era& era) const {
  era.posterior = 0;
  era.wanted.assign(Index(tasks_.count()), 0);
  era.category_wanted.assign(Index(tasks_.categories()), 0);
  era.exposure.assign(Index(tasks_.categories()), 0);
  era.appeal.assign(Index(tasks_.categories()), 1 / kExposure);
}

Habit::Strengths Habit::Present(const Era& era, const std::vector<int>& present) const {
  Strengths sum;
  for (size_t c = 0; c < present.size(); ++c) {
    const double appeal = present[c] != 0 ? era.appeal[c] : 0;
    sum.wanted += appeal * era.category_wanted[c];
    sum.newness[0] += appeal * category_newness_[0][c];
    sum.newness[1] += appeal * category_newness_[1][c];
  }
  return sum;
}

std::vector<double> Habit::Predict(const std::vector<int>& present) {
  std::vector<double> p(Index(tasks_.count()), 0);
  for (const Era& era : eras_) {
    if (era.posterior <= 0) continue;
    const Strengths sum = Present(era, present);
    double wanted = 0;  // what a unit of strength is worth
    std::array<double, 2> newness{};
    for (size_t s = 0; s < kStyles; ++s) {
      const double k = styles_[s].concentration;
      const double unit =
          era.posterior * style_[s] / (sum.wanted + k * sum.newness[styles_[s].alike]);
      wanted += unit;
      newness[styles_[s].alike] += k * unit;
    }
    for (size_t t = 0; t < p.size(); ++t) {
      const auto c = Index(tasks_.category(static_cast<int>(t)));
      if (present[c] == 0) continue;
      p[t] += era.appeal[c] *
              (wanted * era.wanted[t] + newness[0] * newness_[0][t] + newness[1] * newness_[1][t]);
    }
  }
  return p;
}

double Habit::Probability(int task, const std::vector<int>& present) {
  const auto t = Index(task), c = Index(tasks_.category(task));
  double p = 0;
  for (size_t e = 0; e < kEras; ++e) {
    const Era& era = eras_[e];
    const Strengths sum = strengths_[e] = Present(era, present);
    for (size_t s = 0; s < kStyles; ++s) {
      const double k = styles_[s].concentration;
      const bool alike = styles_[s].alike;
      likelihood_[e][s] = era.appeal[c] * (era.wanted[t] + k * newness_[alike][t]) /
                          (sum.wanted + k * sum.newness[alike]);
      p += era.posterior * style_[s] * likelihood_[e][s];
    }
  }
  return p;
}

void Habit::Learn(int task, const std::vector<int>& present, double habit, double other) {
  const auto t = Index(task), c = Index(tasks_.category(task));
  const double p = std::inner_product(
      eras_.begin(), eras_.end(), likelihood_.begin(), 0.0, std::plus<>(),
      [&](const Era& era, const auto& l) {
        return era.posterior * std::inner_product(l.begin(), l.end(), style_.begin(), 0.0);
      });
  const double evidence = habit * p + other;
  const double weight = habit * p / evidence;  // P(it was habit): only this much is learnt

  std::array<double, kStyles> style{};
  for (size_t e = 0; e < kEras; ++e) {
    Era& era = eras_[e];
    double mean = 0;
    for (size_t s = 0; s < kStyles; ++s) {
      mean += style_[s] * likelihood_[e][s];
      style[s] += era.posterior * likelihood_[e][s];
    }
    era.posterior *= (habit * mean + other) / evidence;
    era.wanted[t] += weight;
    era.category_wanted[c] += weight;
    const double seen =
        weight / (strengths_[e].wanted + kConcentrations[1] * strengths_[e].newness[0]);
    for (size_t i = 0; i < present.size(); ++i) {
      if (present[i] == 0) continue;
      era.exposure[i] += seen;
      era.appeal[i] = 1 / (kExposure + era.exposure[i]);
    }
  }
  for (size_t s = 0; s < kStyles; ++s) {
    style_[s] = (1 - kStyleShare) * style_[s] * (habit * style[s] + other) / evidence +
                kStyleShare * styles_[s].prior;
  }
  for (double& x : categories_wanted_) x *= kForgetting;
  for (double& x : actions_wanted_) x *= kForgetting;
  categories_wanted_[c] += weight;
  actions_wanted_[Index(tasks_.action(task))] += weight;
  UpdateNewness();
  Change(*std::min_element(eras_.begin(), eras_.end(),
                           [](const Era& a, const Era& b) { return a.posterior < b.posterior; }));
}

/// The least credible era makes room for one that begins now.
void Habit::Change(Era& newest) {
  const double rest = 1 - newest.posterior;
  for (Era& era : eras_) era.posterior *= (1 - kChange) / rest;
  Clear(newest);
  newest.posterior = kChange;
}

void Habit::UpdateNewness() {
  double sum = 0;
  for (int c = 0; c < tasks_.categories(); ++c) {
    double& category = category_newness_[1][Index(c)];
    category = 0;
    for (int t = tasks_.first(c); t < tasks_.first(c + 1); ++t) {
      double& task = newness_[1][Index(t)];
      task = (categories_wanted_[Index(c)] + kPseudoCount) *
             (actions_wanted_[Index(tasks_.action(t))] + kPseudoCount);
      category += task;
    }
    sum += category;
  }
  for (double& x : newness_[1]) x /= sum;
  for (double& x : category_newness_[1]) x /= sum;
}

}  // namespace beckon::intention
