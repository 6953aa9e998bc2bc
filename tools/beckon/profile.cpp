#include "tools/beckon/profile.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "services/base/app.h"
#include "services/base/config.h"
#include "services/base/run_loop.h"
#include "tools/beckon/fleet.h"
#include "tools/beckon/run_folder.h"
#include "tools/beckon/supervisor.h"

namespace beckon::tool {
namespace {

namespace fs = std::filesystem;

std::string StateFolder() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && *state != '\0') return std::string(state) + "/beckon";
  const char* home = std::getenv("HOME");
  if (home != nullptr && *home != '\0') return std::string(home) + "/.local/state/beckon";
  return {};
}

std::string FindProgram(const std::string& program) {
  const std::string beside = OwnBinDir() + "/" + program;
  return program.find('/') == std::string::npos && fs::exists(beside) ? beside : program;
}

std::string FindProfile(const std::string& path) {
  if (fs::is_regular_file(path)) return path;
  const std::string shipped = SharedFile("profiles/" + path + ".toml");
  return fs::exists(shipped) ? shipped : path;
}

}  // namespace

Result<Profile> LoadProfile(const std::string& path) {
  auto table = ConfigTable::Load(FindProfile(path));
  if (!table) return table.error();
  Profile profile;
  table->Get("lcm_url", profile.lcm_url);
  table->Get("logs", profile.logs);
  auto processes = table->Section("process");
  for (const auto& name : processes.Keys()) {
    auto entry = processes.Section(name);
    ProcessSpec spec;
    spec.name = name;
    entry.Get("program", spec.program);
    entry.Get("args", spec.args);
    entry.Get("terminal", spec.terminal);
    if (spec.program.empty())
      entry.Fail("program", "expected the program to run, e.g. \"beckon-pose\"");
    spec.program = FindProgram(spec.program);
    profile.processes.push_back(std::move(spec));
  }
  if (auto right = table->Finish(); !right) return right.error();
  if (profile.processes.empty()) {
    return Error{path +
                 ": no process to run; expected tables [process.NAME] with program = \"..\""};
  }
  if (std::ranges::count(profile.processes, true, &ProcessSpec::terminal) > 1) {
    return Error{path + ": more than one process has terminal = true; a terminal serves one"};
  }
  return profile;
}

Result<int> RunProfile(const std::string& path, const std::string& lcm_url) {
  auto profile = LoadProfile(path);
  if (!profile) return profile.error();
  auto folder =
      RunFolder::Make(profile->logs.empty() ? StateFolder() : profile->logs, "beckon-run");
  if (!folder) return folder.error();
  folder->Keep();
  const std::string& url = profile->lcm_url.empty() ? lcm_url : profile->lcm_url;
  setenv("LCM_DEFAULT_URL", url.c_str(), 1);  // Beckon's programs and LCM's own heed it

  RunLoop loop(/*handle_signals=*/true);
  const SteadyClock steady;
  size_t finished = 0;
  const size_t n = profile->processes.size();
  Supervisor supervisor(loop, steady, [&](const Death& death) {
    if (!death.restart_us) {
      spdlog::info("{} is through ({})", death.name, death.exit.Text());
      if (++finished == n) loop.Stop();
      return;
    }
    spdlog::warn("{} died ({}; {} in a row), starts again in {:.1f} s: {}", death.name,
                 death.exit.Text(), death.in_a_row,
                 static_cast<double>(*death.restart_us) / kSecond, death.last_line);
  });
  for (auto& spec : profile->processes) {
    spec.log_file = folder->path() + "/" + spec.name + ".log";
    if (auto started = supervisor.Start(spec, Supervisor::Restart::kOnFailure); !started)
      return started.error();
  }
  spdlog::info("{} processes run; logs in {}; Ctrl-C ends them", n, folder->path());
  loop.Run();
  supervisor.Stop();
  return 0;
}

}  // namespace beckon::tool
