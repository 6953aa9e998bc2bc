#include "tools/beckon/demo_options.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "tools/beckon/demo_picture.h"

namespace beckon::tool {

bool HasFrontEnd(const DemoOptions& options, const std::string& name) {
  return std::ranges::find(options.front_ends, name) != options.front_ends.end();
}

bool OnTerminal() { return isatty(STDIN_FILENO) == 1 && isatty(STDOUT_FILENO) == 1; }

Status CompleteOptions(DemoOptions& options, const Catalogue& catalogue) {
  namespace fs = std::filesystem;
  if (options.front_ends.empty() && options.port != 0 && !OnTerminal() && !options.headless)
    options.front_ends = {"web"};  // who names the page's port wants the page
  if (options.front_ends.empty()) {
    options.headless |= !OnTerminal();
    options.front_ends = options.headless ? std::vector<std::string>{"simulated"}
                                          : std::vector<std::string>{"console", "web"};
  }
  if (options.headless) {
    for (const auto& front_end : options.front_ends) {
      if (front_end == "simulated") continue;
      return Error{"--headless answers by the simulated front end; --front-end " + front_end +
                   " needs a person"};
    }
  }
  if (options.sessions == 0 && HasFrontEnd(options, "simulated")) options.sessions = 1;
  if (!options.want.empty()) {
    if (auto want = catalogue.ParseWant(options.want); !want) return want.error();
  }
  if (!options.input.empty() && !fs::exists(options.input)) {
    return Error{"--input " + options.input + ": there is no such file or folder"};
  }
  if (!options.picture.empty()) {
    if (auto right = CheckPicturePath(options.picture); !right) return right;
  }
  if (!options.record.empty() && fs::exists(options.record)) {
    return Error{"--record " + options.record +
                 ": exists already; choose another name or remove it"};
  }
  return {};
}

}  // namespace beckon::tool
