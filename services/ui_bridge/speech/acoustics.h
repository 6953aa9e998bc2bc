// What the acoustic model says of a stretch of sound: how well each phrase fits it, and how well
// any sequence of phones does.
#pragma once

#include <optional>
#include <vector>

#include "services/ui_bridge/speech/phones.h"

namespace beckon::ui_bridge::speech {

inline constexpr int kSampleRate = 16'000;  // Hz, of all sound here: 16 bit, one channel
inline constexpr int kFramesPerSecond = 100;
inline constexpr int kSamplesPerFrame = kSampleRate / kFramesPerSecond;

/// Frames `begin` .. `end` (not included) spent in a phone or in kSilence.
struct Span {
  Phone phone = kSilence;
  int begin = 0;
  int end = 0;
  double score = 0;  // log-likelihood in nats, up to a constant of each frame
};

using Alignment = std::vector<Span>;

struct Acoustics {
  int frames = 0;
  /// The best sequence of phones, whatever it is.
  Alignment free;
  /// Scores of the best word that is no phrase of the grammar, and of the best sequence of such.
  std::optional<double> other_word;
  std::optional<double> other_words;
  /// For each phrase of the grammar the best way to align it; nothing where it is too long.
  std::vector<std::optional<Alignment>> phrases;
};

}  // namespace beckon::ui_bridge::speech
