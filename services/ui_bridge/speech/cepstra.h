// Mel cepstra of sound, as the acoustic model knows them: by SphinxBase's front end, with the
// settings that stand beside the model (feat.params).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/ui_bridge/speech/acoustic_model.h"

namespace beckon::ui_bridge::speech {

class CepstralAnalyser {
 public:
  static Result<CepstralAnalyser> Open(const std::string& acoustic_folder);

  /// One for each kSamplesPerFrame samples, minus their mean: what the microphone and the room add
  /// to all frames. Quiet before and after what was said belongs into that mean.
  std::vector<Cepstrum> Analyse(std::span<const int16_t> samples);

 private:
  struct State;
  struct Close {
    void operator()(State* state) const;
  };
  explicit CepstralAnalyser(State* state) : state_(state) {}
  std::unique_ptr<State, Close> state_;
};

}  // namespace beckon::ui_bridge::speech
