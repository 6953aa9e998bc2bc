// Keys of the terminal as switches: presses without a release.
#pragma once

#include <memory>

#include "services/base/run_loop.h"
#include "services/ui_bridge/switch/switch_source.h"

namespace beckon::ui_bridge {

/// Space is Switch::kMain, Enter is Switch::kSelect, "s" stops. Standard input; where it is a
/// terminal its line editing is off until the source is destroyed or the process exits.
std::unique_ptr<SwitchSource> MakeTerminalKeys(RunLoop& loop, SwitchListener& listener);

}  // namespace beckon::ui_bridge
