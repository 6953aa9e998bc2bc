// What the front end bci shows on a terminal.
#pragma once

#include <string>
#include <vector>

#include "services/ui_bridge/bci/trials.h"

namespace beckon::ui_bridge::bci {

/// The question and the matrix of what its classes stand for, as it is first shown.
std::string RenderAsked(const std::string& text, const Layout& layout);
/// The matrix again, with a bar under each label: P(class) after so many trials. `layout` and
/// `posterior` have the same classes.
std::string RenderPosterior(const Layout& layout, const std::vector<double>& posterior,
                            int repetitions);
/// What an answer was, the likeliest option first.
std::string RenderAnswer(const msg::Query& query, const std::vector<double>& likelihoods);
/// A line about a session's event; empty where there is nothing to say.
std::string RenderEvent(const msg::Session& event);
std::string RenderKeys();

/// What a typed line asks for.
enum class Key { kNothing, kStop, kResume, kUndo, kPause, kNew, kQuit, kUnknown };
/// 's' or "stop" and so on; an empty line is kNew.
Key ParseKey(const std::string& line);

}  // namespace beckon::ui_bridge::bci
