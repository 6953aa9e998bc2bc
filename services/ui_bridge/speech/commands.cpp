#include "services/ui_bridge/speech/commands.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "services/ui_bridge/speech/lexicon.h"

namespace beckon::ui_bridge::speech {
namespace {

bool IsArticle(const std::string& word) { return word == "the" || word == "a" || word == "an"; }

std::string WithoutArticles(const std::string& phrase) {
  std::istringstream words(phrase);
  std::string rest;
  for (std::string word; words >> word;) {
    if (!IsArticle(word)) rest += (rest.empty() ? "" : " ") + word;
  }
  return rest;
}

void AddPhrase(Command& command, const std::string& phrase) {
  if (!phrase.empty() && std::ranges::find(command.phrases, phrase) == command.phrases.end())
    command.phrases.push_back(phrase);
}

/// Takes away what two commands would claim.
void DropAmbiguous(std::vector<Command>& commands) {
  std::map<std::string, int> claims;
  for (const auto& command : commands) {
    for (const auto& phrase : command.phrases) ++claims[phrase];
  }
  for (auto& command : commands) {
    if (command.kind == CommandKind::kOption)
      std::erase_if(command.phrases, [&](const auto& phrase) { return claims[phrase] > 1; });
  }
}

std::vector<Command> OptionCommands(const msg::Query& query, const SpokenWords& words) {
  if (IsYesNo(query)) {
    return {{CommandKind::kOption, 0, words.yes}, {CommandKind::kOption, 1, words.no}};
  }
  std::vector<Command> commands;
  for (size_t i = 0; i < query.options.size(); ++i) {
    Command command{CommandKind::kOption, i, {}};
    const std::string text = Normalised(query.options[i].text);
    const bool none = i + 1 == query.options.size() && text == "none of these";
    if (none) command.phrases = words.none;
    AddPhrase(command, text);
    AddPhrase(command, WithoutArticles(text));
    AddPhrase(command, Normalised(query.options[i].category == msg::kUnknownCategory
                                      ? ""
                                      : query.options[i].category));
    const std::string number = Normalised(std::to_string(i + 1));
    if (i < 12) AddPhrase(command, words.number.empty() ? number : words.number + " " + number);
    commands.push_back(std::move(command));
  }
  return commands;
}

}  // namespace

const char* Name(CommandKind kind) {
  switch (kind) {
    case CommandKind::kOption:
      return "option";
    case CommandKind::kNone:
      return "none of these";
    case CommandKind::kUndo:
      return "undo";
    case CommandKind::kStop:
      return "stop";
    case CommandKind::kResume:
      return "resume";
    case CommandKind::kStart:
      return "start";
    case CommandKind::kRepeat:
      return "repeat";
  }
  return "?";
}

std::vector<Command> CommandsFor(const msg::Query* query, const SpokenWords& words) {
  std::vector<Command> commands;
  commands.push_back({CommandKind::kStop, 0, words.stop});
  commands.push_back({CommandKind::kUndo, 0, words.undo});
  if (query == nullptr) {
    commands.push_back({CommandKind::kResume, 0, words.resume});
    commands.push_back({CommandKind::kStart, 0, words.start});
    return commands;
  }
  commands.push_back({CommandKind::kRepeat, 0, words.repeat});
  auto options = OptionCommands(*query, words);
  const bool has_none = std::ranges::any_of(options, [&](const Command& option) {
    return std::ranges::any_of(option.phrases, [&](const auto& phrase) {
      return std::ranges::find(words.none, phrase) != words.none.end();
    });
  });
  if (!has_none) commands.push_back({CommandKind::kNone, 0, words.none});
  commands.insert(commands.end(), options.begin(), options.end());
  DropAmbiguous(commands);
  return commands;
}

std::vector<std::string> AllPhrases(const SpokenWords& words) {
  std::vector<std::string> all;
  for (const auto* some : {&words.yes, &words.no, &words.stop, &words.undo, &words.none,
                           &words.resume, &words.start, &words.repeat}) {
    all.insert(all.end(), some->begin(), some->end());
  }
  if (!words.number.empty()) all.push_back(words.number);
  return all;
}

bool IsYesNo(const msg::Query& query) {
  return query.kind != msg::QueryKind::kChoice && query.kind != msg::QueryKind::kWhatIsIt &&
         query.options.size() == 2;
}

}  // namespace beckon::ui_bridge::speech
