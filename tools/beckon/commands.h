// The command line of `beckon`: its subcommands, their options, and what they run.
#pragma once

namespace beckon::tool {

/// The whole program; its exit code: 0 done, 1 not as it should be (said on standard error), 2 bad
/// input.
int RunBeckon(int argc, char** argv);

}  // namespace beckon::tool
