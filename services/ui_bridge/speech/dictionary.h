// Words as PocketSphinx's English model knows them: how they are pronounced, how often they are
// said.
#pragma once

#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/ui_bridge/speech/lexicon.h"

namespace beckon::ui_bridge::speech {

/// Where Debian's pocketsphinx-en-us puts its model.
inline constexpr char kModelFolder[] = "/usr/share/pocketsphinx/model/en-us";

/// The dictionary beside the model; other sounds and pronunciations that are too long are left out.
Result<Lexicon> LoadLexicon(const std::string& model_folder);

struct FrequentWord {
  std::string word;
  double log_probability = 0;  // natural
};

/// Words of the language model beside it that the lexicon knows, the commonest first.
Result<std::vector<FrequentWord>> FrequentWords(const std::string& model_folder,
                                                const Lexicon& lexicon);

}  // namespace beckon::ui_bridge::speech
