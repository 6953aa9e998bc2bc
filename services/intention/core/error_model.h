// How a front end's answers may be wrong, and what a user's past answers say about it.
#pragma once

#include <array>
#include <vector>

#include "services/base/result.h"

namespace beckon::intention {

/// Rates of wrong answers. Zero means that it cannot happen.
struct ErrorRates {
  double false_yes = 0;  // P(yes received | no meant), 0..1
  double false_no = 0;   // P(no received | yes meant), 0..1
};

/// Answers of the past whose meaning is known, because the session was confirmed.
struct AnswerCounts {
  double meant_yes_said_yes = 0;
  double meant_yes_said_no = 0;
  double meant_no_said_yes = 0;
  double meant_no_said_no = 0;
  double chose_right = 0;  // of choices with more than two answers
  double chose_wrong = 0;
};

struct Evidence;

/// A distribution over a few levels of noise. Within a session the level is inferred together with
/// what the user wants: answers that contradict each other speak for a noisy level. Besides levels
/// at which answers are wrong alike or one way more than the other, there are three at which they
/// mean nothing: answers at random, always yes, always no (a stuck switch).
struct ErrorModel {
  static constexpr int kLevels = 13;

  std::array<ErrorRates, kLevels> rates{};
  std::array<double, kLevels> weights{};  // sum 1
  // Announced confusion of k > 2 answers, P(said | meant), rows sum to 1; empty: wrong answers are
  // equally likely. A level multiplies what it says of wrong answers.
  std::vector<std::vector<float>> confusion;
  std::array<double, kLevels> scale{};

  /// Certain of its rates; zeros: answers are never wrong.
  static ErrorModel Exact(ErrorRates rates);
  /// Nothing is known: rates from 0.5 % to 30 %, small ones more probable.
  static ErrorModel Unknown();
  /// What an interface claims: up to eight times better and four times worse is considered, and
  /// one rate four times worse than the other. `confusion`: square with rows that sum to 1, or
  /// empty.
  static ErrorModel Announced(ErrorRates rates,
                              const std::vector<std::vector<float>>& confusion = {});

  /// P(answer `said` received | answer `meant`) of a question with `answers` answers at a level.
  /// Two answers are yes (0) and no (1); among more a wrong one is as `confusion` says, or any.
  double Probability(int level, int answers, int meant, int said) const;
  /// What was received, as evidence. `likelihoods`: one an answer of the question, as
  /// CheckLikelihoods wants them.
  Evidence Hear(const std::vector<double>& likelihoods) const;
  /// Whether any level can be wrong.
  bool noisy() const;
  /// Whether answers at a level say anything about what was meant.
  bool Means(int level) const { return rates[level].false_yes + rates[level].false_no < 1; }
  /// The model after seeing `counts`. A little of what was believed before stays: a device is
  /// replaced, a user tires.
  ErrorModel Learnt(const AnswerCounts& counts) const;
};

/// Fails unless there are `answers` of them, none negative, infinite or not a number, and one is
/// positive.
Status CheckLikelihoods(const std::vector<double>& likelihoods, size_t answers);

/// Index of the likeliest answer; the last one, "none", where it is not a single one. Not of an
/// empty list.
int SaidAnswer(const std::vector<double>& likelihoods);

/// An answer: how likely what was received is, by what was meant and by level of noise.
struct Evidence {
  static constexpr int kNothing = -1;

  int said = 0;  // SaidAnswer of what was received; kNothing: it was taken back
  std::vector<std::array<double, ErrorModel::kLevels>> likelihood;  // by answer meant, up to scale
};

/// What an answer says that the user took back: nothing about what is wanted, but that it was
/// probably a slip, which speaks for a noisy level.
Evidence TakenBack(const Evidence& heard);

}  // namespace beckon::intention
