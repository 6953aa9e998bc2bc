#include "services/intention/core/question_cost.h"

#include <algorithm>
#include <cmath>

namespace beckon::intention {
namespace {

double PLogP(double p) { return p > 0 ? p * std::log2(p) : 0; }

/// The rates as one: a wrong answer is any of the others.
double MeanError(int answers, const ErrorRates& rates) {
  const double most = 0.9 * (answers - 1) / answers;  // at (answers - 1) / answers it tells nothing
  return std::clamp((rates.false_yes + rates.false_no) / 2, 0.0, most);
}

/// Of a question whose answers are equally likely.
double MeanSeconds(const Interface& interface, int answers) {
  return (interface.Seconds(answers, 0) + interface.Seconds(answers, answers - 1)) / 2;
}

AnswerWeight WeightOf(const ErrorModel& errors, int answers, int said) {
  const double meant = errors.Probability(0, answers, said, said);
  const double other = errors.Probability(0, answers, said == 0 ? 1 : 0, said);
  return {meant, other, PLogP(meant), PLogP(other)};
}

}  // namespace

Mass Mass::Of(double p) { return {p, PLogP(p)}; }

double Capacity(int answers, const ErrorRates& rates) {
  const double error = MeanError(answers, rates);
  return std::log2(answers) + PLogP(1 - error) + PLogP(error) -
         error * std::log2(static_cast<double>(answers - 1));
}

QuestionCost::QuestionCost(const Interface& interface, const ErrorRates& rates,
                           double accept_posterior)
    : interface_(interface),
      accept_posterior_(accept_posterior),
      seconds_(MeanSeconds(interface, 2)),
      capacity_(Capacity(2, rates)),
      confirming_(interface.Seconds(2, 0)) {
  const ErrorModel errors = ErrorModel::Exact(rates);
  yes_ = WeightOf(errors, 2, 0);
  no_ = WeightOf(errors, 2, 1);
  for (int answers = 3; interface.Choices() && answers <= interface.max_options; ++answers) {
    choices_.push_back(WeightOf(errors, answers, 0));
    const double seconds = MeanSeconds(interface, answers), bits = Capacity(answers, rates);
    if (bits / seconds <= capacity_ / seconds_) continue;
    seconds_ = seconds;
    capacity_ = bits;
  }
}

double QuestionCost::Remaining(double entropy_bits) const {
  const double questions = entropy_bits / capacity_;
  const double done = std::exp(-1.6 * questions);
  return seconds_ * (questions + 0.05 * (1 - done)) + confirming_ * done;
}

bool QuestionCost::Ends(const AnswerWeight& weight, double p, double total) const {
  return weight.meant * p >=
         accept_posterior_ * (weight.meant * p + weight.other * std::max(0.0, total - p));
}

double QuestionCost::Left(const Mass& total, const Mass& in, const AnswerWeight& weight,
                          bool accepts, double seconds) const {
  const Mass out = total - in;
  const double z = weight.meant * in.p + weight.other * out.p;
  if (z <= 0) return 0;
  if (accepts && Ends(weight, in.p, total.p)) return z * seconds;
  // Of q log2 q with q = meant p inside, other p outside.
  const double sum = weight.meant * in.p_log_p + in.p * weight.meant_log_meant +
                     weight.other * out.p_log_p + out.p * weight.other_log_other;
  return z * (seconds + Remaining(std::max(0.0, std::log2(z) - sum / z)));
}

double QuestionCost::Of(const Mass& total, std::span<const Option> options) const {
  const int none = static_cast<int>(options.size()), answers = none + 1;
  Mass left = total;
  double cost = 0;
  for (int i = 0; i < none; ++i) {
    left = left - options[i].mass;
    cost += Left(total, options[i].mass, Weigh(answers, i), options[i].accepts,
                 interface_.Seconds(answers, i));
  }
  return cost + Left(total, left, Weigh(answers, none), false, interface_.Seconds(answers, none));
}

}  // namespace beckon::intention
