// PocketSphinx with its English model, used for what it does well: log-likelihoods of phones. Its
// own hypothesis is not used, since it has no idea that something else may have been said.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "services/ui_bridge/speech/acoustics.h"
#include "services/ui_bridge/speech/lexicon.h"

namespace beckon::ui_bridge::speech {

/// Where Debian's pocketsphinx-en-us puts its model.
inline constexpr char kModelFolder[] = "/usr/share/pocketsphinx/model/en-us";

/// The dictionary beside the model; other sounds and pronunciations that are too long are left out.
Result<Lexicon> LoadLexicon(const std::string& model_folder);

/// The `n` most frequent words of the language model beside it that the lexicon knows, with two
/// phones or more.
Result<std::vector<std::string>> FrequentWords(const std::string& model_folder,
                                               const Lexicon& lexicon, size_t n);

/// Not thread-safe; use it in one thread.
class PhoneDecoder {
 public:
  static Result<std::unique_ptr<PhoneDecoder>> Open(const std::string& model_folder);
  ~PhoneDecoder();

  /// What Decode compares sound with:
  /// and, as Acoustics::other_words, any sequence of `words`.
  Status SetPhrases(const std::vector<Pronunciation>& phrases,
                    const std::vector<Pronunciation>& words);
  /// All phrases are aligned in one pass, a second one finds the free phones. Takes about a tenth
  /// of the sound's duration. `samples` at kSampleRate with some quiet around what was said, which
  /// is used for normalising; only frames `begin` .. `end` (not included) are compared, since
  /// silence fits nearly everything.
  Acoustics Decode(std::span<const int16_t> samples, int begin, int end);

 private:
  struct State;
  explicit PhoneDecoder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace beckon::ui_bridge::speech
