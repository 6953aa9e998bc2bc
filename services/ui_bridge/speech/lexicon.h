// How words are pronounced: a dictionary in memory, and what sounds nearly like a given word.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "services/ui_bridge/speech/phones.h"

namespace beckon::ui_bridge::speech {

/// Words in lower case. Not thread-safe while it is being filled.
class Lexicon {
 public:
  void Add(const std::string& word, const Pronunciation& pronunciation);
  /// All ways to say a word; empty where it is not known.
  const std::vector<Pronunciation>& Find(const std::string& word) const;
  /// All ways to say several words one after the other, at most `max`. The error names the word
  /// that is missing.
  Result<std::vector<Pronunciation>> Say(const std::string& words, size_t max = 8) const;
  /// Pronunciations of the dictionary that are near to, but not the same as, `pronunciation`: at
  /// most one phone apart (Distance), nearest first, at most `max`.
  std::vector<Pronunciation> Near(const Pronunciation& pronunciation, size_t max) const;
  size_t size() const { return words_.size(); }

 private:
  std::unordered_map<std::string, std::vector<Pronunciation>> words_;
  std::vector<std::vector<Pronunciation>> by_length_;  // short ones, for Near
};

/// Lower case, letters, digits and apostrophes only, one blank between words: "Open the carton?"
/// becomes "open the carton", "SprayCan" "spray can", "3" "three" up to twelve.
std::string Normalised(const std::string& text);

}  // namespace beckon::ui_bridge::speech
