// The default policy: a learnt prior, answers as evidence at an unknown level of noise, and the
// question that minimises the expected number of answers until an accepted full query.
#include <algorithm>
#include <numeric>

#include "services/intention/core/lookahead.h"
#include "services/intention/core/policies.h"
#include "services/intention/core/prior.h"

namespace beckon::intention {
namespace {

constexpr int kLevels = ErrorModel::kLevels;
constexpr double kNoneIsSure =
    0.9;  // this sure that the user wants none of the pairs: nothing left to ask

class AdaptiveDialogue : public Dialogue {
 public:
  AdaptiveDialogue(const AdaptiveConfig& config, const Situation& situation,
                   std::vector<double> prior, const Interface& interface)
      : config_(config),
        situation_(situation),
        errors_(interface.errors),
        accepts_(prior.size(), 0) {
    const bool noisy = errors_.noisy();
    if (noisy) CapPrior(prior, config.noisy_prior_cap);
    const double none = noisy ? config.none_prior : 0;
    for (double& p : prior) p *= 1 - none;
    prior.push_back(none);
    for (const double p : prior) {
      auto& joint = joint_.emplace_back();
      for (int level = 0; level < kLevels; ++level) joint[level] = p * errors_.weights[level];
    }
    Marginalise();
  }

  std::optional<Question> Ask() override {
    if (!choice_) {
      if (none_ > kNoneIsSure || situation_.pairs.empty()) return std::nullopt;
      choice_ = ChooseQuestion(situation_, posterior_, MeanRates(), config_.families,
                               config_.accept_posterior);
    }
    if (!choice_) return std::nullopt;
    return choice_->question;
  }

  void Hear(const Question& question, const Evidence& evidence) override {
    for (size_t i = 0; i < joint_.size(); ++i) {
      const int meant =
          i < situation_.pairs.size() ? question.Meant(situation_.pairs[i]) : question.none();
      for (int level = 0; level < kLevels; ++level)
        joint_[i][level] *= evidence.likelihood[meant][level];
    }
    for (int answer = 0; answer < question.none(); ++answer) {
      const int pair = question.Accepts(answer);
      if (pair >= 0) accepts_[pair] += answer == evidence.said ? 1 : -1;
    }
    Marginalise();
  }

  std::optional<int> Accepted() const override {
    for (size_t i = 0; i < accepts_.size(); ++i) {
      if (accepts_[i] > 0 && posterior_[i] >= config_.accept_posterior) return static_cast<int>(i);
    }
    return std::nullopt;
  }

  Belief CurrentBelief() const override {
    Belief belief;
    for (size_t i = 0; i < posterior_.size(); ++i) {
      if (posterior_[i] > 1e-9) ++belief.possible_pairs;
      if (posterior_[i] > belief.best_posterior) {
        belief.best_posterior = posterior_[i];
        belief.best_pair = static_cast<int>(i);
      }
    }
    belief.expected_questions = choice_ && !Accepted() ? choice_->expected_questions : 0;
    belief.expected_seconds = belief.expected_questions;
    belief.posterior = posterior_;
    return belief;
  }

 private:
  /// Normalises the joint distribution over candidate and level; all zeros where everything is
  /// ruled out.
  void Marginalise() {
    choice_.reset();
    double sum = 0;
    for (const auto& joint : joint_) sum = std::accumulate(joint.begin(), joint.end(), sum);
    posterior_.assign(situation_.pairs.size(), 0.0);
    level_.fill(0);
    none_ = 0;
    if (!(sum > 0)) return;
    for (size_t i = 0; i < joint_.size(); ++i) {
      double p = 0;
      for (int level = 0; level < kLevels; ++level) {
        joint_[i][level] /= sum;
        p += joint_[i][level];
        level_[level] += joint_[i][level];
      }
      (i < posterior_.size() ? posterior_[i] : none_) = std::min(p, 1.0);
    }
  }

  ErrorRates MeanRates() const {
    ErrorRates mean;
    for (int level = 0; level < kLevels; ++level) {
      mean.false_yes += level_[level] * errors_.rates[level].false_yes;
      mean.false_no += level_[level] * errors_.rates[level].false_no;
    }
    return mean;
  }

  const AdaptiveConfig config_;
  const Situation& situation_;
  const ErrorModel errors_;
  std::vector<std::array<double, kLevels>>
      joint_;                      // P(candidate, level); the last candidate is "none"
  std::vector<double> posterior_;  // P(candidate), by pair
  double none_ = 0;
  std::array<double, kLevels> level_{};
  std::vector<int> accepts_;  // by pair: yes minus no to its full query
  std::optional<Choice> choice_;
};

class AdaptivePolicy : public Policy {
 public:
  explicit AdaptivePolicy(const AdaptiveConfig& config) : config_(config) {}

  std::unique_ptr<Dialogue> Begin(const Situation& situation, const UserHistory& history,
                                  const Interface& interface, uint64_t) const override {
    return std::make_unique<AdaptiveDialogue>(config_, situation, PriorOver(situation, history),
                                              interface);
  }

 private:
  const AdaptiveConfig config_;
};

}  // namespace

std::unique_ptr<Policy> MakeAdaptivePolicy(const AdaptiveConfig& config) {
  return std::make_unique<AdaptivePolicy>(config);
}

}  // namespace beckon::intention
