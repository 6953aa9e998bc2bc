// How a scan goes: method, grouping, times. Pure values; scanner.h runs them, plan.h reckons with
// them.
#pragma once

#include <cstdint>

#include "services/base/result.h"
#include "services/base/utime.h"

namespace beckon::ui_bridge::scan {

/// What moves the pointer, and what chooses.
enum class Method {
  kAutomatic,  // time moves it, a press chooses
  kStep,       // a press moves it; StepSelect says what chooses
  kInverse     // it moves while the switch is held, letting go chooses
};

enum class StepSelect {
  kSecondSwitch,  // Switch::kSelect
  kDwell,         // resting on it; nothing is lit before the first press, so nothing is chosen by
                  // who does nothing
  kLongPress      // a press of at least `long_press_us`
};

enum class Grouping {
  kLinear,     // one item after the other
  kRowColumn,  // first a row, then an item of it
  kBinary      // halves of halves, cut so that the expected time is least
};

/// How to leave a group that was opened by mistake.
enum class Back {
  kPass,  // let it pass `group_passes` times (stepping or holding: go past its last item)
  kEntry  // the same, and "back" as its last item
};

enum class Accept {
  kRelease,  // a press counts when it ends; one that is held for a stop chooses nothing
  kPress     // a press counts once it was held for `hold_us`; a stop comes after the choice
};

/// What leads out of a stop: always deliberate.
enum class ResumeBy {
  kTwice,  // "resume" is chosen, and again, in another place
  kHold    // a press of `resume_hold_us`; who holds again to be sure of the stop resumes
};

enum class Order {
  kLikeliest,  // the likeliest option first; the one that says "none of these" last
  kGiven
};

/// Every time is in microseconds.
struct Config {
  Method method = Method::kAutomatic;
  StepSelect step_select = StepSelect::kSecondSwitch;
  Grouping grouping = Grouping::kLinear;
  Order order = Order::kLikeliest;
  Back back = Back::kPass;
  Accept accept = Accept::kRelease;
  ResumeBy resume_by = ResumeBy::kTwice;

  Utime scan_us = 1'500'000;         // an item is lit; 50 ms .. 60 s
  Utime first_us = 800'000;          // more for the first item of a page or group; 0 .. 60 s
  Utime hold_us = 0;                 // a shorter press does not count; 0 .. 10 s
  Utime ignore_repeat_us = 300'000;  // nor does one that begins sooner after the last one ended
  Utime debounce_us = 5'000;         // contacts bounce for less than this; 0 .. 1 s
  Utime guard_us =
      150'000;  // a press sooner after a new page was meant for the one before; 0 .. 5 s
  Utime dwell_us = 1'500'000;     // of StepSelect::kDwell; 50 ms .. 60 s
  Utime long_press_us = 700'000;  // of StepSelect::kLongPress; 50 ms .. 10 s
  Utime stop_hold_us =
      2'000'000;  // a press of this length is a stop; 0 = none; else 200 ms .. 60 s
  Utime resume_hold_us = 2'000'000;  // of ResumeBy::kHold; 200 ms .. 60 s
  int rounds = 3;                    // passes without a press, then it rests; 0 = never; .. 100
  int group_passes = 2;              // of Back; 1 .. 100
  int columns = 0;                   // of kRowColumn; 0 = as many as make it quickest; .. 64
  double control_share = 0.05;       // how often a control is meant, for kBinary; 0 .. 1

  Utime reaction_us = 0;     // this user's, from lit to press; 0 = 0.65 of `scan_us` (reaction.h)
  Utime press_us = 200'000;  // how long this user's presses last
};

/// Ranges as above, and that no length of press means two things: hold < long press < stop.
Status Validate(const Config& config);

/// `reaction_us`, or the share of the scan time that it has by the 0.65 rule.
Utime Reaction_us(const Config& config);

}  // namespace beckon::ui_bridge::scan
