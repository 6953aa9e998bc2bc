// How long one choice takes on one level of a scan: the formula behind plan.h's times.
#pragma once

#include "services/ui_bridge/scan/config.h"

namespace beckon::ui_bridge::scan {

/// `entry` counts from 0; `depth` is 0 on the outermost level, whose time begins with the page.
class Pace {
 public:
  explicit Pace(const Config& config) : config_(config) {}

  /// Until the entry is opened and the switch is free again.
  Utime Choose_us(int entry, int depth) const;
  /// Until the entry is chosen.
  Utime ChooseLast_us(int entry, int depth) const;

 private:
  /// From the beginning of a level, or from the switch being free, to a press that counts again.
  Utime Gap_us(Utime wanted, int depth) const;
  /// From the beginning of a press until it is over.
  Utime Press_us() const;
  /// From the beginning of a press until it counts.
  Utime Accept_us() const;
  /// The pointer's way to an entry.
  Utime Waited_us(int entry) const;
  Utime Moves_us(int presses, int depth) const;
  Utime Step_us(int entry, int depth, bool last) const;
  Utime Inverse_us(int entry, int depth) const;

  const Config& config_;
};

}  // namespace beckon::ui_bridge::scan
