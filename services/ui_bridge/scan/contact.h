// One switch as its contacts tell it: bounce removed, presses stamped with the moment at which they
// really began and ended.
#pragma once

#include <optional>

#include "services/base/utime.h"

namespace beckon::ui_bridge::scan {

/// A level that has stood for the debounce time is believed; its stamp is the first edge of the
/// burst that led to it. What is shorter, in either direction, never happened.
class Contact {
 public:
  explicit Contact(Utime debounce_us) : debounce_us_(debounce_us) {}

  struct Change {
    bool down;
    Utime at;
  };

  /// What the contacts say. Call Settle(now) before; `now` never goes back.
  void OnEdge(Utime now, bool raw_down);
  /// The change that has become believable, if any.
  std::optional<Change> Settle(Utime now);
  /// When to call Settle.
  std::optional<Utime> NextDeadline() const;
  void SetDebounce(Utime debounce_us) { debounce_us_ = debounce_us; }
  /// It is open, whatever was said: its device went.
  void Reset();

  bool down() const { return down_; }
  /// The contacts say so, believed or not.
  bool raw_down() const { return raw_; }
  /// For how long it has been held, up to `now`, or to what may be its release. 0 while it is up.
  Utime Held_us(Utime now) const;

 private:
  Utime debounce_us_;
  bool down_ = false;
  bool raw_ = false;
  Utime pressed_at_ = 0;
  Utime burst_at_ = 0;                 // first edge of the latest burst
  std::optional<Utime> last_edge_at_;  // of any
};

}  // namespace beckon::ui_bridge::scan
