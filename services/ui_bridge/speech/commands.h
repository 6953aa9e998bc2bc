// What may be said while a question stands: its answers, what is always possible, and in which
// words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"

namespace beckon::ui_bridge::speech {

enum class CommandKind { kOption, kNone, kUndo, kStop, kResume, kStart, kRepeat };

/// "option", "none of these", ...
const char* Name(CommandKind kind);

/// One meaning and the ways to say it.
struct Command {
  CommandKind kind = CommandKind::kOption;
  size_t option = 0;  // of the query, where kind is kOption
  /// Words in lower case with one blank between, or phones between slashes: "/Y EH S/".
  std::vector<std::string> phrases;
};

/// The words of a user; each may be replaced. Entries as in Command::phrases.
struct SpokenWords {
  std::vector<std::string> yes = {"yes", "yeah"};
  std::vector<std::string> no = {"no", "nope"};
  std::vector<std::string> stop = {"stop", "stop stop", "stop stop stop"};
  std::vector<std::string> undo = {"undo", "take that back"};
  std::vector<std::string> none = {"none of these"};
  std::vector<std::string> resume = {"resume"};
  std::vector<std::string> start = {"start"};
  std::vector<std::string> repeat = {"repeat"};
  /// "number one", "number two" ... for the options of a choice.
  std::string number = "number";
};

/// The commands that make sense now. A yes/no question has yes and no; a choice its options by name
/// and by number, where the last one is "none of these" if it says so. A phrase that would mean two
/// things means neither: such options have their number only. Without a query: stop, resume, start,
/// undo.
std::vector<Command> CommandsFor(const msg::Query* query, const SpokenWords& words);

/// All phrases of `words`, for checking them before anything runs.
std::vector<std::string> AllPhrases(const SpokenWords& words);

/// Whether the query's options are yes and no.
bool IsYesNo(const msg::Query& query);

}  // namespace beckon::ui_bridge::speech
