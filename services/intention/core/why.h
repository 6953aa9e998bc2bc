// Why a question is asked: which tasks are likeliest and since when, what each answer would lead
// to, and a sentence that says so.
#pragma once

#include <string>
#include <vector>

#include "services/intention/core/policy.h"

namespace beckon::intention {

/// A task that may be meant.
struct LikelyTask {
  int pair = 0;          // index in Situation::pairs
  double prior = 0;      // before the first answer, 0..1
  double posterior = 0;  // now
  int times = 0;         // sessions of the user that ended in it: category, instance and action
  int recently = 0;      // of the last kRecentSessions of them
  int sessions_ago = 0;  // the last of them, 1 = the session before this one; 0 = never
};

/// What an answer leads to.
struct Prospect {
  double probability = 0;     // that it is given
  double questions_left = 0;  // expected after it; 0 where it accepts
  double seconds_left = 0;
  bool accepts = false;  // it makes a task sure
};

struct Why {
  std::vector<LikelyTask> likeliest;  // at most kMostLikely, likeliest first
  std::vector<Prospect> prospects;    // by answer of the question
  double information_bits = 0;        // that the answer is expected to give about the task
};

inline constexpr int kMostLikely = 8;
inline constexpr int kRecentSessions = 10;

/// `prior`: the belief's posterior before the first answer. `belief` is the one from which
/// `question` was chosen; its expected questions and seconds are shared out among the answers in
/// proportion to what each leaves to find out. Without a posterior (policies that only keep an
/// order) the result is empty.
Why Explain(const Situation& situation, const UserHistory& history,
            const std::vector<double>& prior, const Belief& belief, const Question& question,
            const Interface& interface);

/// "You wanted to open the carton in 7 of the last 9 sessions; a yes settles it."
std::string WhyText(const Affordances& affordances, const Situation& situation,
                    const UserHistory& history, const Belief& belief, const Question& question,
                    const Why& why, const Phrases& phrases = English());

/// Of the question what an object is. `likeliest`: categories it may be, with their probabilities.
/// `in_doubt`: it is asked before any task, else because every known task was refused.
std::string WhyWhatIsIt(const std::vector<std::pair<std::string, double>>& likeliest, bool in_doubt,
                        const Phrases& phrases = English());

}  // namespace beckon::intention
