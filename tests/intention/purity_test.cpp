// The core stays free of bus, database, files, clocks and loggers.
#include <filesystem>
#include <fstream>

#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

TEST(Core, IncludesNothingImpure) {
  const std::filesystem::path core =
      std::filesystem::path(BECKON_SOURCE_DIR) / "services/intention/core";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(core)) {
    ++files;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      if (!line.starts_with("#include")) continue;
      for (const char* impure :
           {"lcm/", "codec.h", "SQLite", "sqlite", "spdlog", "<chrono>", "<thread>", "<mutex>",
            "<fstream>", "<filesystem>", "bus.h", "run_loop.h", "json", "<random_device"}) {
        EXPECT_EQ(line.find(impure), std::string::npos) << entry.path() << ": " << line;
      }
    }
  }
  EXPECT_GT(files, 20);
}

}  // namespace
}  // namespace beckon::intention
