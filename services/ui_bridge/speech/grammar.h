// What the recogniser compares sound with: the phrases of the commands, and rivals, which mean
// nothing and stand for what else people say that sounds similar.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/ui_bridge/speech/commands.h"
#include "services/ui_bridge/speech/lexicon.h"

namespace beckon::ui_bridge::speech {

struct Phrase {
  std::optional<size_t> command;  // index into Grammar::commands; nothing for a rival
  Pronunciation sounds;
};

struct Grammar {
  std::vector<Command> commands;
  std::vector<Phrase> phrases;
};

struct GrammarConfig {
  size_t rivals_per_phrase = 12;  // words of the dictionary that sound nearly like it
};

/// Words of the commands that the lexicon lacks.
std::vector<std::string> MissingWords(const std::vector<Command>& commands, const Lexicon& lexicon);

/// The error names the command and the word or sound that is wrong.
Result<Grammar> BuildGrammar(const std::vector<Command>& commands, const Lexicon& lexicon,
                             const GrammarConfig& config);

/// A phrase of Command::phrases: words, or phones between slashes.
Result<std::vector<Pronunciation>> Pronounce(const std::string& phrase, const Lexicon& lexicon);

}  // namespace beckon::ui_bridge::speech
