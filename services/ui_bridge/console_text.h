// The words of the console: how a question reads, and what a typed line means.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "lcmtypes/messages.h"

namespace beckon::ui_bridge {

/// What a line says. kOption carries the option's index.
struct ConsoleInput {
  enum class Kind {
    kOption,
    kUndo,
    kNoneOfThese,
    kStop,
    kResume,
    kQuit,
    kNew,
    kNothing,
    kHelp,
    kUnknown
  };
  Kind kind = Kind::kUnknown;
  size_t option = 0;
  std::string complaint;  // of kUnknown, for the user
};

/// Understands y/n (the first letters of yes and no in the question's language), an option's number
/// from 1 or its text, u, 0, s, r, q, ?, and their words, in any case; an empty line is kNothing.
/// `query` is the question that stands, or null.
ConsoleInput ParseLine(const std::string& line, const msg::Query* query);

/// What the user said an object is, by object id.
using ToldCategories = std::map<int, std::string>;

/// How a question is shown.
struct QuestionStyle {
  bool terminal = false;  // with terminal escapes: bold
  bool brief = false;     // the commands are known: only how to answer, and "? = help"
};

/// Question, options and what may be typed, ready to print. `scene`, or null, tells where the one
/// object stands that it is about.
std::string RenderQuestion(const msg::Query& query, const msg::Scene* scene,
                           const QuestionStyle& style);

/// All that may be typed now; `query` may be null.
std::string RenderHelp(const msg::Query* query);

/// What this is about, for who never saw it.
std::string RenderWelcome();

/// What is on the table, from left to right; for who cannot see the objects pointed out.
std::string RenderScene(const msg::Scene& scene, const ToldCategories& told);

/// A line for an event of the conversation; empty where nothing is to be said.
std::string RenderSession(const msg::Session& event);

std::string RenderTaskStatus(const msg::TaskStatus& status);

}  // namespace beckon::ui_bridge
