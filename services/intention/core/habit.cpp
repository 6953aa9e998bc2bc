#include "services/intention/core/habit.h"

#include <algorithm>

namespace beckon::intention {
namespace {

/// P(the preferences change after a session).
constexpr double kChange = 0.01;
/// Of the sparse Dirichlet priors: a user wants few different things, or many.
constexpr std::array<double, 2> kConcentrations = {2, 16};
/// P(new wants resemble the known ones), at first.
constexpr double kAlike = 0.3;
/// Known wants are as strong as they were frequent, or about equally strong; P(the latter).
constexpr double kEvenness = 10;
constexpr double kEven = 0.3;
/// Share of the styles' prior that comes back each session (fixed share, Herbster & Warmuth 1998).
constexpr double kStyleShare = 0.01;
/// Prior exposure of a category, in sessions.
constexpr double kExposure = 4;
/// Where new wants resemble known ones: pseudo-counts of a category and an action, and what a count
/// weighs a session later. An object is more telling than an action.
constexpr double kCategoryPseudoCount = 0.1;
constexpr double kActionPseudoCount = 1;
constexpr double kForgetting = 0.98;

size_t Index(int i) { return static_cast<size_t>(i); }

}  // namespace

std::array<Habit::Style, Habit::kStyles> Habit::MakeStyles() {
  std::array<Style, kStyles> styles;
  size_t i = 0;
  for (const double concentration : kConcentrations) {
    for (const size_t alike : {0, 1}) {
      for (const bool even : {false, true}) {
        styles[i++] = {concentration, alike, even,
                       (alike == 1 ? kAlike : 1 - kAlike) * (even ? kEven : 1 - kEven) /
                           kConcentrations.size()};
      }
    }
  }
  return styles;
}

Habit::Habit(const Tasks& tasks) : tasks_(tasks) {
  for (size_t s = 0; s < kStyles; ++s) style_[s] = styles_[s].prior;
  for (Era& era : eras_) Clear(era);
  eras_[0].posterior = 1;
  even_newness_ = 1.0 / std::max(1, tasks.count());
  category_newness_.fill(std::vector<double>(Index(tasks.categories()), 0));
  for (int c = 0; c < tasks.categories(); ++c) {
    category_newness_[0][Index(c)] = even_newness_ * (tasks.first(c + 1) - tasks.first(c));
  }
  categories_wanted_.assign(Index(tasks.categories()), 0);
  actions_wanted_.assign(Index(tasks.actions()), 0);
  UpdateNewness();
}

void Habit::Clear(Era& era) const {
  const size_t categories = Index(tasks_.categories());
  era.posterior = era.sessions = era.known = era.spread = 0;
  era.wanted.assign(Index(tasks_.count()), 0);
  era.category_wanted.assign(categories, 0);
  era.category_known.assign(categories, 0);
  era.exposure.assign(categories, 0);
  era.appeal.assign(categories, 1 / kExposure);
}

Habit::Sums Habit::Add(const Era& era, const std::vector<double>& there) const {
  Sums sums;
  for (size_t c = 0; c < there.size(); ++c) {
    const double appeal = there[c] * era.appeal[c];
    sums.wanted += appeal * era.category_wanted[c];
    sums.known += appeal * era.category_known[c];
    sums.newness[0] += appeal * category_newness_[0][c];
    sums.newness[1] += appeal * category_newness_[1][c];
  }
  return sums;
}

/// Evenness moves strength among the known tasks and gives them no more together.
double Habit::Total(const Era& era, const Style& style, const Sums& sums) {
  const double known =
      style.even ? era.spread * (sums.wanted + kEvenness * sums.known) : sums.wanted;
  return known + style.concentration * sums.newness[style.alike];
}

std::vector<double> Habit::Predict(const std::vector<double>& there) const {
  std::vector<double> p(Index(tasks_.count()), 0);
  for (const Era& era : eras_) {
    const Sums sums = Add(era, there);
    Sums worth;  // of a unit of each kind of strength
    for (size_t s = 0; s < kStyles; ++s) {
      const Style& style = styles_[s];
      const double unit = era.posterior * style_[s] / Total(era, style, sums);
      worth.wanted += style.even ? unit * era.spread : unit;
      worth.known += style.even ? unit * era.spread * kEvenness : 0;
      worth.newness[style.alike] += unit * style.concentration;
    }
    for (int t = 0; t < tasks_.count(); ++t) {
      const auto c = Index(tasks_.category(t));
      const std::array<double, 2> newness = Newness(t);
      const double wanted = era.wanted[Index(t)];
      p[Index(t)] += there[c] * era.appeal[c] *
                     (worth.wanted * wanted + worth.known * std::min(1.0, wanted) +
                      worth.newness[0] * newness[0] + worth.newness[1] * newness[1]);
    }
  }
  return p;
}

double Habit::Probability(int task, const std::vector<double>& there) {
  const auto t = Index(task), c = Index(tasks_.category(task));
  const std::array<double, 2> newness = Newness(task);
  double p = 0;
  for (size_t e = 0; e < kEras; ++e) {
    const Era& era = eras_[e];
    sums_[e] = Add(era, there);
    Sums own;
    own.wanted = era.appeal[c] * era.wanted[t];
    own.known = era.appeal[c] * std::min(1.0, era.wanted[t]);
    own.newness = {era.appeal[c] * newness[0], era.appeal[c] * newness[1]};
    for (size_t s = 0; s < kStyles; ++s) {
      likelihood_[e][s] = Total(era, styles_[s], own) / Total(era, styles_[s], sums_[e]);
      p += era.posterior * style_[s] * likelihood_[e][s];
    }
  }
  return p;
}

void Habit::Learn(int task, const std::vector<double>& there, double habit, double other) {
  std::array<double, kStyles> by_style{};
  std::array<double, kEras> by_era{};
  double p = 0;
  for (size_t e = 0; e < kEras; ++e) {
    for (size_t s = 0; s < kStyles; ++s) {
      by_era[e] += style_[s] * likelihood_[e][s];
      by_style[s] += eras_[e].posterior * likelihood_[e][s];
    }
    p += eras_[e].posterior * by_era[e];
  }
  const double evidence = habit * p + other;
  const double weight = habit * p / evidence;
  for (size_t s = 0; s < kStyles; ++s) {
    style_[s] *= (1 - kStyleShare) * (habit * by_style[s] + other) / evidence;
    style_[s] += kStyleShare * styles_[s].prior;
  }
  for (size_t e = 0; e < kEras; ++e) {
    Era& era = eras_[e];
    era.posterior *= (habit * by_era[e] + other) / evidence;
    // Posterior mean of the exponential variable that stands for a choice (Caron & Doucet).
    const double exposure = weight / (sums_[e].wanted + kExposure * sums_[e].newness[0]);
    for (size_t c = 0; c < there.size(); ++c) {
      era.exposure[c] += exposure * there[c];
      era.appeal[c] = 1 / (kExposure + era.exposure[c]);
    }
    const auto t = Index(task), c = Index(tasks_.category(task));
    const double known = std::min(1.0, era.wanted[t] + weight) - std::min(1.0, era.wanted[t]);
    era.wanted[t] += weight;
    era.category_wanted[c] += weight;
    era.category_known[c] += known;
    era.sessions += weight;
    era.known += known;
    era.spread = era.sessions / (era.sessions + kEvenness * era.known);
  }
  for (double& x : categories_wanted_) x *= kForgetting;
  for (double& x : actions_wanted_) x *= kForgetting;
  categories_wanted_[Index(tasks_.category(task))] += weight;
  actions_wanted_[Index(tasks_.action(task))] += weight;
  UpdateNewness();
  BeginEra();
}

/// The least credible era makes room for one that begins now.
void Habit::BeginEra() {
  Era& newest = *std::min_element(eras_.begin(), eras_.end(), [](const Era& a, const Era& b) {
    return a.posterior < b.posterior;
  });
  const double rest = 1 - newest.posterior;
  for (Era& era : eras_) era.posterior *= (1 - kChange) / rest;
  Clear(newest);
  newest.posterior = kChange;
}

std::array<double, 2> Habit::Newness(int task) const {
  return {even_newness_,
          alike_newness_ *
              (categories_wanted_[Index(tasks_.category(task))] + kCategoryPseudoCount) *
              (actions_wanted_[Index(tasks_.action(task))] + kActionPseudoCount)};
}

void Habit::UpdateNewness() {
  double sum = 0;
  for (int c = 0; c < tasks_.categories(); ++c) {
    double actions = 0;
    for (int t = tasks_.first(c); t < tasks_.first(c + 1); ++t) {
      actions += actions_wanted_[Index(tasks_.action(t))] + kActionPseudoCount;
    }
    double& category = category_newness_[1][Index(c)];
    category = (categories_wanted_[Index(c)] + kCategoryPseudoCount) * actions;
    sum += category;
  }
  alike_newness_ = 1 / sum;
  for (double& x : category_newness_[1]) x *= alike_newness_;
}

}  // namespace beckon::intention
