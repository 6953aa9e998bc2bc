// What every Beckon program has in common: --version --config --check-config --lcm-url --verbose,
// and exit codes: 0 done, 1 broken invariant, 2 bad input (one clear line on standard error).
#pragma once

#include <functional>
#include <string>

#include "services/base/bus.h"
#include "services/base/config.h"
#include "services/base/result.h"

namespace CLI {
class App;
}

namespace beckon {

struct AppOptions {
  std::string config_file;
  bool check_config = false;
  std::string lcm_url;  // after Parse: --lcm-url, else $LCM_DEFAULT_URL, else kDefaultLcmUrl
  std::string keys;     // after Parse: folder of keys; empty = messages are not signed
  bool verbose = false;
};

/// "0.1.0 (commit)".
const char* VersionString();

/// Adds the common options to `app`; values land in `options`.
void AddAppOptions(CLI::App& app, AppOptions& options);

/// Runs a program: parses argv with `app`, then calls `body`. Maps parse errors, a failed Status
/// and exceptions to one line on standard error and an exit code.
int RunApp(CLI::App& app, int argc, char** argv, AppOptions& options,
           const std::function<Status()>& body);

/// The bus of `options`, as `program` ("intention"). Where there are keys, what is said on it is
/// signed and what is heard checked; without them a URL by which messages leave this machine is
/// refused.
Result<std::unique_ptr<Bus>> OpenBus(const AppOptions& options, const std::string& program);

/// For CLI::Option::check: a number from `min` to `max`, which NaN is not.
std::function<std::string(const std::string&)> Within(double min, double max);

/// Loads the --config file (empty table without one).
Result<ConfigTable> LoadConfig(const AppOptions& options);

/// A file that ships with Beckon (e.g. "affordances.toml"): from $BECKON_SHARE, else beside the
/// installed program (../share/beckon, in the build tree too).
std::string SharedFile(const std::string& name);

/// A file that Beckon learns into, of this user: $XDG_DATA_HOME/beckon/NAME, else
/// ~/.local/share/beckon/NAME.
std::string DataFile(const std::string& name);

}  // namespace beckon
