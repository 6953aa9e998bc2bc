#include "services/base/app.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "services/base/bus.h"

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
