#include "services/ui_bridge/switch/switch_pages.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace beckon::ui_bridge {
namespace {

constexpr double kLongestReading_s = 10;
constexpr Utime kLongestDwell_us = 3'600 * kSecond;  // that Highlight can say

void Append(std::string& list, const std::string& word) {
  list += (list.empty() ? "" : ", ") + word;
}

/// ": open the carton"; empty where nothing is said.
std::string After(const std::string& text) { return text.empty() ? "." : ": " + text; }

}  // namespace

scan::Page QuestionPage(const msg::Query& query, double seconds_a_letter) {
  using scan::Control;
  const bool says_none =
      query.kind == msg::QueryKind::kChoice || query.kind == msg::QueryKind::kWhatIsIt;
  scan::Page page;
  page.id = query.id;
  page.n_options = static_cast<int>(query.options.size());
  page.none_last = says_none;
  for (const auto& prospect : query.prospects) {
    page.probabilities.push_back(static_cast<double>(prospect.probability));
  }
  const double read_s =
      std::min(seconds_a_letter * static_cast<double>(query.text.size()), kLongestReading_s);
  page.read_us = static_cast<Utime>(read_s * kSecond);
  if (query.questions_asked > 0) page.controls.push_back(Control::kUndo);
  if (!says_none) page.controls.push_back(Control::kNone);
  page.controls.push_back(Control::kPause);
  page.controls.push_back(Control::kStop);
  return page;
}

std::string Words(scan::Control control) {
  using scan::Control;
  switch (control) {
    case Control::kUndo:
      return "Undo";
    case Control::kNone:
      return "None of these";
    case Control::kPause:
      return "Pause";
    case Control::kStop:
      return "Stop";
    case Control::kResume:
      return "Resume";
    case Control::kStay:
      return "Stay stopped";
    case Control::kStart:
      return "New task";
    case Control::kAccept:
      return "Yes, change it";
    case Control::kKeep:
      return "No, keep it";
  }
  return "";
}

std::string LitWords(const scan::View& view, const msg::Query* query) {
  if (view.entry < 0) return "";
  if (view.back) return "Back";
  if (view.group && view.options.empty()) return "Menu";
  std::string words;
  for (const int option : view.options) {
    const auto at = static_cast<size_t>(option);
    if (query != nullptr && at < query->options.size()) Append(words, query->options[at].text);
  }
  // Of a group with options the controls are one more way, not to be read out one by one.
  if (view.group && !view.controls.empty()) Append(words, "Menu");
  if (!view.group) {
    for (const auto control : view.controls) Append(words, Words(control));
  }
  return words;
}

msg::Highlight HighlightOf(const scan::View& view, bool of_query) {
  msg::Highlight highlight;
  if (of_query && view.page > 0) {
    highlight.query_id = view.page;
    highlight.options = view.options;
  }
  for (const auto control : view.controls) highlight.controls.emplace_back(scan::Name(control));
  if (view.back) highlight.controls.emplace_back("back");
  highlight.pressed = view.pressed;
  highlight.paused = view.paused;
  highlight.dwell_ms =
      static_cast<int>(std::clamp<Utime>(view.dwell_us, 0, kLongestDwell_us) / 1000);
  return highlight;
}

std::string SecondsWords(Utime us) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", static_cast<double>(us) / kSecond);
  std::string words = text.data();
  if (words.back() == '0') words.pop_back();
  return words;
}

std::string SuggestionWords(const scan::ScanSuggestion& suggestion, Utime scan_us) {
  const std::string change = "Scan every " + SecondsWords(suggestion.scan_us) +
                             " s instead of every " + SecondsWords(scan_us) + " s?";
  if (suggestion.because_undone) return "Many choices were taken back. " + change;
  return "Your presses take about " + SecondsWords(suggestion.estimate.mean_us) + " s. " + change;
}

std::string SessionWords(const msg::Session& event) {
  switch (event.kind) {
    case msg::SessionKind::kBegun:
      return event.text;
    case msg::SessionKind::kConfirmed:
      return "The robot was told" + After(event.text);
    case msg::SessionKind::kAbandoned:
      return "The conversation ended without a task" + After(event.text);
    case msg::SessionKind::kStopped:
      return "Stopped.";
    default:
      return {};
  }
}

std::string TaskWords(const msg::TaskStatus& status) {
  switch (status.state) {
    case msg::TaskState::kAccepted:
      return "The robot has taken the task" + After(status.text);
    case msg::TaskState::kRunning:
      return "The robot is at it" + After(status.text);
    case msg::TaskState::kDone:
      return "The robot is done" + After(status.text);
    case msg::TaskState::kFailed:
      return "The robot could not do it" + After(status.text);
    case msg::TaskState::kExpired:
      return "No robot took the task in time" + After(status.text);
    case msg::TaskState::kRevoked:
      return "The task was taken back" + After(status.text);
  }
  return {};
}

}  // namespace beckon::ui_bridge
