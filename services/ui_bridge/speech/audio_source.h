// Sound as it comes in: from a program's standard output (arecord), or a file or FIFO. What ends or
// is missing is tried again, ever less often: a microphone may be plugged in again.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/base/run_loop.h"
#include "services/ui_bridge/child.h"

namespace beckon::ui_bridge::speech {

struct AudioSourceConfig {
  /// Writes 16 bit little-endian samples of one channel at 16 kHz.
  std::vector<std::string> command = {"arecord", "-q", "-t",    "raw", "-f",
                                      "S16_LE",  "-r", "16000", "-c",  "1"};
  /// The same from a file, read as fast as it was recorded, or a FIFO; instead of `command`.
  std::string input;
  double retry_s = 1;  // before the first new try; doubled each time
  double retry_most_s = 30;
};

class AudioSource {
 public:
  struct Callbacks {
    std::function<void(std::span<const int16_t>)> samples;
    /// It runs, or `reason` says why it does not. Called when that changes.
    std::function<void(bool running, const std::string& reason)> state;
  };

  /// Both outlive it. All callbacks in the loop's thread.
  AudioSource(AudioSourceConfig config, RunLoop& loop, Callbacks callbacks);
  ~AudioSource();

  void Start();
  bool running() const { return running_; }
  /// How often it ended or could not be opened.
  int64_t failures() const { return failures_; }

 private:
  void Open();
  bool OpenInput(std::string& reason);
  void Read();
  void ReadFile();
  void Take(std::span<const uint8_t> bytes);
  void Fail(const std::string& reason);
  void CloseAll();

  const AudioSourceConfig config_;
  RunLoop& loop_;
  const Callbacks callbacks_;
  std::optional<Child> child_;
  int fd_ = -1;          // that is read
  bool own_fd_ = false;  // of the input, not of the child
  bool watched_ = false;
  std::optional<RunLoop::TimerId> timer_;  // of a file, or of the next try
  std::optional<uint8_t> odd_;             // first half of a sample
  double wait_s_ = 0;
  bool running_ = false;
  bool told_ = false;  // that it does not run
  int64_t failures_ = 0;
};

}  // namespace beckon::ui_bridge::speech
