// Finds what is said in a stream of sound: stretches that are louder than a floor which follows the
// room's noise, and louder than the echo of what is being played.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "services/ui_bridge/speech/acoustics.h"

namespace beckon::ui_bridge::speech {

/// Levels of frames that follow each other, in dB below full scale (0 = a full square wave),
/// without the low frequencies (below 130 Hz) where rooms hum.
class LevelMeter {
 public:
  double Push(std::span<const int16_t> frame);

 private:
  double sample_ = 0;  // the last one, before and after the filter
  double high_ = 0;
};

/// Nothing is this quiet.
inline constexpr double kNoLevel_dB = -120;

struct SegmenterConfig {
  double onset_dB = 7;       // above the floor: something begins
  double hold_dB = 4;        // above the floor: it goes on
  double quietest_dB = -62;  // the floor is never taken to be lower
  int onset_frames = 4;      // loud ones within 8 that make a beginning
  int pause_frames = 15;     // quiet ones after which what was said may be a whole word already
  int end_frames = 38;       // quiet ones that end it
  int before_frames = 25;    // kept from before the beginning
  int shortest_frames = 8;   // loud ones; less is a click
  int longest_frames = 400;  // cut there
  int floor_frames = 200;    // the floor is the quietest moment of so many
};

struct Segment {
  int64_t begin_frame = 0;  // of the stream, where `samples` begin
  std::vector<int16_t> samples;
  /// The frames of `samples` in which it was loud, the last one not included.
  int loud_begin = 0;
  int loud_end = 0;
  bool ended = false;  // false: it may go on
  bool cut = false;    // it was too long
};

/// Takes one frame after the other; the same frames give the same segments.
class Segmenter {
 public:
  explicit Segmenter(const SegmenterConfig& config = {}) : config_(config) {}

  /// `frame` holds kSamplesPerFrame samples; `echo_dB` is how loud the echo of a prompt may be in
  /// it. Gives what was said when it has ended, and once before that at its first short pause.
  std::optional<Segment> Push(std::span<const int16_t> frame, double echo_dB = kNoLevel_dB);

  /// Something is being said now.
  bool speaking() const { return speaking_; }
  double floor_dB() const { return floor_dB_; }
  double level_dB() const { return level_dB_; }
  int64_t frames() const { return frames_; }

 private:
  void FollowFloor();
  void Begin();
  std::optional<Segment> Continue(bool loud);
  Segment Said(bool ended, bool cut) const;

  SegmenterConfig config_;
  int64_t frames_ = 0;
  LevelMeter meter_;
  double level_dB_ = kNoLevel_dB;
  double smooth_dB_ = kNoLevel_dB;
  double floor_dB_ = kNoLevel_dB;
  std::deque<double> smooth_;                // of the last floor_frames
  std::deque<bool> recent_;                  // loud or not
  std::deque<std::vector<int16_t>> before_;  // frames
  bool speaking_ = false;
  bool paused_ = false;  // the pause was reported
  int quiet_frames_ = 0;
  int loud_frames_ = 0;
  int loud_begin_ = 0;  // frames of samples_
  int loud_end_ = 0;
  int64_t begin_frame_ = 0;
  std::vector<int16_t> samples_;
};

}  // namespace beckon::ui_bridge::speech
