// What a question costs at an interface: its own seconds, and those that its answers leave to be
// expected.
#pragma once

#include <span>
#include <vector>

#include "services/intention/core/interface.h"

namespace beckon::intention {

/// Sums over a set of candidates from which entropies follow without another pass.
struct Mass {
  double p = 0;        // sum of p
  double p_log_p = 0;  // sum of p log2 p

  static Mass Of(double p);
  Mass operator+(const Mass& o) const { return {p + o.p, p_log_p + o.p_log_p}; }
  Mass operator-(const Mass& o) const { return {p > o.p ? p - o.p : 0, p_log_p - o.p_log_p}; }
  Mass& operator+=(const Mass& o) { return *this = *this + o; }
};

/// Bits that a question with `answers` answers tells at most, at these rates of wrong answers.
double Capacity(int answers, const ErrorRates& rates);

/// How an answer weighs the candidates: by how likely it was received.
struct AnswerWeight {
  double meant = 1;  // from those who meant it
  double other = 0;  // from those who meant another answer
  double meant_log_meant = 0;
  double other_log_other = 0;
};

/// At an interface whose answers are wrong at known rates. Costs are weighed by the probability of
/// the candidates, which need not sum to 1.
class QuestionCost {
 public:
  struct Option {
    Mass mass;             // of the candidates that it holds for
    bool accepts = false;  // one pair: saying so may end the session
  };

  QuestionCost(const Interface& interface, const ErrorRates& rates, double accept_posterior);

  /// Expected seconds until an accepted full query where the posterior has this entropy:
  ///     L(H) = S (h + 0.05 (1 - e^(-1.6 h))) + S_1 e^(-1.6 h),   h = H / C.
  /// h is the number of questions that tell H bits, S the seconds and C the capacity of the
  /// questions that tell most a second; S_1 the seconds of the confirming question.
  double Remaining(double entropy_bits) const;
  /// Of a question with these options, which are disjoint, where `total` is the mass of all.
  double Of(const Mass& total, std::span<const Option> options) const;
  /// How an answer of such a question weighs the candidates.
  const AnswerWeight& Weigh(int answers, int said) const {
    return answers > 2 ? choices_[static_cast<size_t>(answers) - 3] : said == 0 ? yes_ : no_;
  }
  /// Whether a yes or a press for a pair of `p` of `total` ends the session.
  bool Ends(const AnswerWeight& weight, double p, double total) const;

  const Interface& interface() const { return interface_; }
  /// S.
  double seconds() const { return seconds_; }

 private:
  double Left(const Mass& total, const Mass& in, const AnswerWeight& weight, bool accepts,
              double seconds) const;

  const Interface& interface_;
  const double accept_posterior_;
  AnswerWeight yes_, no_;
  std::vector<AnswerWeight> choices_;  // of any answer, by number of answers from 3 on
  double seconds_ = 1;
  double capacity_ = 1;
  double confirming_ = 1;
};

}  // namespace beckon::intention
