// The keys of a configuration file that say how a scan goes; the same in every front end that
// scans.
#pragma once

#include "services/base/config.h"
#include "services/ui_bridge/scan/config.h"

namespace beckon::ui_bridge::scan {

/// Reads them over `config`: method, select, grouping, order, back, accept, resume, scan_time,
/// first_delay, hold_time, ignore_repeat, debounce, guard_time, dwell_time, long_press, stop_hold,
/// resume_hold, rounds, group_passes, columns, control_share, reaction_time, press_time (times in
/// s). What is wrong, or does not go together, is told by the table's Finish.
void ReadScanConfig(ConfigTable table, Config& config);

}  // namespace beckon::ui_bridge::scan
