// What the acoustic model says of a stretch of sound: the model's scores of each frame, once, and
// the searches that compare phrases, rival words and free phones with them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/ui_bridge/speech/acoustic_model.h"
#include "services/ui_bridge/speech/acoustics.h"
#include "services/ui_bridge/speech/cepstra.h"
#include "services/ui_bridge/speech/word_tree.h"

namespace beckon::ui_bridge::speech {

/// Not thread-safe; use it in one thread.
class PhoneDecoder {
 public:
  static Result<std::unique_ptr<PhoneDecoder>> Open(const std::string& model_folder);

  /// Rivals at any time: what may be said alone, and what sentences are made of. Takes tenths of a
  /// second.
  void SetOtherWords(const std::vector<WordTree::Word>& alone,
                     const std::vector<WordTree::Word>& in_sentences);
  /// What Decode compares sound with.
  void SetPhrases(const std::vector<Pronunciation>& phrases);
  /// `samples` at kSampleRate with some quiet around what was said, which is used for normalising;
  /// only frames `begin` .. `end` (not included) are compared, since silence fits nearly
  /// everything.
  Acoustics Decode(std::span<const int16_t> samples, int begin, int end);

 private:
  PhoneDecoder(AcousticModel model, CepstralAnalyser analyser)
      : model_(std::move(model)), analyser_(std::move(analyser)) {}

  struct Phrase {
    Pronunciation sounds;
    std::vector<PhoneModel> models;
  };
  const AcousticModel model_;
  CepstralAnalyser analyser_;
  std::optional<WordTree> alone_;
  std::optional<WordTree> in_sentences_;
  std::vector<Phrase> phrases_;
};

}  // namespace beckon::ui_bridge::speech
