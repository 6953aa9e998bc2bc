#include "services/base/app.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace beckon {
namespace {

constexpr int kInternalError = 1;
constexpr int kBadInput = 2;

/// Logs go to standard error, so that standard output carries results only.
void SetUpLog(const AppOptions& options) {
  auto logger = spdlog::stderr_color_mt("beckon");
  logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %^%l%$ %v");
  logger->set_level(options.verbose ? spdlog::level::debug : spdlog::level::info);
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
}

/// $BECKON_KEYS, be it empty; else the machine's folder, or this user's, where there is one.
std::string DefaultKeys() {
  namespace fs = std::filesystem;
  if (const char* keys = std::getenv("BECKON_KEYS")) return keys;
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  const fs::path own = config != nullptr && *config != '\0'
                           ? fs::path(config)
                           : fs::path(home == nullptr ? "." : home) / ".config";
  std::error_code none;
  for (const fs::path& folder : {fs::path("/etc/beckon/keys"), own / "beckon" / "keys"}) {
    if (fs::exists(folder / "node.key", none)) return folder.string();
  }
  return {};
}

/// Whether LCM sends beyond this machine by `url`.
bool LeavesTheMachine(const std::string& url) {
  if (url.starts_with("tcpq://")) return true;
  const size_t ttl = url.find("ttl=");
  return url.starts_with("udpm://") && ttl != std::string::npos &&
         std::atoi(url.c_str() + ttl + 4) > 0;
}

int Fail(const CLI::App& app, const std::string& message, int code) {
  std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), message.c_str());
  return code;
}

}  // namespace

const char* VersionString() { return BECKON_VERSION; }

void AddAppOptions(CLI::App& app, AppOptions& options) {
  app.set_version_flag("--version", app.get_name() + " " + VersionString());
  app.add_option("--config", options.config_file, "TOML file over the defaults")->type_name("FILE");
  app.add_flag("--check-config", options.check_config,
               "Load the configuration, say whether it is right, and leave");
  app.add_option("--lcm-url", options.lcm_url,
                 std::string("Where the messages travel (default: $LCM_DEFAULT_URL, else ") +
                     kDefaultLcmUrl + ")")
      ->type_name("URL");
  options.keys = DefaultKeys();
  app.add_option("--keys", options.keys,
                 "Folder of keys by which messages are signed (default: $BECKON_KEYS, else "
                 "/etc/beckon/keys or ~/.config/beckon/keys where there is one; \"\" = unsigned); "
                 "see beckon keys")
      ->type_name("DIR");
  app.add_flag("--verbose", options.verbose, "Log more");
}

int RunApp(CLI::App& app, int argc, char** argv, AppOptions& options,
           const std::function<Status()>& body) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    return Fail(app, std::string(e.what()) + " (see --help)", kBadInput);
  }
  if (options.lcm_url.empty()) {
    const char* url = std::getenv("LCM_DEFAULT_URL");
    options.lcm_url = url != nullptr && *url != '\0' ? url : kDefaultLcmUrl;
  }
  SetUpLog(options);
  try {
    const Status status = body();
    return status ? 0 : Fail(app, status.error().message, kBadInput);
  } catch (const std::exception& e) {
    return Fail(app, std::string("internal error: ") + e.what(), kInternalError);
  }
}

Result<std::unique_ptr<Bus>> OpenBus(const AppOptions& options, const std::string& program) {
  static const SystemClock clock;
  static const SteadyClock steady;
  std::unique_ptr<trust::Guard> guard;
  if (!options.keys.empty()) {
    const trust::KeyFolder folder(options.keys);
    auto own = folder.Own();
    if (!own) return own.error();
    if (!*own)
      return Error{options.keys + ": holds no key of this machine; make one: beckon keys make"};
    guard = std::make_unique<trust::Guard>(
        folder, **own, DataFile("counter." + (*own)->node.name + "." + program), clock, steady);
  } else if (LeavesTheMachine(options.lcm_url)) {
    return Error{
        "'" + options.lcm_url +
        "' leaves this machine, where anybody could answer for the user or move "
        "the robot: make keys (beckon keys make; see docs/deployment), or stay here with ttl=0"};
  }
  return Bus::Open(options.lcm_url, std::move(guard));
}

std::function<std::string(const std::string&)> Within(double min, double max) {
  return [min, max](const std::string& text) -> std::string {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && value >= min && value <= max) return {};
    char expected[96];
    std::snprintf(expected, sizeof(expected), "expected a number from %g to %g, found ", min, max);
    return expected + text;
  };
}

Result<ConfigTable> LoadConfig(const AppOptions& options) {
  return ConfigTable::Load(options.config_file);
}

std::string DataFile(const std::string& name) {
  namespace fs = std::filesystem;
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  const fs::path folder = data != nullptr && *data != '\0'
                              ? fs::path(data)
                              : fs::path(home == nullptr ? "." : home) / ".local" / "share";
  return (folder / "beckon" / name).string();
}

std::string SharedFile(const std::string& name) {
  namespace fs = std::filesystem;
  if (const char* share = std::getenv("BECKON_SHARE"); share != nullptr && *share != '\0') {
    return (fs::path(share) / name).string();
  }
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  return (program.parent_path().parent_path() / "share" / "beckon" / name).string();
}

}  // namespace beckon
