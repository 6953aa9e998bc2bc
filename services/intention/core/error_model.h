// How a front end's answers may be wrong, and what a user's past answers say about it.
#pragma once

#include <array>
#include <vector>

namespace beckon::intention {

/// Rates of wrong answers. Zero means that it cannot happen.
struct ErrorRates {
  double false_yes = 0;  // P(yes received | no meant), 0..0.5
  double false_no = 0;   // P(no received | yes meant), 0..0.5
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
/// what the user wants: answers that contradict each other speak for a noisy level.
struct ErrorModel {
  static constexpr int kLevels = 6;

  std::array<ErrorRates, kLevels> rates{};
  std::array<double, kLevels> weights{};  // sum 1

  /// Certain of its rates; zeros: answers are never wrong.
  static ErrorModel Exact(ErrorRates rates);
  /// Nothing is known: rates from 0.5 % to 30 %, small ones more probable.
  static ErrorModel Unknown();
  /// What an interface claims: up to eight times better and four times worse is considered.
  static ErrorModel Announced(ErrorRates rates);

  /// P(answer `said` received | answer `meant`) of a question with `answers` answers at a level.
  /// Two answers are yes (0) and no (1); among more a wrong one is any of the others.
  double Probability(int level, int answers, int meant, int said) const;
  /// What was received, as evidence. `likelihoods`: one an answer of the question, >= 0, finite.
  Evidence Hear(const std::vector<double>& likelihoods) const;
  /// Whether any level can be wrong.
  bool noisy() const;
  /// The model after seeing `counts`.
  ErrorModel Learnt(const AnswerCounts& counts) const;
};

/// Index of the likeliest answer; the last one, "none", where it is not a single one.
int SaidAnswer(const std::vector<double>& likelihoods);

/// An answer: how likely what was received is, by what was meant and by level of noise.
struct Evidence {
  int said = 0;  // SaidAnswer of what was received
  std::vector<std::array<double, ErrorModel::kLevels>> likelihood;  // by answer meant, up to scale
};

}  // namespace beckon::intention
