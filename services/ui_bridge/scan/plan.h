// What a scan offers, in which order and groups, and how long it takes to choose each: the exact
// time that the machine of scanner.h needs with a user who always presses as late as Config says.
//
// Binary groups are the optimal alphabetic tree (Gilbert & Moore 1959, "Variable-length binary
// encodings") with unequal costs of the two branches: to wait for the second half takes a scan
// step.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/ui_bridge/scan/config.h"

namespace beckon::ui_bridge::scan {

/// What can be chosen besides a question's options.
enum class Control { kUndo, kNone, kPause, kStop, kResume, kStay, kStart };

/// As in msg::Highlight: "undo", "none", "pause", "stop", "resume", "stay", "start".
const char* Name(Control control);

/// What is to be chosen from.
struct Page {
  int64_t id = 0;                     // told with what is chosen from it
  int n_options = 0;                  // 0 .. 64
  std::vector<double> probabilities;  // one an option, any scale; else all are taken as equal
  bool none_last = false;             // the last option says "none of these": it stays the last
  std::vector<Control> controls;      // after the options, in this order; one group where several
};

struct Entry {
  enum class Kind { kOption, kControl, kGroup, kBack };
  Kind kind = Kind::kOption;
  int option = -1;                   // of kOption
  Control control = Control::kUndo;  // of kControl
  int level = -1;                    // that kGroup opens
};

struct Level {
  int parent = -1;  // none: the outermost
  std::vector<Entry> entries;
};

/// levels[0] is scanned first; empty where there is nothing to choose.
struct Plan {
  std::vector<Level> levels;
  bool empty() const { return levels.empty(); }
};

Plan MakePlan(const Config& config, const Page& page);

/// What an entry stands for, or leads to.
std::vector<int> OptionsOf(const Plan& plan, const Entry& entry);
std::vector<Control> ControlsOf(const Plan& plan, const Entry& entry);

/// From the page being shown until `option` (or `control`) is chosen, without a mistake; nothing
/// where it is not on offer. Exact for a user who sees the page at once, presses Reaction_us after
/// what they want is lit (or as soon as presses count again), holds for `press_us` or as long as
/// it takes to count, and reacts within the scan time.
std::optional<Utime> TimeToOption(const Plan& plan, const Config& config, int option);
std::optional<Utime> TimeToControl(const Plan& plan, const Config& config, Control control);

/// Mean of TimeToOption over the page's probabilities, s. 0 for a page without options.
double ExpectedSeconds(const Plan& plan, const Config& config, const Page& page);

/// Longest time from the beginning of a press to the stop that it becomes; 0 where holding does not
/// stop. `stop_hold_us`, and for Method::kInverse one pass before it, where the hold scans.
Utime StopWithin_us(const Plan& plan, const Config& config);

}  // namespace beckon::ui_bridge::scan
