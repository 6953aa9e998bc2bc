// Command-line options that describe a front end.
#pragma once

#include "services/intention/core/interface.h"

namespace CLI {
class App;
}

namespace beckon::intention {

/// Declares --interface, --max-options, --seconds-per-question and --seconds-per-option; values
/// land in `interface`, which must outlive `command`.
void AddInterfaceOptions(CLI::App& command, Interface& interface);

}  // namespace beckon::intention
