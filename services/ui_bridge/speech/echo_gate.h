// How loud a prompt that is being played may be in the microphone, so that the recogniser does not
// answer it. It knows what is played and since when; how much of it arrives, and how late, it
// learns by comparing the levels of the two (medians, so that a user who talks over it does not
// matter).
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "services/ui_bridge/speech/acoustics.h"

namespace beckon::ui_bridge::speech {

struct EchoConfig {
  double margin_dB = 7;     // louder than the expected echo by so much is no echo
  double tail_dB = 1.5;     // by which an echo fades each frame once its sound is over
  int most_delay = 50;      // frames, between playing and hearing
  int fewest_frames = 40;   // loud ones, to learn from; until then nothing stands out
  int learnt_frames = 120;  // the latest ones that are learnt from
  double loud_dB = 25;      // below the loudest of the prompt: what is softer teaches nothing
};

/// The LevelMeter's levels of each frame of sound at kSampleRate.
std::vector<double> Levels_dB(const std::vector<int16_t>& samples);

class EchoGate {
 public:
  explicit EchoGate(const EchoConfig& config = {}) : config_(config) {}

  /// A prompt of these levels begins to play at the microphone's frame `now`.
  void Start(std::vector<double> levels_dB, int64_t now);
  /// It was ended before its time.
  void Stop(int64_t now);
  /// What may be echo in frame `now`: speech has to be louder. kNoLevel_dB where none is expected,
  /// a level that nothing exceeds as long as nothing is learnt.
  double Expected_dB(int64_t now) const;
  /// The microphone's level in that frame. Once a frame, in order.
  void Observe(int64_t now, double level_dB, double floor_dB);

  /// A prompt is being played, or may still be heard.
  bool Playing(int64_t now) const;
  /// From the prompt's level to the microphone's, and frames between them, once they are known.
  std::optional<double> gain_dB() const { return gain_dB_; }
  int delay() const { return delay_; }

 private:
  void Learn();

  EchoConfig config_;
  std::vector<double> reference_dB_;
  double loudest_dB_ = 0;
  int64_t start_ = 0;
  int64_t end_ = 0;  // of what is played
  bool started_ = false;
  struct Pair {
    int64_t index;  // frames since the prompt's start
    double level_dB;
  };
  std::deque<Pair> heard_;  // of this prompt
  int since_learning_ = 0;
  std::optional<double> gain_dB_;
  double spread_dB_ = 6;
  int delay_ = 0;
};

}  // namespace beckon::ui_bridge::speech
