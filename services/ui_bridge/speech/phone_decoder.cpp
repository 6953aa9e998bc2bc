#include "services/ui_bridge/speech/phone_decoder.h"

#include <algorithm>
#include <utility>

#include "services/ui_bridge/speech/search.h"

namespace beckon::ui_bridge::speech {
namespace {

constexpr int kFewestFrames = 10;

}  // namespace

Result<std::unique_ptr<PhoneDecoder>> PhoneDecoder::Open(const std::string& model_folder) {
  auto model = AcousticModel::Load(model_folder + "/en-us");
  if (!model) return model.error();
  auto analyser = CepstralAnalyser::Open(model_folder + "/en-us");
  if (!analyser) return analyser.error();
  return std::unique_ptr<PhoneDecoder>(new PhoneDecoder(*std::move(model), *std::move(analyser)));
}

void PhoneDecoder::SetOtherWords(const std::vector<WordTree::Word>& alone,
                                 const std::vector<WordTree::Word>& in_sentences) {
  alone_.emplace(model_, alone);
  in_sentences_.emplace(model_, in_sentences);
}

void PhoneDecoder::SetPhrases(const std::vector<Pronunciation>& phrases) {
  phrases_.clear();
  for (const auto& sounds : phrases) phrases_.push_back({sounds, model_.Word(sounds)});
  const std::set<Pronunciation> said(phrases.begin(), phrases.end());
  for (auto* tree : {&alone_, &in_sentences_}) {
    if (*tree) (*tree)->LeaveOut(said);
  }
}

Acoustics PhoneDecoder::Decode(std::span<const int16_t> samples, int begin, int end) {
  Acoustics acoustics;
  const auto sound = Observations(analyser_.Analyse(samples));
  end = std::clamp(end, 0, static_cast<int>(sound.size()));
  begin = std::clamp(begin, 0, end);
  if (end - begin < kFewestFrames) return acoustics;
  const auto scores = model_.Score(
      std::span(sound).subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin)));
  acoustics.frames = scores.frames();
  acoustics.free = FreePhones(scores, model_);
  for (const auto& phrase : phrases_)
    acoustics.phrases.push_back(Align(scores, phrase.sounds, phrase.models));
  if (alone_) acoustics.other_word = alone_->BestWord(scores);
  if (in_sentences_) acoustics.other_words = in_sentences_->BestSequence(scores);
  return acoustics;
}

}  // namespace beckon::ui_bridge::speech
