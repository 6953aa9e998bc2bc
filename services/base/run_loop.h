// One thread's event loop: file descriptors, timers, signals, and work posted by other threads.
#pragma once

#include <functional>
#include <memory>

#include "services/base/utime.h"

namespace beckon {

/// epoll with timers. All callbacks run in the thread that calls Run; only Post and Stop may be
/// called from others. With `handle_signals` it is the whole process's: SIGINT and SIGTERM stop it,
/// and systemd is told that it runs, turns, stops. Construct that one before starting threads: the
/// signals are blocked for all of them.
class RunLoop {
 public:
  using Callback = std::function<void()>;
  using TimerId = uint64_t;

  explicit RunLoop(bool handle_signals = false);
  ~RunLoop();
  RunLoop(const RunLoop&) = delete;
  RunLoop& operator=(const RunLoop&) = delete;

  /// Calls `readable` whenever `fd` can be read.
  void AddFd(int fd, Callback readable);
  void RemoveFd(int fd);

  /// Calls back once after `delay_us`, or repeatedly every `period_us` (>= 1).
  TimerId After(Utime delay_us, Callback callback);
  TimerId Every(Utime period_us, Callback callback);
  void Cancel(TimerId timer);

  /// Runs `work` in the loop's thread soon.
  void Post(Callback work);

  void Run();
  void Stop();
  /// Whether a signal ended Run.
  bool interrupted() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beckon
