#include "services/intention/core/why.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

#include "services/intention/core/lookahead.h"
#include "services/intention/core/policies.h"

namespace beckon::intention {
namespace {

/// As little as this is not named.
constexpr double kNegligible = 1e-4;
/// The policy's estimate of what is left may be so many times that of a yes/no switch without
/// errors.
constexpr double kMostScale = 10;
/// A question that tells so much of what a yes/no answer can (bits) halves what is possible.
constexpr double kHalves = 0.9;

double XLogX(double x) { return x > 0 ? x * std::log2(x) : 0; }

/// P(said | meant), the mean over the levels of noise.
std::vector<std::vector<double>> Channel(const ErrorModel& errors, int answers) {
  std::vector<std::vector<double>> channel(answers, std::vector<double>(answers, 0.0));
  for (int meant = 0; meant < answers; ++meant) {
    for (int said = 0; said < answers; ++said) {
      for (int level = 0; level < ErrorModel::kLevels; ++level)
        channel[meant][said] +=
            errors.weights[level] * errors.Probability(level, answers, meant, said);
    }
  }
  return channel;
}

/// Candidates by the answer they would mean: sums of p and of p log2 p. What the pairs leave of 1
/// is "none of them".
struct Groups {
  std::vector<double> p, p_log_p;

  Groups(const Situation& situation, const std::vector<double>& posterior, const Question& question)
      : p(question.answers(), 0.0), p_log_p(question.answers(), 0.0) {
    const double all = std::accumulate(posterior.begin(), posterior.end(), 0.0);
    for (size_t i = 0; i < posterior.size(); ++i)
      Add(question.Meant(situation.pairs[i]), posterior[i]);
    Add(question.none(), std::max(0.0, 1 - all));
  }

  /// Entropy of what is wanted, bits, after an answer with these likelihoods by answer meant.
  double EntropyAfter(const std::vector<std::vector<double>>& channel, int said) const {
    double z = 0, sum = 0;  // of q log2 q with q = p P(said | meant)
    for (size_t meant = 0; meant < p.size(); ++meant) {
      const double likelihood = channel[meant][said];
      z += p[meant] * likelihood;
      sum += likelihood * p_log_p[meant] + p[meant] * XLogX(likelihood);
    }
    return z > 0 ? std::max(0.0, std::log2(z) - sum / z) : 0;
  }

 private:
  void Add(int answer, double probability) {
    p[answer] += probability;
    p_log_p[answer] += XLogX(probability);
  }
};

LikelyTask Remember(const Situation& situation, const UserHistory& history, int pair) {
  LikelyTask task;
  task.pair = pair;
  const Pair& wanted = situation.pairs[pair];
  const Instance& object = situation.objects[wanted.object];
  for (size_t ago = 1; ago <= history.size(); ++ago) {
    const PastSession& past = history[history.size() - ago];
    if (past.category != object.category || past.action != wanted.action ||
        past.rank != object.rank)
      continue;
    ++task.times;
    if (ago <= kRecentSessions) ++task.recently;
    if (task.sessions_ago == 0) task.sessions_ago = static_cast<int>(ago);
  }
  return task;
}

std::vector<LikelyTask> Likeliest(const Situation& situation, const UserHistory& history,
                                  const std::vector<double>& prior,
                                  const std::vector<double>& posterior) {
  std::vector<int> order(posterior.size());
  std::iota(order.begin(), order.end(), 0);
  const auto count = std::min<size_t>(order.size(), kMostLikely);
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](int a, int b) {
                      return posterior[a] != posterior[b] ? posterior[a] > posterior[b] : a < b;
                    });
  std::vector<LikelyTask> likeliest;
  for (size_t i = 0; i < count && posterior[order[i]] > kNegligible; ++i) {
    LikelyTask task = Remember(situation, history, order[i]);
    task.posterior = posterior[order[i]];
    task.prior = prior.empty() ? 0 : prior[order[i]];
    likeliest.push_back(task);
  }
  return likeliest;
}

/// Shares out the expected questions and seconds after this answer: in proportion to `left`.
void ShareOut(std::vector<Prospect>& prospects, const std::vector<double>& left,
              const Belief& belief, const Interface& interface) {
  const int answers = static_cast<int>(prospects.size());
  double mean_left = 0, now_s = 0;
  for (int said = 0; said < answers; ++said) {
    mean_left += prospects[said].probability * left[said];
    now_s += prospects[said].probability * interface.Seconds(answers, said);
  }
  if (mean_left <= 0) return;
  const double questions = std::clamp((belief.expected_questions - 1) / mean_left, 0.0, kMostScale);
  const double seconds =
      std::clamp((belief.expected_seconds - now_s) / mean_left, 0.0, kMostScale * now_s);
  for (int said = 0; said < answers; ++said) {
    prospects[said].questions_left = questions * left[said];
    prospects[said].seconds_left = seconds * left[said];
  }
}

// Words. A sentence is put together from a reason and what comes of it.

