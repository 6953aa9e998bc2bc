#include "services/ui_bridge/speech/recogniser.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <utility>

#include "services/base/config.h"
#include "services/ui_bridge/speech/sound.h"

namespace beckon::ui_bridge::speech {
namespace {

constexpr int kMargin = 2;        // frames around what is loud: soft beginnings and ends
constexpr double kOftenSaid = 4;  // cost of a word, nats

double Cost(const FrequentWord& word) { return 2 - 0.5 * word.log_probability; }

}  // namespace

Result<std::unique_ptr<Recogniser>> Recogniser::Open(const RecogniserConfig& config) {
  auto lexicon = LoadLexicon(config.model_folder);
  if (!lexicon) return lexicon.error();
  auto decoder = PhoneDecoder::Open(config.model_folder);
  if (!decoder) return decoder.error();
  auto frequent = FrequentWords(config.model_folder, *lexicon);
  if (!frequent) return frequent.error();
  std::vector<WordTree::Word> words;
  const auto add = [&](const std::string& word, double cost) {
    const auto said = lexicon->Say(word);
    if (!said) return;
    for (const auto& sounds : *said) {
      for (const auto& accent : InAccents(sounds)) words.push_back({accent, cost});
    }
  };
  for (const auto& word : config.other_words) add(word, kOftenSaid);
  for (size_t i = 0; i < std::min(config.words_in_sentences, frequent->size()); ++i)
    add((*frequent)[i].word, Cost((*frequent)[i]));
  const auto in_sentences = words;
  for (size_t i = config.words_in_sentences; i < std::min(config.words_alone, frequent->size());
       ++i)
    add((*frequent)[i].word, Cost((*frequent)[i]));
  (*decoder)->SetOtherWords(words, in_sentences);
  return std::unique_ptr<Recogniser>(
      new Recogniser(config, *std::move(lexicon), *std::move(decoder)));
}

Status Recogniser::Expect(const std::vector<Command>& commands) {
  for (const auto& word : MissingWords(commands, lexicon_)) {
    auto sounds = PronounceByEspeak(config_.espeak, word);
    if (!sounds)
      return Error{"'" + word + "' is in no dictionary, and " + sounds.error().message +
                   "; give it as phones, e.g. \"/Y EH S/\""};
    lexicon_.Add(word, *sounds);
  }
  AddSpokenForms(commands);
  auto grammar = BuildGrammar(commands, lexicon_, config_.grammar);
  if (!grammar) return grammar.error();
  std::vector<Pronunciation> phrases;
  for (const auto& phrase : grammar->phrases) phrases.push_back(phrase.sounds);
  decoder_->SetPhrases(phrases);
  grammar_ = *std::move(grammar);
  return {};
}

/// espeak-ng knows ways to say a word that the dictionary does not list ("near-ist").
void Recogniser::AddSpokenForms(const std::vector<Command>& commands) {
  for (const auto& command : commands) {
    for (const auto& phrase : command.phrases) {
      if (phrase.starts_with('/')) continue;
      std::istringstream words(phrase);
      for (std::string word; words >> word;) {
        if (!asked_espeak_.insert(word).second) continue;
        for (const char* accent : {"en-us", "en-gb"}) {
          if (const auto sounds = PronounceByEspeak(config_.espeak, word, accent))
            lexicon_.Add(word, *sounds);
        }
      }
    }
  }
}

Acoustics Recogniser::Listen(const Segment& segment) {
  return decoder_->Decode(Levelled(segment.samples), segment.loud_begin - kMargin,
                          segment.loud_end + kMargin);
}

Heard Recogniser::Hear(const Segment& segment) { return Weigh(Listen(segment)); }

Result<JudgementModel> LoadJudgement(const std::string& path) {
  auto table = ConfigTable::Load(path);
  if (!table) return table.error();
  JudgementModel model;
  table->Get("bias", model.bias, -1000, 1000);
  ConfigTable weights = table->Section("weights");
  for (size_t i = 0; i < kFeatures; ++i)
    weights.Get(kFeatureNames[i], model.weights[i], -1000, 1000);
  if (auto right = table->Finish(); !right) return right.error();
  return model;
}

std::string ToToml(const JudgementModel& model) {
  char line[96];
  std::string text =
      "# How phrases are told from what else is said (services/ui_bridge/speech/judgement.h): "
      "log-odds,\n"
      "# linear in what is measured. Made by `beckon-speech-judge --learn FILE`; see\n"
      "# docs/experiments/speech.\n";
  std::snprintf(line, sizeof line, "bias = %.5f\n\n[weights]\n", model.bias);
  text += line;
  for (size_t i = 0; i < kFeatures; ++i) {
    std::snprintf(line, sizeof line, "%s = %.5f\n", kFeatureNames[i], model.weights[i]);
    text += line;
  }
  return text;
}

}  // namespace beckon::ui_bridge::speech
