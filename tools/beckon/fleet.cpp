#include "tools/beckon/fleet.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace beckon::tool {
namespace {

ProcessSpec Service(const FleetConfig& config, const std::string& name, const std::string& program,
                    std::vector<std::string> args) {
  args.insert(args.end(), {"--lcm-url", config.lcm_url});
  return {.name = name,
          .program = config.bin_dir + "/" + program,
          .args = std::move(args),
          .log_file = config.run_dir + "/" + name + ".log",
          .terminal = false,
          .stdin_file = {}};
}

std::vector<std::string> InputArgs(const FleetConfig& config) {
  if (!config.input.empty()) return {"--input", config.input};
  return {"--embedded-seed", std::to_string(config.seed)};
}

}  // namespace

ProcessSpec CaptureSpec(const FleetConfig& config) {
  return Service(config, "capture", "beckon-capture", InputArgs(config));
}

ProcessSpec TruthSpec(const FleetConfig& config) {
  auto args = InputArgs(config);
  args.insert(args.end(), {"--truth", config.TruthFile()});
  return Service(config, "truth", "beckon-capture", std::move(args));
}

ProcessSpec PerceptionSpec(const FleetConfig& config) {
  std::vector<std::string> args{"--examples", config.ExamplesFolder()};
  if (!config.perception_config.empty())
    args.insert(args.end(), {"--config", config.perception_config});
  return Service(config, "perception", "beckon-perception", std::move(args));
}

ProcessSpec PoseSpec(const FleetConfig& config) {
  return Service(config, "pose", "beckon-pose", {});
}

ProcessSpec IntentionSpec(const FleetConfig& config) {
  std::vector<std::string> args{"--db", config.db};
  if (!config.policy.empty()) args.insert(args.end(), {"--policy", config.policy});
  return Service(config, "intention", "beckon-intention", std::move(args));
}

ProcessSpec UiBridgeSpec(const FleetConfig& config, const std::vector<std::string>& front_ends,
                         const std::string& want, bool terminal) {
  std::vector<std::string> args{"--user", config.user};
  for (const auto& front_end : front_ends) args.insert(args.end(), {"--front-end", front_end});
  if (config.sessions > 0)
    args.insert(args.end(), {"--exit-after-sessions", std::to_string(config.sessions)});
  if (std::ranges::find(front_ends, "simulated") != front_ends.end()) {
    args.insert(args.end(),
                {"--want", want, "--seed", std::to_string(config.seed), "--think",
                 std::to_string(config.think_s), "--flip", std::to_string(config.flip)});
    if (std::filesystem::exists(config.TruthFile()))
      args.insert(args.end(), {"--truth", config.TruthFile()});
  }
  auto spec = Service(config, "ui_bridge", "beckon-ui-bridge", std::move(args));
  spec.terminal = terminal;
  spec.listening_fd = config.page_socket;
  return spec;
}

ProcessSpec LoggerSpec(const FleetConfig& config, const std::string& log) {
  return {.name = "logger",
          .program = "lcm-logger",
          .args = {"--lcm-url=" + config.lcm_url, "--flush-interval=50", log},
          .log_file = config.run_dir + "/logger.log",
          .terminal = false,
          .stdin_file = {}};
}

std::string OwnBinDir() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path().string();
}

}  // namespace beckon::tool