/// A task as it stands within a sentence.
std::string TaskWords(const Affordances& affordances, const Situation& situation, int pair,
                      const Phrases& phrases) {
  std::string text = TaskText(affordances, situation, situation.pairs[pair], phrases);
  text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

std::string Count(int n, const Phrases& phrases) {
  const bool word = n >= 1 && n <= static_cast<int>(phrases.numbers.size());
  return word ? phrases.numbers[static_cast<size_t>(n - 1)] : std::to_string(n);
}

std::string Habit(const std::string& task, const LikelyTask& likely, size_t sessions,
                  const Phrases& phrases) {
  const int recent = static_cast<int>(std::min<size_t>(sessions, kRecentSessions));
  const bool last_time = likely.recently == 1 && likely.sessions_ago == 1;
  const std::string& text = likely.recently == 0        ? phrases.wanted_before
                            : last_time                 ? phrases.wanted_last_time
                            : likely.recently == recent ? phrases.wanted_each_time
                                                        : phrases.wanted_often;
  return Fill(phrases, text,
              {{"task", {{"", task}}},
               {"times", {{"", std::to_string(likely.recently)}}},
               {"sessions", {{"", std::to_string(recent)}}}});
}

/// A habit that the question is about: of the tasks it mentions the likeliest that was wanted
/// before.
const LikelyTask* HabitBehind(const Situation& situation, const Question& question,
                              const Why& why) {
  constexpr double kLikely = 0.05;
  for (const LikelyTask& task : why.likeliest) {
    const bool mentioned = question.Meant(situation.pairs[task.pair]) != question.none();
    if (mentioned && task.times > 0 && task.posterior >= kLikely) return &task;
  }
  return nullptr;
}

std::string Reason(const Affordances& affordances, const Situation& situation,
                   const UserHistory& history, const Belief& belief, const Question& question,
                   const Why& why, const Phrases& phrases) {
  if (const LikelyTask* habit = HabitBehind(situation, question, why)) {
    return Habit(TaskWords(affordances, situation, habit->pair, phrases), *habit, history.size(),
                 phrases);
  }
  const bool full = question.kind == QuestionKind::kFull;
  if (full && belief.possible_pairs == 1) return phrases.only_task;
  const bool halves = question.answers() == 2 && why.information_bits > kHalves;
  const std::string& text = full     ? phrases.likeliest_task
                            : halves ? phrases.halves
                                     : phrases.tells_most;
  return Fill(phrases, text, "count", Count(belief.possible_pairs, phrases));
}

std::string Outlook(const Question& question, const Belief& belief, const Why& why,
                    const Phrases& phrases) {
  const bool settles =
      std::any_of(why.prospects.begin(), why.prospects.end(),
                  [](const Prospect& p) { return p.accepts && p.probability > 0.5; });
  if (settles && question.answers() == 2) return phrases.settles;
  const int left = static_cast<int>(std::lround(std::max(1.0, belief.expected_questions - 1)));
  return left == 1 ? phrases.one_follows
                   : Fill(phrases, phrases.more_follow, "count", Count(left, phrases));
}

}  // namespace

Why Explain(const Situation& situation, const UserHistory& history,
            const std::vector<double>& prior, const Belief& belief, const Question& question,
            const Interface& interface) {
  Why why;
  if (belief.posterior.empty()) return why;
  why.likeliest = Likeliest(situation, history, prior, belief.posterior);
  const int answers = question.answers();
  const Groups groups(situation, belief.posterior, question);
  const auto channel = Channel(interface.errors, answers);
  std::vector<double> left(answers, 0.0);
  double equivocation = 0;  // H(answer | task)
  for (int said = 0; said < answers; ++said) {
    Prospect& prospect = why.prospects.emplace_back();
    for (int meant = 0; meant < answers; ++meant) {
      prospect.probability += groups.p[meant] * channel[meant][said];
      equivocation -= groups.p[meant] * XLogX(channel[meant][said]);
    }
    why.information_bits -= XLogX(prospect.probability);
    if (const int pair = question.Accepts(said); pair >= 0) {
      const double after = belief.posterior[pair] * channel[said][said];
      prospect.accepts =
          after > 0 && after >= AdaptiveConfig{}.accept_posterior * prospect.probability;
    }
    if (!prospect.accepts)
      left[said] = RemainingQuestions(groups.EntropyAfter(channel, said), /*capacity_bits=*/1);
  }
  why.information_bits = std::max(0.0, why.information_bits - equivocation);
  ShareOut(why.prospects, left, belief, interface);
  return why;
}

std::string WhyText(const Affordances& affordances, const Situation& situation,
                    const UserHistory& history, const Belief& belief, const Question& question,
                    const Why& why, const Phrases& phrases) {
  const std::string reason =
      Reason(affordances, situation, history, belief, question, why, phrases);
  return Finished(Fill(
      phrases, phrases.because,
      {{"reason", {{"", reason}}}, {"outlook", {{"", Outlook(question, belief, why, phrases)}}}}));
}

std::string WhyWhatIsIt(const std::vector<std::pair<std::string, double>>& likeliest, bool in_doubt,
                        const Phrases& phrases) {
  if (!in_doubt) return Finished(phrases.looks_wrong);
  std::string objects;
  for (const auto& [category, probability] : likeliest) {
    if (!objects.empty()) objects += phrases.list_or;
    objects += Fill(phrases, phrases.looks,
                    {{"object", {{"", ANoun(phrases, category)}}},
                     {"percent", {{"", std::to_string(std::lround(100 * probability))}}}});
  }
  return Finished(objects.empty() ? phrases.looks_unclear
                                  : Fill(phrases, phrases.looks_like, "objects", objects));
}

}  // namespace beckon::intention
