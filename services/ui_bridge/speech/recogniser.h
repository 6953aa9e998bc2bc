// The recogniser: commands in, sound in, probabilities of the commands out. Grammar, decoder and
// judgement in one.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "services/ui_bridge/speech/dictionary.h"
#include "services/ui_bridge/speech/espeak.h"
#include "services/ui_bridge/speech/grammar.h"
#include "services/ui_bridge/speech/judgement.h"
#include "services/ui_bridge/speech/phone_decoder.h"
#include "services/ui_bridge/speech/segmenter.h"

namespace beckon::ui_bridge::speech {

struct RecogniserConfig {
  std::string model_folder = kModelFolder;
  GrammarConfig grammar;
  /// Rivals that are said often, and as many of the commonest words alone and in sentences.
  std::vector<std::string> other_words = {"uh",   "um",    "hmm",  "oh",        "okay",
                                          "well", "hello", "what", "don't stop"};
  size_t words_alone = 20'000;
  size_t words_in_sentences = 1'500;
  JudgementModel judgement;
  EspeakConfig espeak;  // for words that the dictionary lacks
};

/// Not thread-safe; use it in one thread. Opening takes about half a second.
class Recogniser {
 public:
  static Result<std::unique_ptr<Recogniser>> Open(const RecogniserConfig& config);

  /// What may be said from now on. Words that are in no dictionary are pronounced by espeak-ng; the
  /// error names one that cannot be.
  Status Expect(const std::vector<Command>& commands);
  Heard Hear(const Segment& segment);
  /// What Hear judges; for those who fit a judgement.
  Acoustics Listen(const Segment& segment);
  Heard Weigh(const Acoustics& acoustics) const {
    return Judge(acoustics, grammar_, config_.judgement);
  }

  const Grammar& grammar() const { return grammar_; }

 private:
  void AddSpokenForms(const std::vector<Command>& commands);
  Recogniser(const RecogniserConfig& config, Lexicon lexicon, std::unique_ptr<PhoneDecoder> decoder)
      : config_(config), lexicon_(std::move(lexicon)), decoder_(std::move(decoder)) {}

  RecogniserConfig config_;
  Lexicon lexicon_;
  std::unique_ptr<PhoneDecoder> decoder_;
  Grammar grammar_;
  std::set<std::string> asked_espeak_;  // words
};

/// The model that ships, speech_model.toml.
Result<JudgementModel> LoadJudgement(const std::string& path);
std::string ToToml(const JudgementModel& model);

}  // namespace beckon::ui_bridge::speech
