// How a front end's answers may be wrong, and what a user's past answers say about it.
#pragma once

#include <array>

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
};

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

  /// Whether any level can be wrong.
  bool noisy() const;
  /// The model after seeing `counts`.
  ErrorModel Learnt(const AnswerCounts& counts) const;
};

/// An answer to a yes/no question: how likely what was received is under each option. A press is
/// one-hot.
struct Evidence {
  double yes = 0;
  double no = 0;
  std::array<ErrorRates, ErrorModel::kLevels> rates{};  // of the device that heard it

  bool said_yes() const { return yes > no; }
  /// P(received | yes or no meant) at a level of noise, up to scale.
  double Likelihood(bool meant_yes, int level) const {
    const ErrorRates& r = rates[level];
    return meant_yes ? yes * (1 - r.false_no) + no * r.false_no
                     : yes * r.false_yes + no * (1 - r.false_yes);
  }
};

}  // namespace beckon::intention
