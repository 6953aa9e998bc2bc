// The words of the console: how a question reads, and what a typed line means.
#pragma once

#include <optional>
#include <string>

#include "lcmtypes/messages.h"

namespace beckon::ui_bridge {

/// What a line says. kOption carries the option's index.
struct ConsoleInput {
  enum class Kind { kOption, kUndo, kNoneOfThese, kStop, kResume, kQuit, kNew, kNothing, kUnknown };
  Kind kind = Kind::kUnknown;
  size_t option = 0;
  std::string complaint;  // of kUnknown, for the user
};

/// Understands y/n, an option's number from 1, u, 0, s, r, q, and their words, in any case; an
/// empty line is kNothing. `query` is the question that stands, or null.
ConsoleInput ParseLine(const std::string& line, const msg::Query* query);

/// Question, options and what may be typed, ready to print. `bold`: with terminal escapes. `scene`,
/// or null, tells where an object stands that has no name yet.
std::string RenderQuestion(const msg::Query& query, const msg::Scene* scene, bool bold);

/// What is on the table, from left to right; for who cannot see the objects pointed out.
std::string RenderScene(const msg::Scene& scene);

/// A line for an event of the conversation; empty where nothing is to be said.
std::string RenderSession(const msg::Session& event);

std::string RenderTaskStatus(const msg::TaskStatus& status);

}  // namespace beckon::ui_bridge
