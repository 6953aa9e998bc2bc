// How far long work is, for the person who waits for it.
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace beckon {

/// One line a step where the output is no terminal; on a terminal a line that is redrawn, with
/// percentage and time left. Ends what it watches when `stopped` (may be empty) says so.
class Progress {
 public:
  Progress(bool terminal, std::function<bool()> stopped);
  ~Progress() { EndLine(); }
  /// A step's state; its first mention begins it. False: stop.
  bool Tell(const std::string& step, size_t done, size_t total);
  /// A line by itself.
  void Say(const std::string& text);
  bool stopped() const { return stopped_ && stopped_(); }

 private:
  using Clock = std::chrono::steady_clock;

  void EndLine();

  const bool terminal_;
  const std::function<bool()> stopped_;
  std::string step_;
  Clock::time_point began_, told_;
  bool line_open_ = false;
};

/// "training 45 %, 0:32 left"; without the time where nothing is known yet.
std::string ProgressText(const std::string& step, size_t done, size_t total, double seconds);

}  // namespace beckon
