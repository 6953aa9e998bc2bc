#include "services/intention/core/error_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace beckon::intention {
namespace {

constexpr double kWorstRate = 0.45;
/// Of an announced rate that is smaller than this share of the other one: nothing is impossible.
constexpr double kLeastShare = 0.05;
/// Least P(a certain wrong answer) of an announced confusion, likewise.
constexpr double kLeastConfusion = 0.001;
/// P(the device or its user is not what the past says).
constexpr double kReplaced = 0.02;
/// P(an answer is taken back | it was what was meant) / P(.. | it was a slip).
constexpr double kNeedlessUndo = 0.1;

/// A level: rates, or factors of the announced ones.
struct Level {
  double yes, no, weight;
};

/// Answers at random, always yes, always no.
constexpr std::array<Level, 3> kMeaningless = {{{0.5, 0.5, 0.002}, {1, 0, 0.001}, {0, 1, 0.001}}};
constexpr int kMeaningful = ErrorModel::kLevels - static_cast<int>(kMeaningless.size());
using Levels = std::array<Level, kMeaningful>;

void Fill(ErrorModel& model, int level, ErrorRates rates, double weight) {
  model.rates[level] = rates;
  model.weights[level] = weight;
}

void FillMeaningless(ErrorModel& model) {
  for (int i = kMeaningful; i < ErrorModel::kLevels; ++i) {
    const Level& level = kMeaningless[i - kMeaningful];
    Fill(model, i, {level.yes, level.no}, level.weight);
  }
}

void Normalise(std::array<double, ErrorModel::kLevels>& weights) {
  double sum = 0;
  for (const double weight : weights) sum += weight;
  for (double& weight : weights) weight /= sum;
}

double LogOf(double probability) { return std::log(std::max(probability, 1e-300)); }

/// log P(right and wrong answers), where a share `error` of them is wrong.
double Term(double right, double wrong, double error) {
  return (right > 0 ? right * LogOf(1 - error) : 0) + (wrong > 0 ? wrong * LogOf(error) : 0);
}

/// What is left of a share `wrong` of wrong answers where the answer itself doubts by `doubt`: a
/// decoder's soft answer says of itself how often it is wrong, a press does not.
double Beyond(double wrong, double doubt) {
  return wrong <= doubt ? 0 : (wrong - doubt) / (wrong * (1 - doubt));
}

/// Mean P(a wrong answer) of a confusion.
double MeanError(const std::vector<std::vector<float>>& confusion) {
  double right = 0;
  for (size_t i = 0; i < confusion.size(); ++i) right += confusion[i][i];
  return 1 - right / static_cast<double>(confusion.size());
}

}  // namespace

ErrorModel ErrorModel::Exact(ErrorRates rates) {
  ErrorModel model;
  model.rates.fill(rates);
  model.weights = Unknown().weights;  // for answers of another device that errs
  return model;
}

ErrorModel ErrorModel::Unknown() {
  constexpr Levels kRates = {{{0.005, 0.005, 0.2},
                              {0.02, 0.02, 0.2},
                              {0.05, 0.05, 0.25},
                              {0.1, 0.1, 0.15},
                              {0.2, 0.2, 0.1},
                              {0.3, 0.3, 0.1},
                              {0.01, 0.1, 0.02},
                              {0.03, 0.3, 0.02},
                              {0.1, 0.01, 0.02},
                              {0.3, 0.03, 0.02}}};
  ErrorModel model;
  for (int i = 0; i < kMeaningful; ++i)
    Fill(model, i, {kRates[i].yes, kRates[i].no}, kRates[i].weight);
  FillMeaningless(model);
  Normalise(model.weights);
  return model;
}

ErrorModel ErrorModel::Announced(ErrorRates rates,
                                 const std::vector<std::vector<float>>& confusion) {
  const bool confuses = !confusion.empty() && MeanError(confusion) > 0;
  if (rates.false_yes <= 0 && rates.false_no <= 0 && !confuses) return Exact({});
  constexpr Levels kFactors = {{{0.125, 0.125, 0.05},
                                {0.35, 0.35, 0.15},
                                {0.7, 0.7, 0.25},
                                {1, 1, 0.35},
                                {2, 2, 0.15},
                                {4, 4, 0.05},
                                {1, 4, 0.02},
                                {4, 1, 0.02},
                                {0.35, 2, 0.02},
                                {2, 0.35, 0.02}}};
  ErrorModel model;
  if (rates.false_yes <= 0 && rates.false_no <= 0)
    rates.false_yes = rates.false_no = MeanError(confusion) / 2;
  rates = {std::max(rates.false_yes, kLeastShare * rates.false_no),
           std::max(rates.false_no, kLeastShare * rates.false_yes)};
  for (int i = 0; i < kMeaningful; ++i) {
    const auto& [yes, no, weight] = kFactors[i];
    Fill(model, i,
         {std::min(rates.false_yes * yes, kWorstRate), std::min(rates.false_no * no, kWorstRate)},
         weight);
    model.scale[i] = (yes + no) / 2;
  }
  FillMeaningless(model);
  Normalise(model.weights);
  model.confusion = confusion;
  return model;
}

