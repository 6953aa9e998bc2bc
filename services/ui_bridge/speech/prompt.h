// What is said to the user, and how long it takes.
#pragma once

#include <string>

#include "lcmtypes/messages.h"

namespace beckon::ui_bridge::speech {

/// The question; the options of a choice with the numbers by which they can be named. `number` as
/// in SpokenWords. With `hint` it says how to answer.
std::string QuestionPrompt(const msg::Query& query, const std::string& number, bool hint);
/// Empty where nothing needs to be said.
std::string SessionPrompt(const msg::Session& event);

/// How long speaking and answering take; announced to intention, which asks accordingly. Begins
/// with an estimate from the speed of speech and follows the prompts that were played.
class PromptTimes {
 public:
  explicit PromptTimes(int words_per_minute);
  /// A question with `options` to name (0 for yes/no) took `seconds` to speak.
  void Spoken(int options, double seconds);
  float seconds_per_question() const { return static_cast<float>(question_s_ + kAnswer_s); }
  float seconds_per_option() const { return static_cast<float>(option_s_); }

 private:
  static constexpr double kAnswer_s = 1.5;  // to say a word, and to know that it is over
  double question_s_;
  double option_s_;
};

}  // namespace beckon::ui_bridge::speech
