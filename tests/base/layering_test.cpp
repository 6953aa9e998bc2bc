// The layers stay apart: a core includes no middleware, no files, no clocks, no threads; a service
// includes no other service.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace beckon {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> Lines(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// What a file includes, without the brackets.
std::vector<std::string> Includes(const fs::path& path) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<std::string> includes;
  for (const auto& line : Lines(path)) {
    if (std::smatch match; std::regex_search(line, match, kInclude)) includes.push_back(match[1]);
  }
  return includes;
}

TEST(Layering, CoresArePure) {
  static const std::regex kForbidden(
      "^(lcm/|lcmtypes/(?!messages\\.h)|beckon/|SQLiteCpp/|sqlite3|spdlog/|OpenNI|CLI/"
      "|fstream$|filesystem$|iostream$"
      "|chrono$|ctime$|thread$|mutex$|condition_variable$|future$|sys/|unistd"
      "|services/base/(bus|run_loop|latest_worker|app|config|status_reporter|cloud_file)\\.h)");
  const auto files = Lines(BECKON_CORE_SOURCES_FILE);
  ASSERT_FALSE(files.empty()) << "no core library is declared by beckon_core_library";
  for (fs::path file : files) {
    // A source file, and the header of its name whether or not it is listed.
    for (const char* extension : {".cpp", ".h"}) {
      file.replace_extension(extension);
      if (!fs::exists(file)) continue;
      for (const auto& include : Includes(file)) {
        EXPECT_FALSE(std::regex_search(include, kForbidden)) << file << " includes " << include;
      }
    }
  }
}

TEST(Layering, ServicesKnowEachOtherByMessagesOnly) {
  const fs::path services = fs::path(BECKON_SOURCE_DIR) / "services";
  for (const auto& entry : fs::recursive_directory_iterator(services)) {
    const std::string extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    const std::string own = *fs::relative(entry.path(), services).begin();
    for (const auto& include : Includes(entry.path())) {
      if (!include.starts_with("services/")) continue;
      const std::string other = *std::next(fs::path(include).begin());
      EXPECT_TRUE(other == own || other == "base") << entry.path() << " includes " << include;
    }
  }
}

}  // namespace
}  // namespace beckon
