// How long to wait before a process that died is started again.
#pragma once

#include <algorithm>

#include "services/base/utime.h"

namespace beckon::tool {

/// Doubles from `first_us` to `longest_us`, and begins anew after a life of `healthy_us`.
class BackOff {
 public:
  static constexpr Utime kFirst_us = 200'000;
  static constexpr Utime kLongest_us = 5 * kSecond;
  static constexpr Utime kHealthy_us = 10 * kSecond;

  /// For a process that lived `alive_us`.
  Utime Next(Utime alive_us) {
    if (alive_us >= kHealthy_us) deaths_ = 0;
    Utime delay_us = kFirst_us;
    for (int i = 0; i < deaths_ && delay_us < kLongest_us; ++i) delay_us *= 2;
    ++deaths_;
    return std::min(delay_us, kLongest_us);
  }

  /// In a row, without a healthy life between.
  int deaths() const { return deaths_; }

 private:
  int deaths_ = 0;
};

}  // namespace beckon::tool
