// Reads questions.en.toml and its translations.
#pragma once

#include <string>

#include "services/intention/core/phrases.h"

namespace beckon::intention {

/// Every key of questions.en.toml must be there and no other. Fails with the file's name, the key
/// and what was expected of it: a missing or unknown key, an unknown or unused {placeholder}.
Result<Phrases> ReadPhrases(const std::string& path);
/// The same from text; `name` stands for the file in messages.
Result<Phrases> ParsePhrases(const std::string& text, const std::string& name);

}  // namespace beckon::intention
