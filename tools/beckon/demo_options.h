// What `beckon demo` was asked for, made complete.
#pragma once

#include <string>

#include "services/base/result.h"
#include "tools/beckon/catalogue.h"
#include "tools/beckon/demo.h"

namespace beckon::tool {

/// Fills in what was left open and refuses what cannot be.
Status CompleteOptions(DemoOptions& options, const Catalogue& catalogue);

bool HasFrontEnd(const DemoOptions& options, const std::string& name);

/// Whether a person sits at this program's terminal.
bool OnTerminal();

}  // namespace beckon::tool
