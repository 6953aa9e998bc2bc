// The default policy: a learnt prior, answers as evidence at an unknown level of noise, and the
// question that minimises the expected number of answers until an accepted full query.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "services/intention/core/lookahead.h"
#include "services/intention/core/policies.h"
#include "services/intention/core/prior.h"

namespace beckon::intention {
namespace {

constexpr int kLevels = ErrorModel::kLevels;
/// This sure that the user wants none of the pairs: nothing left to ask.
constexpr double kNoneIsSure = 0.9;
/// This sure that the answers mean nothing, or after this many: no use in asking. At 20 % wrong
/// answers a new user is asked 28 questions on average, one in a thousand 93.
constexpr double kUnclearIsSure = 0.99;
constexpr int kMostAnswers = 120;
/// A pair that is likelier than all others together is asked for, by itself or in a choice: of all
/// yes/no questions it tells most, and saying so is needed in any case.
constexpr double kAskFor = 0.5;

/// Bits.
double EntropyOf(double p) {
  return p <= 0 || p >= 1 ? 0 : -p * std::log2(p) - (1 - p) * std::log2(1 - p);
}

class AdaptiveDialogue : public Dialogue {
 public:
  AdaptiveDialogue(const AdaptiveConfig& config, const Situation& situation,
                   std::vector<double> prior, const Interface& interface)
      : config_(config),
        situation_(situation),
        errors_(interface.errors),
        interface_(interface),
        noisy_(errors_.noisy()),
        accepts_(prior.size(), 0) {
    if (noisy_) CapPrior(prior, config.noisy_prior_cap);
    const double none = noisy_ ? config.none_prior : 0;
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
      if (ending_ != Ending::kOpen) return std::nullopt;
      const std::vector<double> posterior = noisy_ ? IfAnswersMean() : posterior_;
      choice_ = ChooseQuestion(situation_, posterior, interface_, MeanRates(), config_.families,
                               config_.accept_posterior);
      if (choice_ && noisy_) {
        const auto best = std::max_element(posterior.begin(), posterior.end());
        const int likeliest = static_cast<int>(best - posterior.begin());
        if (*best > kAskFor && !ChoiceWith(choice_->question, likeliest)) {
          const int pair = Confirming(likeliest);
          choice_->question = AskPair(situation_, pair);
        }
      }
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
      if (pair >= 0 && evidence.said != Evidence::kNothing)
        accepts_[pair] += answer == evidence.said ? 1 : -1;
    }
    ++heard_;
    Marginalise();
  }

  Ending End() const override { return Accepted() ? Ending::kOpen : ending_; }

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
    belief.expected_seconds = choice_ && !Accepted() ? choice_->expected_seconds : 0;
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
    ending_ = Ending::kNone;
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
    ending_ = Judge();
  }

  Ending Judge() const {
    double meaningless = 0, possible = 0;
    for (int level = 0; level < kLevels; ++level)
      if (noisy_ && !errors_.Means(level)) meaningless += level_[level];
    for (const double p : posterior_) possible += p;
    if (meaningless > kUnclearIsSure || (noisy_ && heard_ >= kMostAnswers)) return Ending::kUnclear;
    if (!(possible > 0) || none_ > kNoneIsSure) return Ending::kNone;
    return Ending::kOpen;
  }

  static bool ChoiceWith(const Question& question, int pair) {
    return question.kind == QuestionKind::kChoice &&
           std::any_of(question.options.begin(), question.options.end(),
                       [&](const Proposition& option) { return option.pair == pair; });
  }

  /// By pair, over the levels at which answers mean something: at the others no question helps.
  std::vector<double> IfAnswersMean() const {
    std::vector<double> posterior(posterior_.size(), 0.0);
    double sum = 0;
    for (int level = 0; level < kLevels; ++level) {
      if (!errors_.Means(level)) continue;
      sum += level_[level];
      for (size_t i = 0; i < posterior.size(); ++i) posterior[i] += joint_[i][level];
    }
    for (double& p : posterior) p = std::min(p / sum, 1.0);
    return posterior;
  }

  /// Which pair to ask for where one is likelier than all others: itself, or, where what speaks
  /// against it is a switch that always says yes, the unlikeliest one to hear a no. The one whose
  /// answer tells more about whether `best` is wanted, over all levels.
  int Confirming(int best) const {
    const int check = static_cast<int>(std::min_element(posterior_.begin(), posterior_.end()) -
                                       posterior_.begin());
    double yes_best[2] = {0, 0}, yes_other[2] = {0, 0};  // to the two questions
    for (int level = 0; level < kLevels; ++level) {
      const auto& [false_yes, false_no] = errors_.rates[level];
      const double wanted = joint_[best][level], checked = joint_[check][level];
      const double other = level_[level] - wanted;
      yes_best[0] += wanted * (1 - false_no);
      yes_other[0] += other * false_yes;
      yes_best[1] += wanted * false_yes;
      yes_other[1] += (other - checked) * false_yes + checked * (1 - false_no);
    }
    const double p = posterior_[best];
    const auto tells = [&](int i) {
      return EntropyOf(yes_best[i] + yes_other[i]) - p * EntropyOf(yes_best[i] / p) -
             (1 - p) * EntropyOf(yes_other[i] / (1 - p));
    };
    return 1 - p > 0 && tells(1) > tells(0) ? check : best;
  }

  /// Of the levels at which answers mean something.
  ErrorRates MeanRates() const {
    ErrorRates mean;
    double sum = 0;
    for (int level = 0; level < kLevels; ++level) {
      if (!errors_.Means(level)) continue;
      sum += level_[level];
      mean.false_yes += level_[level] * errors_.rates[level].false_yes;
      mean.false_no += level_[level] * errors_.rates[level].false_no;
    }
    return sum > 0 ? ErrorRates{mean.false_yes / sum, mean.false_no / sum} : mean;
  }

  const AdaptiveConfig config_;
  const Situation& situation_;
  const ErrorModel errors_;
  const Interface interface_;
  const bool noisy_;
  std::vector<std::array<double, kLevels>>
      joint_;                      // P(candidate, level); the last candidate is "none"
  std::vector<double> posterior_;  // P(candidate), by pair
  double none_ = 0;
  std::array<double, kLevels> level_{};
  std::vector<int> accepts_;  // by pair: yes minus no to its full query
  int heard_ = 0;
  Ending ending_ = Ending::kOpen;
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
