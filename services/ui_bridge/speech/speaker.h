// Speaks prompts: espeak-ng makes the sound, a play command plays it. A new prompt, and Hush, end
// the one that is played at once.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/base/latest_worker.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/child.h"
#include "services/ui_bridge/speech/espeak.h"

namespace beckon::ui_bridge::speech {

struct SpeakerConfig {
  EspeakConfig espeak;
  /// Gets a WAV file as its standard input. Empty: nothing is played, prompts are silent.
  std::vector<std::string> play = {"aplay", "-q", "-t", "wav", "-"};
};

class Speaker {
 public:
  struct Callbacks {
    /// A prompt begins to play; its sound at kSampleRate.
    std::function<void(const std::vector<int16_t>&)> begun;
    /// It is over; false where it was ended before its time.
    std::function<void(bool whole)> over;
    /// Why it could not be spoken; called once for each reason in a row.
    std::function<void(const std::string&)> failed;
  };

  /// All outlive it; callbacks in the loop's thread.
  Speaker(SpeakerConfig config, RunLoop& loop, Callbacks callbacks);
  ~Speaker();

  void Say(const std::string& text);
  void Hush();
  /// A prompt is being made or played.
  bool busy() const { return making_ || child_.has_value(); }
  bool playing() const { return child_.has_value(); }

 private:
  struct Request {
    int64_t number;
    std::string text;
  };
  void Make(const Request& request);
  void Play(int64_t number, const Result<Wave>& wave, const std::vector<int16_t>& samples);
  void CheckEnd();
  void End(bool whole);
  void Fail(const std::string& reason);

  const SpeakerConfig config_;
  RunLoop& loop_;
  const Callbacks callbacks_;
  int64_t number_ = 0;  // of the newest prompt
  bool making_ = false;
  std::optional<Child> child_;
  bool watched_ = false;
  std::optional<RunLoop::TimerId> poll_;  // where the kernel has no pidfd
  std::string failure_;
  std::shared_ptr<Speaker*> self_;  // null once it is gone: posted work may come later
  std::unique_ptr<LatestWorker<Request>> worker_;
};

}  // namespace beckon::ui_bridge::speech