double ErrorModel::Probability(int level, int answers, int meant, int said) const {
  const ErrorRates& r = rates[level];
  if (answers == 2) {
    const double error = meant == 0 ? r.false_no : r.false_yes;
    return meant == said ? 1 - error : error;
  }
  if (!Means(level)) return 1.0 / answers;
  const int others = answers - 1;
  if (static_cast<int>(confusion.size()) == answers) {
    const auto& row = confusion[static_cast<size_t>(meant)];
    const double claimed = 1 - row[static_cast<size_t>(meant)] + kLeastConfusion * others;
    const double error = std::min(claimed * scale[level], std::max(claimed, kWorstRate));
    if (meant == said) return std::max(0.0, 1 - error);
    return std::min(error, 1.0) * (row[static_cast<size_t>(said)] + kLeastConfusion) / claimed;
  }
  const double error = (r.false_yes + r.false_no) / 2;
  return meant == said ? 1 - error : error / others;
}

Status CheckLikelihoods(const std::vector<double>& likelihoods, size_t answers) {
  if (likelihoods.size() != answers) {
    return Error{"expected " + std::to_string(answers) + " likelihoods, one an option, found " +
                 std::to_string(likelihoods.size())};
  }
  for (const double likelihood : likelihoods) {
    if (!std::isfinite(likelihood) || likelihood < 0) {
      return Error{"expected likelihoods of 0 or more, found " + std::to_string(likelihood)};
    }
  }
  if (std::none_of(likelihoods.begin(), likelihoods.end(), [](double l) { return l > 0; }))
    return Error{"expected a positive likelihood, found only zeros"};
  return {};
}

int SaidAnswer(const std::vector<double>& likelihoods) {
  const auto most = std::max_element(likelihoods.begin(), likelihoods.end());
  const bool tied = std::count(likelihoods.begin(), likelihoods.end(), *most) > 1;
  return static_cast<int>((tied ? likelihoods.end() - 1 : most) - likelihoods.begin());
}

Evidence ErrorModel::Hear(const std::vector<double>& likelihoods) const {
  const int answers = static_cast<int>(likelihoods.size());
  const double most = *std::max_element(likelihoods.begin(), likelihoods.end());
  const double doubt = 1 - most / std::accumulate(likelihoods.begin(), likelihoods.end(), 0.0);
  Evidence evidence;
  evidence.said = SaidAnswer(likelihoods);
  evidence.likelihood.resize(likelihoods.size());
  for (int meant = 0; meant < answers; ++meant) {
    for (int level = 0; level < kLevels; ++level) {
      const double wrong = 1 - Probability(level, answers, meant, meant);
      const double beyond = Means(level) ? Beyond(wrong, doubt) : 1;
      double sum = likelihoods[meant] / most * (1 - wrong * beyond);
      for (int said = 0; said < answers; ++said) {
        if (said == meant) continue;
        sum += likelihoods[said] / most * beyond * Probability(level, answers, meant, said);
      }
      evidence.likelihood[meant][level] = sum;
    }
  }
  return evidence;
}

Evidence TakenBack(const Evidence& heard) {
  Evidence evidence;
  evidence.said = Evidence::kNothing;
  const double others = static_cast<double>(heard.likelihood.size()) - 1;
  std::array<double, ErrorModel::kLevels> undone{};
  for (int level = 0; level < ErrorModel::kLevels; ++level) {
    for (int meant = 0; meant <= static_cast<int>(others); ++meant) {
      const double p = heard.likelihood[static_cast<size_t>(meant)][level];
      undone[level] += meant == heard.said ? kNeedlessUndo * p : p / others;
    }
  }
  evidence.likelihood.assign(heard.likelihood.size(), undone);
  return evidence;
}

bool ErrorModel::noisy() const {
  return std::any_of(rates.begin(), rates.end(),
                     [](const ErrorRates& r) { return r.false_yes > 0 || r.false_no > 0; });
}

ErrorModel ErrorModel::Learnt(const AnswerCounts& counts) const {
  if (!noisy()) return *this;
  const double claimed = confusion.empty() ? 0 : MeanError(confusion);
  std::array<double, kLevels> log_weights{};
  for (int i = 0; i < kLevels; ++i) {
    const auto& [false_yes, false_no] = rates[i];
    const double wrong = confusion.empty() || !Means(i) ? (false_yes + false_no) / 2
                                                        : std::min(claimed * scale[i], kWorstRate);
    log_weights[i] = LogOf(weights[i]) +
                     Term(counts.meant_yes_said_yes, counts.meant_yes_said_no, false_no) +
                     Term(counts.meant_no_said_no, counts.meant_no_said_yes, false_yes) +
                     Term(counts.chose_right, counts.chose_wrong, wrong);
  }
  const double most = *std::max_element(log_weights.begin(), log_weights.end());
  ErrorModel learnt = *this;
  for (int i = 0; i < kLevels; ++i) learnt.weights[i] = std::exp(log_weights[i] - most);
  Normalise(learnt.weights);
  for (int i = 0; i < kLevels; ++i)
    learnt.weights[i] += kReplaced * (weights[i] - learnt.weights[i]);
  return learnt;
}

}  // namespace beckon::intention
