// Time as messages carry it, and the clocks that give it.
#pragma once

#include <cstdint>

namespace beckon {

/// Microseconds since the Unix epoch.
using Utime = int64_t;

constexpr Utime kSecond = 1'000'000;

/// Where a service gets the time from; passed in, so that tests and replays set it.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Utime Now() const = 0;
};

/// The machine's real-time clock.
class SystemClock : public Clock {
 public:
  Utime Now() const override;
};

/// Counts up from some fixed moment, whatever happens to the machine's time: for pacing, not for
/// stamps.
class SteadyClock : public Clock {
 public:
  Utime Now() const override;
};

/// The same, and counts on while the machine sleeps: for what must not be believed too long.
class BootClock : public Clock {
 public:
  Utime Now() const override;
};

/// A clock that stands where it was put.
class ManualClock : public Clock {
 public:
  explicit ManualClock(Utime now) : now_(now) {}
  Utime Now() const override { return now_; }
  void Advance(Utime by) { now_ += by; }

 private:
  Utime now_;
};

/// Monotonic stopwatch for durations that people read.
class Stopwatch {
 public:
  Stopwatch();
  double Milliseconds() const;

 private:
  int64_t start_ns_;
};

}  // namespace beckon
