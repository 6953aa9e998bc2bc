// What a question is to somebody with a switch: the page that is scanned, the words for what is
// lit, and what others are told of it.
#pragma once

#include <string>

#include "lcmtypes/messages.h"
#include "services/ui_bridge/scan/reaction.h"
#include "services/ui_bridge/scan/scanner.h"

namespace beckon::ui_bridge {

/// Id of pages that are no question.
inline constexpr int64_t kControlPage = 0;

/// Options, likeliest first where the question says how likely they are; and what else can be done:
/// undo where something was answered, "none of these" where no option says so, pause, stop.
/// `seconds_a_letter` gives time to read or hear the question; 0 = none.
scan::Page QuestionPage(const msg::Query& query, double seconds_a_letter = 0);

/// "Undo", "None of these", ...
std::string Words(scan::Control control);

/// What is lit, as shown and spoken: "Open the carton", or "Open the carton, Use the mug" of a
/// group; "Menu" of a group of controls; empty where nothing is. `query` is the one whose page is
/// scanned, or null.
std::string LitWords(const scan::View& view, const msg::Query* query);

/// The same for others who show it. utime, device and user are left out.
msg::Highlight HighlightOf(const scan::View& view, bool of_query);

/// "Your presses take about 0.6 s. Scan every 0.9 s instead of every 1.5 s?"
std::string SuggestionWords(const scan::ScanSuggestion& suggestion, Utime scan_us);

/// Seconds with one or two digits: "0.85".
std::string SecondsWords(Utime us);

/// What an event of the conversation is to the user; empty where nothing is to be said.
std::string SessionWords(const msg::Session& event);

std::string TaskWords(const msg::TaskStatus& status);

}  // namespace beckon::ui_bridge
