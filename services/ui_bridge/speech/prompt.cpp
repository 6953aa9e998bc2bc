#include "services/ui_bridge/speech/prompt.h"

#include <algorithm>

#include "services/ui_bridge/speech/commands.h"

namespace beckon::ui_bridge::speech {
namespace {

constexpr double kWordsOfQuestion = 6;
constexpr double kWordsOfOption = 4;
constexpr double kFollow = 0.2;  // weight of the newest prompt

}  // namespace

std::string QuestionPrompt(const msg::Query& query, const std::string& number, bool hint) {
  std::string text = query.text;
  if (IsYesNo(query)) return hint ? text + " Say yes or no." : text;
  for (size_t i = 0; i < query.options.size(); ++i)
    text += " " + (number.empty() ? "" : number + " ") + std::to_string(i + 1) + ": " +
            query.options[i].text + ".";
  return text;
}

std::string SessionPrompt(const msg::Session& event) {
  switch (event.kind) {
    case msg::SessionKind::kBegun:
    case msg::SessionKind::kConfirmed:
    case msg::SessionKind::kAbandoned:
      return event.text;
    case msg::SessionKind::kStopped:
      return "Stopped. Say resume to go on.";
    default:
      return "";
  }
}

PromptTimes::PromptTimes(int words_per_minute)
    : question_s_(60 * kWordsOfQuestion / words_per_minute),
      option_s_(60 * kWordsOfOption / words_per_minute) {}

void PromptTimes::Spoken(int options, double seconds) {
  if (options == 0) {
    question_s_ += kFollow * (std::clamp(seconds, 0.2, 60.0) - question_s_);
  } else {
    const double each = (seconds - question_s_) / options;
    option_s_ += kFollow * (std::clamp(each, 0.1, 20.0) - option_s_);
  }
}

}  // namespace beckon::ui_bridge::speech
