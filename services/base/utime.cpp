#include "services/base/utime.h"

#include <chrono>
#include <ctime>

namespace beckon {
namespace {

int64_t MonotonicNanoseconds() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

Utime SystemClock::Now() const {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

Utime SteadyClock::Now() const { return MonotonicNanoseconds() / 1000; }

Utime BootClock::Now() const {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return Utime{now.tv_sec} * kSecond + now.tv_nsec / 1000;
}

Stopwatch::Stopwatch() : start_ns_(MonotonicNanoseconds()) {}

double Stopwatch::Milliseconds() const {
  return static_cast<double>(MonotonicNanoseconds() - start_ns_) * 1e-6;
}

}  // namespace beckon
