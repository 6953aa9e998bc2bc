#include "services/intention/session_trace.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "services/intention/core/why.h"

namespace beckon::intention {
namespace {

/// Likeliest tasks shown at a time.
constexpr size_t kShown = 3;

template <typename... Values>
std::string Formatted(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// Right-aligned, five characters: "  7 %", " <1 %", "100 %".
std::string Percent(double probability) {
  const double percent = 100 * probability;
  if (percent > 0 && percent < 0.5) return " <1 %";
  if (percent < 99.95 && percent > 99.5) return ">99 %";
  return Formatted("%3.0f %%", percent);
}

/// "   why        ": a line's label.
std::string Label(const std::string& label) { return Formatted("   %-10s ", label.c_str()); }

std::string AnswerText(const Affordances& affordances, const Situation& situation,
                       const Question& question, int answer) {
  if (question.kind != QuestionKind::kChoice) return answer == 0 ? "yes" : "no";
  if (answer == question.none()) return "none of these";
  return OptionText(affordances, situation, question.options[static_cast<size_t>(answer)]);
}

std::string Plural(int n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

std::string HabitText(const LikelyTask& task) {
  if (task.times == 0) return {};
  return task.times == 1 ? "wanted once, " + Plural(task.sessions_ago, "session") + " ago"
                         : "wanted " + std::to_string(task.times) + " times, last " +
                               Plural(task.sessions_ago, "session") + " ago";
}

}  // namespace

void SessionTrace::WriteLikeliest(const char* label, const SessionView& view, const Belief& belief,
                                  bool with_habits) {
  // Of any question: only its candidates are used.
  const Why why =
      Explain(view.situation, view.history, prior_, belief, AskAction(0), view.interface);
  std::string line = Label(label);
  for (size_t i = 0; i < std::min(kShown, why.likeliest.size()); ++i) {
    const LikelyTask& task = why.likeliest[i];
    const std::string text =
        TaskText(affordances_, view.situation, view.situation.pairs[task.pair]);
    const std::string habit = with_habits ? HabitText(task) : "";
    out_ << line << Percent(task.posterior) << "  "
         << (habit.empty() ? text : Formatted("%-32s %s", text.c_str(), habit.c_str())) << '\n';
    line = Label("");
  }
}

void SessionTrace::Begun(const SessionView& view, const Belief& belief) {
  prior_ = belief.posterior;
  questions_ = 0;
  const int number = ++sessions_[view.session.user];
  const std::string wanted =
      TaskText(affordances_, view.situation, view.situation.pairs[view.wanted]);
  out_ << view.session.user << ", session " << number << ": wants \"" << wanted << "\"; "
       << Plural(static_cast<int>(view.situation.objects.size()), "object") << ", "
       << Plural(view.situation.pair_count(), "task") << " possible\n";
  WriteLikeliest("at first", view, belief, /*with_habits=*/true);
}

void SessionTrace::Answered(const SessionView& view, const AnsweredQuestion& answered) {
  const Question& question = answered.question;
  const Situation& situation = view.situation;
  const Why why =
      Explain(situation, view.history, prior_, answered.before, question, view.interface);
  const auto text = [&](int answer) {
    return AnswerText(affordances_, situation, question, answer);
  };
  out_ << Formatted("%2d ", ++questions_) << Formatted("%-10s ", "question")
       << Text(affordances_, situation, question) << '\n';
  out_ << Label("why")
       << WhyText(affordances_, situation, view.history, answered.before, question, why) << '\n';
  std::string label = Label("if");
  for (int answer = 0; answer < static_cast<int>(why.prospects.size()); ++answer) {
    const Prospect& prospect = why.prospects[static_cast<size_t>(answer)];
    out_ << label << Percent(prospect.probability) << "  "
         << Formatted("%-32s ", text(answer).c_str())
         << (prospect.accepts ? "settles it"
                              : Formatted("%.1f more to ask", prospect.questions_left))
         << '\n';
    label = Label("");
  }
  if (!why.prospects.empty())
    out_ << Label("tells") << Formatted("%.2f bits", why.information_bits) << '\n';
  const int meant = question.Meant(situation.pairs[view.wanted]);
  out_ << Label("answer") << text(answered.answer)
       << (meant == answered.answer ? "" : " (wrongly; \"" + text(meant) + "\" was meant)") << '\n';
  WriteLikeliest("then", view, answered.after, /*with_habits=*/false);
}

void SessionTrace::Ended(const SessionView& view, const SessionOutcome& outcome) {
  const std::string after = " after " + Plural(outcome.questions, "question");
  out_ << Label("end");
  if (!outcome.answered) {
    out_ << "no task" << after << "\n\n";
    return;
  }
  const PastSession& task = *outcome.answered;
  const int pair = view.situation.Find(task.category, task.rank, task.action);
  out_ << TaskText(affordances_, view.situation, view.situation.pairs[pair]) << after << ": "
       << (outcome.correct ? "right" : "WRONG") << Formatted(" (posterior %.4f)", outcome.posterior)
       << "\n\n";
}

}  // namespace beckon::intention
