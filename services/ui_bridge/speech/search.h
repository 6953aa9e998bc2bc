// Searches over the scores of an acoustic model (Viterbi): how a phrase is best aligned to sound,
// and which phones fit it best.
#pragma once

#include <optional>
#include <vector>

#include "services/ui_bridge/speech/acoustic_model.h"
#include "services/ui_bridge/speech/acoustics.h"

namespace beckon::ui_bridge::speech {

/// What no path reaches.
inline constexpr float kUnreachable = -1e30F;

/// The best way for `models`, those of `sounds`, to fill all frames; nothing where there are fewer
/// frames than states.
std::optional<Alignment> Align(const StateScores& scores, const Pronunciation& sounds,
                               const std::vector<PhoneModel>& models);

/// The best sequence of phones, silence and noises (as silence), each whatever is beside it.
Alignment FreePhones(const StateScores& scores, const AcousticModel& model);

}  // namespace beckon::ui_bridge::speech
