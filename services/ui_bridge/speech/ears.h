// From the microphone to hearings: cuts the stream into segments, leaves out the echo of what is
// played, and hands what is said to the recogniser.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "services/base/run_loop.h"
#include "services/ui_bridge/speech/audio_source.h"
#include "services/ui_bridge/speech/echo_gate.h"
#include "services/ui_bridge/speech/listener.h"
#include "services/ui_bridge/speech/segmenter.h"

namespace beckon::ui_bridge::speech {

struct EarsConfig {
  AudioSourceConfig source;
  SegmenterConfig segmenter;
  EchoConfig echo;
  RecogniserConfig recogniser;
};

class Ears {
 public:
  struct Callbacks {
    /// Somebody begins to speak.
    std::function<void()> speaking;
    std::function<void(const Hearing&)> heard;
    /// The microphone came or went; `reason` for the latter.
    std::function<void(bool running, const std::string& reason)> microphone;
    std::function<void(const std::string&)> failed;
  };

  Ears(const EarsConfig& config, RunLoop& loop, Callbacks callbacks);

  void Start() { source_.Start(); }
  /// What may be said from now on; hearings of what began before now carry an earlier tag.
  void Expect(std::vector<Command> commands, int64_t tag) {
    listener_.Expect(std::move(commands), tag);
    expected_since_ = segmenter_.frames();
  }
  /// Whether it began to be said before the commands were changed the last time.
  bool IsOld(const Hearing& hearing) const { return hearing.begin_frame < expected_since_; }

  /// A prompt begins to play, or has ended.
  void PromptBegins(const std::vector<int16_t>& samples) {
    gate_.Start(Levels_dB(samples), segmenter_.frames());
  }
  void PromptEnds() { gate_.Stop(segmenter_.frames()); }

  bool speaking() const { return segmenter_.speaking(); }
  bool running() const { return source_.running(); }
  int64_t segments() const { return segments_; }
  int64_t dropped() const { return listener_.dropped(); }

 private:
  void Take(std::span<const int16_t> samples);
  void TakeFrame(std::span<const int16_t> frame);

  const Callbacks callbacks_;
  Segmenter segmenter_;
  EchoGate gate_;
  std::vector<int16_t> rest_;  // less than a frame
  int64_t expected_since_ = 0;
  int64_t segments_ = 0;
  Listener listener_;
  AudioSource source_;
};

}  // namespace beckon::ui_bridge::speech
