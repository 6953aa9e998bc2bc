#include "services/intention/core/lookahead.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

namespace beckon::intention {
namespace {

/// Sums over a set of candidates from which entropies follow without another pass.
struct Mass {
  double p = 0;        // sum of p
  double p_log_p = 0;  // sum of p log2 p

  Mass operator+(const Mass& o) const { return {p + o.p, p_log_p + o.p_log_p}; }
  Mass operator-(const Mass& o) const { return {std::max(0.0, p - o.p), p_log_p - o.p_log_p}; }
  Mass& operator+=(const Mass& o) { return *this = *this + o; }
};

Mass MassOf(double p) { return {p, p > 0 ? p * std::log2(p) : 0}; }

/// Entropy of the mixture that weighs `in` by a and `out` by b, normalised.
double MixtureEntropy(const Mass& in, double a, const Mass& out, double b) {
  const double z = a * in.p + b * out.p;
  if (z <= 0) return 0;
  double sum = 0;  // of q log2 q with q = a p or b p
  if (a > 0) sum += a * (in.p_log_p + in.p * std::log2(a));
  if (b > 0) sum += b * (out.p_log_p + out.p * std::log2(b));
  return std::max(0.0, std::log2(z) - sum / z);
}

class Lookahead {
 public:
  Lookahead(const Situation& situation, const std::vector<double>& posterior,
            const ErrorRates& rates, double accept_posterior)
      : situation_(situation),
        posterior_(posterior),
        rates_(rates),
        capacity_(Capacity(rates)),
        accept_posterior_(accept_posterior) {
    for (int i = 0; i < situation.pair_count(); ++i) {
      const Mass mass = MassOf(posterior[i]);
      pairs_ += mass;
      by_action_[situation.pairs[i].action] += mass;
      by_object_[situation.pairs[i].object] += mass;
    }
    total_ = pairs_ + MassOf(std::max(0.0, 1 - pairs_.p));
    if (1 - pairs_.p < 1e-12) total_ = pairs_;
  }

  std::optional<Choice> Best(QueryFamilies families) {
    if (pairs_.p <= 0) return std::nullopt;
    ConsiderPairs();
    for (int action = 0; action < kMaxActions; ++action)
      Consider(AskAction(action), by_action_[action]);
    for (int object = 0; object < object_count(); ++object)
      Consider(AskObject(object), by_object_[object]);
    if (families == QueryFamilies::kAll) {
      ConsiderCategories();
      ConsiderPairsOfActions();
      ConsiderPrefixes([](const Instance& o) { return o.distance_m; });
      if (situation_.has_lateral) ConsiderPrefixes([](const Instance& o) { return o.lateral_m; });
    }
    return best_;
  }

 private:
  int object_count() const { return static_cast<int>(situation_.objects.size()); }

  /// Expected answers with a question whose yes-set has mass `in`; `accepts`: a yes ends the
  /// session.
  double Cost(const Mass& in, bool accepts) const {
    const Mass out = total_ - in;
    const double yes_in = 1 - rates_.false_no, yes_out = rates_.false_yes;
    const double p_yes = yes_in * in.p + yes_out * out.p;
    const double p_no = std::max(0.0, total_.p - p_yes);
    double cost = 1;
    if (!accepts)
      cost += p_yes * RemainingQuestions(MixtureEntropy(in, yes_in, out, yes_out), capacity_);
    return cost +
           p_no * RemainingQuestions(MixtureEntropy(in, 1 - yes_in, out, 1 - yes_out), capacity_);
  }

  void Offer(const Question& question, double cost) {
    if (!best_ || cost < best_->expected_questions - 1e-12) best_ = Choice{question, cost};
  }

  void ConsiderPairs() {
    for (int i = 0; i < situation_.pair_count(); ++i) {
      if (posterior_[i] <= 0) continue;
      const double p = posterior_[i];
      const double yes = (1 - rates_.false_no) * p;
      const bool accepts = yes >= accept_posterior_ * (yes + rates_.false_yes * (total_.p - p));
      Offer(AskPair(situation_, i), Cost(MassOf(p), accepts));
    }
  }

  /// A question that everybody answers alike tells nothing.
  void Consider(const Question& question, const Mass& in) {
    if (in.p <= 1e-12 || in.p >= total_.p - 1e-12) return;
    Offer(question, Cost(in, false));
  }

  void ConsiderCategories() {
    uint64_t done = 0;
    for (int i = 0; i < object_count(); ++i) {
      const int category = situation_.objects[i].category;
      if (category < 0 || (done >> i & 1) != 0) continue;
      const uint64_t mask = situation_.MaskOf(category);
      done |= mask;
      if (std::popcount(mask) > 1)
        Consider(AskYesNo(QuestionKind::kCategory, {kAny, mask, -1}), MassOfObjects(mask));
    }
  }

  /// "Grasp or move something?"
  void ConsiderPairsOfActions() {
    for (int a = 0; a < kMaxActions; ++a) {
      if (by_action_[a].p <= 0) continue;
      for (int b = a + 1; b < kMaxActions; ++b) {
        if (by_action_[b].p <= 0) continue;
        const uint64_t both = uint64_t{1} << a | uint64_t{1} << b;
        Consider(AskYesNo(QuestionKind::kAction, {both, kAny, -1}), by_action_[a] + by_action_[b]);
      }
    }
  }

  /// "One of the k nearest", "one of the k furthest to the left".
  template <typename Key>
  void ConsiderPrefixes(Key key) {
    std::array<int, kMaxThings> order;
    const int n = object_count();
    std::iota(order.begin(), order.begin() + n, 0);
    std::stable_sort(order.begin(), order.begin() + n, [&](int a, int b) {
      return key(situation_.objects[a]) < key(situation_.objects[b]);
    });
    uint64_t mask = 0;
    Mass in;
    for (int k = 0; k + 1 < n; ++k) {
      mask |= uint64_t{1} << order[k];
      in += by_object_[order[k]];
      const bool tied = key(situation_.objects[order[k]]) == key(situation_.objects[order[k + 1]]);
      if (k > 0 && !tied) Consider(AskYesNo(QuestionKind::kSet, {kAny, mask, -1}), in);
    }
  }

  Mass MassOfObjects(uint64_t mask) const {
    Mass mass;
    for (int i = 0; i < object_count(); ++i) {
      if (mask >> i & 1) mass += by_object_[i];
    }
    return mass;
  }

  const Situation& situation_;
  const std::vector<double>& posterior_;
  const ErrorRates rates_;
  const double capacity_;
  const double accept_posterior_;
  Mass pairs_;
  Mass total_;
  std::array<Mass, kMaxActions> by_action_{};
  std::array<Mass, kMaxThings> by_object_{};
  std::optional<Choice> best_;
};

}  // namespace

double RemainingQuestions(double entropy_bits, double capacity_bits) {
  return entropy_bits / capacity_bits + 0.45 + 0.55 * std::exp(-2.4 * entropy_bits);
}

double Capacity(const ErrorRates& rates) {
  const double error = std::clamp((rates.false_yes + rates.false_no) / 2, 0.0, 0.45);
  if (error <= 0) return 1;
  return 1 + error * std::log2(error) + (1 - error) * std::log2(1 - error);
}

std::optional<Choice> ChooseQuestion(const Situation& situation,
                                     const std::vector<double>& posterior, const ErrorRates& rates,
                                     QueryFamilies families, double accept_posterior) {
  return Lookahead(situation, posterior, rates, accept_posterior).Best(families);
}

}  // namespace beckon::intention
