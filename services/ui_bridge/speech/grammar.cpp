#include "services/ui_bridge/speech/grammar.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace beckon::ui_bridge::speech {
namespace {

bool IsPhones(const std::string& phrase) {
  return phrase.size() > 2 && phrase.front() == '/' && phrase.back() == '/';
}

void AddRivals(Grammar& grammar, const Lexicon& lexicon, const GrammarConfig& config) {
  std::set<Pronunciation> taken;
  for (const auto& phrase : grammar.phrases) taken.insert(phrase.sounds);
  const auto add = [&](const Pronunciation& sounds) {
    if (taken.insert(sounds).second) grammar.phrases.push_back({std::nullopt, sounds});
  };
  const size_t n = grammar.phrases.size();
  for (size_t i = 0; i < n; ++i) {
    const Pronunciation sounds = grammar.phrases[i].sounds;
    for (const auto& near : lexicon.Near(sounds, config.rivals_per_phrase)) {
      for (const auto& accent : InAccents(near)) add(accent);
    }
  }
}

}  // namespace

std::vector<std::string> MissingWords(const std::vector<Command>& commands,
                                      const Lexicon& lexicon) {
  std::set<std::string> missing;
  for (const auto& command : commands) {
    for (const auto& phrase : command.phrases) {
      if (IsPhones(phrase)) continue;
      std::istringstream words(phrase);
      for (std::string word; words >> word;) {
        if (lexicon.Find(word).empty()) missing.insert(word);
      }
    }
  }
  return {missing.begin(), missing.end()};
}

Result<std::vector<Pronunciation>> Pronounce(const std::string& phrase, const Lexicon& lexicon) {
  if (!IsPhones(phrase)) return lexicon.Say(phrase);
  auto sounds = ParsePronunciation(phrase.substr(1, phrase.size() - 2));
  if (!sounds) return sounds.error();
  return std::vector<Pronunciation>{*std::move(sounds)};
}

Result<Grammar> BuildGrammar(const std::vector<Command>& commands, const Lexicon& lexicon,
                             const GrammarConfig& config) {
  Grammar grammar;
  grammar.commands = commands;
  for (size_t i = 0; i < commands.size(); ++i) {
    for (const auto& phrase : commands[i].phrases) {
      auto ways = Pronounce(phrase, lexicon);
      if (!ways) return Error{std::string(Name(commands[i].kind)) + ": " + ways.error().message};
      std::set<Pronunciation> sounds(ways->begin(), ways->end());
      for (const auto& way : *ways) {
        // What is written as phones is meant so.
        if (IsPhones(phrase)) continue;
        for (const auto& accent : InAccents(way)) sounds.insert(accent);
      }
      for (const auto& way : sounds) grammar.phrases.push_back({i, way});
    }
  }
  if (grammar.phrases.empty()) return Error{"the grammar has no phrase"};
  AddRivals(grammar, lexicon, config);
  return grammar;
}

}  // namespace beckon::ui_bridge::speech
