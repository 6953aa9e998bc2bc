// When there were trials enough.
#pragma once

#include <cstddef>
#include <vector>

namespace beckon::ui_bridge::bci {

struct StoppingConfig {
  double threshold = 0.95;  // 0.5 .. 1, of the posterior of the likeliest class
  // 0.5 .. 1, of a class whose answer ends the conversation: it is confirmed without a further
  // question.
  double final_threshold = 0.993;
  int min_repetitions = 1;   // >= 1
  int max_repetitions = 12;  // >= min_repetitions; then what is known is answered, sure or not
};

enum class Verdict {
  kNotYet,
  kSure,   // the likeliest class has its threshold
  kEnough  // the most repetitions
};

/// `posterior`: one a class. `ends`: whether a class ends the conversation; empty: none does.
Verdict ShouldStop(const StoppingConfig& config, const std::vector<double>& posterior,
                   const std::vector<bool>& ends, int repetitions);

struct StopWatchConfig {
  // Trials between two false alarms, on average, at least; > 1. Fewer: a stop takes fewer trials.
  double trials_per_false_stop = 100;
};

/// Whether the user attends to "stop", whatever else is asked: Page's cumulative sum (E. S. Page,
/// "Continuous inspection schemes", 1954) of log P(trial | stop) - log P(trial | something else),
/// which is another class or, while nothing is asked, nothing at all: then the less of the two. How
/// likely a trial is under nothing, probabilities do not say; but by how much stop is above the
/// mean of the others is taken to be normal, with mean 0 (nothing) or `gap` (stop) and the variance
/// of an honest decoder. One trial is enough where it says so clearly, and what was attended to
/// before counts for nothing. At a sum of log n false alarms are n trials apart or more (G. Lorden,
/// "Procedures for reacting to a change in distribution", 1971).
class StopWatch {
 public:
  explicit StopWatch(const StopWatchConfig& config);

  /// True: the user wants everything to stop. `log_likelihoods`: one a class; `stop`: which of
  /// them; `gap`: of DecoderModel, > 0; `asked`: something else is asked, to which the user attends
  /// otherwise.
  bool Hear(const std::vector<double>& log_likelihoods, size_t stop, double gap, bool asked);
  void Reset() { sum_ = 0; }
  /// 0..1, of what is needed.
  double level() const { return sum_ / limit_; }

 private:
  double limit_;
  double sum_ = 0;
};

}  // namespace beckon::ui_bridge::bci
