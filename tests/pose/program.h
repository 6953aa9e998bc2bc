// Runs beckon-pose as users do, in a folder of its own.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace beckon::pose {

class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    dir_ = std::filesystem::temp_directory_path() /
           ("beckon_pose_" + std::string(test->name()) + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(dir_);
  }
  void TearDown() override { std::filesystem::remove_all(dir_); }

  std::string Path(const std::string& name) const { return (dir_ / name).string(); }
  std::string Read(const std::string& name) const {
    std::ifstream file(Path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(Path(name), std::ios::binary) << text;
  }

  // Exit code; what it printed on standard error is in `error_`.
  int Run(const std::string& arguments) {
    const std::string command =
        std::string(BECKON_POSE_PROGRAM) + " " + arguments + " >/dev/null 2>" + Path("stderr");
    const int status = std::system(command.c_str());
    error_ = Read("stderr");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void ExpectRefusal(const std::string& arguments, const std::string& says) {
    EXPECT_EQ(Run(arguments), 2) << arguments;
    EXPECT_THAT(error_, ::testing::HasSubstr(says));
    EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
  }

  // The lines of a JSON file that tell no time.
  std::string ReadWithoutTimes(const std::string& name) const {
    std::istringstream text(Read(name));
    std::string lines;
    for (std::string line; std::getline(text, line);) {
      if (line.find("\"time_ms\"") == std::string::npos) lines += line + '\n';
    }
    return lines;
  }
  // Runs it in two processes; all that it writes is the same but for times.
  void ExpectSameBytesTwice(const std::string& arguments) {
    for (const std::string run : {"first", "second"}) {
      ASSERT_EQ(Run(arguments + " --json " + Path(run + ".json") + " --picture " +
                    Path(run + ".png") + " --mesh " + Path(run + ".ply")),
                0)
          << error_;
    }
    EXPECT_FALSE(ReadWithoutTimes("first.json").empty());
    EXPECT_EQ(ReadWithoutTimes("first.json"), ReadWithoutTimes("second.json"));
    EXPECT_LT(ReadWithoutTimes("first.json").size(), Read("first.json").size());
    EXPECT_TRUE(Read("first.png") == Read("second.png"));
    EXPECT_TRUE(Read("first.ply") == Read("second.ply"));
  }

  std::filesystem::path dir_;
  std::string error_;
};

}  // namespace beckon::pose
