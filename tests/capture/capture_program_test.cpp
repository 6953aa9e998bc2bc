// The program's command line: bad input is one clear line and exit code 2.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace beckon::capture {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Outcome {
  int code = -1;
  std::string output;
};

Outcome RunProgram(const std::string& arguments) {
  const std::string command =
      std::string(BECKON_CAPTURE_PROGRAM) + " " + arguments + " 2>&1 </dev/null";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.output.append(buffer.data(), n);
  outcome.code = WEXITSTATUS(pclose(pipe));
  return outcome;
}

class CaptureProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("capture_program_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void ExpectRefused(const std::string& arguments, const std::string& about) {
    const Outcome outcome = RunProgram(arguments + " --lcm-url memq://");
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(about)) << arguments;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  }
  std::string Put(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }

  fs::path folder_;
};

TEST_F(CaptureProgramTest, RefusesBadInputInOneLine) {
  const std::string header =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ";
  ExpectRefused("--input " + (folder_ / "missing.pcd").string(), "missing.pcd");
  ExpectRefused("--input " + folder_.string(), "found none");
  ExpectRefused("--input " + Put("empty.pcd", ""), "empty");
  ExpectRefused("--input " + Put("text.ply", "hello\n"), "text.ply");
  ExpectRefused("--input " + Put("cut.pcd", header + "binary\nabc"), "truncated");
  ExpectRefused("--input " + Put("nan.pcd", header + "ascii\nnan nan nan\nnan nan nan\n"),
                "finite");
  ExpectRefused("--input " + Put("behind.pcd", header + "ascii\n0 0 -1\n0 0 -2\n"), "in front");
}

TEST_F(CaptureProgramTest, RefusesBadFlags) {
  ExpectRefused("--rate 0", "--rate");
  ExpectRefused("--rate nonsense", "rate");
  ExpectRefused("--intrinsics 1,2,3", "intrinsics");
  ExpectRefused("--intrinsics 0,525,320,240", "focal");
  ExpectRefused("--render", "--out");
  ExpectRefused("--render --render-objects --out x", "one of them");
  ExpectRefused("--frames 0 --render --out x", "--frames");
  ExpectRefused("--out x", "--render");
  ExpectRefused("--views 0 --render-objects --out x", "--views");
  ExpectRefused("--per-category 0 --render-objects --out x", "--meshes");
  ExpectRefused("--sensor radar --render-objects --out x", "--sensor");
  ExpectRefused("--meshes x", "--render-objects");
  ExpectRefused("--meshes /nowhere --render-objects --out " + (folder_ / "x").string(), "/nowhere");
  ExpectRefused("--render --out /proc/nowhere", "/proc/nowhere");
  ExpectRefused("--unknown", "--unknown");
  ExpectRefused("--config " + Put("bad.toml", "rate_hz = 2\nspeed = 1\n"), "speed");
  ExpectRefused("--config " + Put("worse.toml", "rate_hz = \"fast\"\n"), "rate_hz");
}

TEST_F(CaptureProgramTest, ChecksItsConfiguration) {
  const std::string config = Put(
      "good.toml", "rate_hz = 5.0\nembedded_seed = 7\nintrinsics = [525.0, 525.0, 319.5, 239.5]\n");
  EXPECT_EQ(RunProgram("--check-config --config " + config).code, 0);
  const std::string shipped = std::string(BECKON_SOURCE_DIR) + "/services/capture/capture.toml";
  EXPECT_EQ(RunProgram("--check-config --config " + shipped).output, "");
  EXPECT_EQ(RunProgram("--version").code, 0);
  EXPECT_THAT(RunProgram("--help").output, HasSubstr("--render-objects"));
}

TEST_F(CaptureProgramTest, WritesTheEmbeddedScenesTruth) {
  const std::string file = (folder_ / "truth.json").string();
  const Outcome outcome = RunProgram("--embedded-seed 5 --truth " + file);
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  std::ifstream stream(file);
  const auto json = nlohmann::json::parse(stream);
  ASSERT_GE(json.at("objects").size(), 3u);
  EXPECT_EQ(json.at("objects")[0].at("X_CO").at("rotation_wxyz").size(), 4u);
  EXPECT_EQ(json.at("table").at("normal").size(), 3u);
}

TEST_F(CaptureProgramTest, PublishesUntilSigterm) {
  // It logs into a pipe, so that its first frame can be awaited.
  const std::string log = (folder_ / "log").string();
  ASSERT_EQ(mkfifo(log.c_str(), 0600), 0);
  const std::string url = "file://" + log + "?mode=w";
  const pid_t child = fork();
  if (child == 0) {
    execl(BECKON_CAPTURE_PROGRAM, "beckon-capture", "--lcm-url", url.c_str(), nullptr);
    _exit(127);
  }
  const int reader = open(log.c_str(), O_RDONLY);
  ASSERT_GE(reader, 0);
  std::string bytes;
  std::array<char, 4096> buffer{};
  bool told = false;
  while (const ssize_t n = read(reader, buffer.data(), buffer.size())) {
    if (n < 0) break;
    bytes.append(buffer.data(), static_cast<size_t>(n));
    if (!told && bytes.find("BECKON_FRAME") != std::string::npos) {
      told = true;
      kill(child, SIGTERM);
    }
  }
  close(reader);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(told);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

}  // namespace
}  // namespace beckon::capture
