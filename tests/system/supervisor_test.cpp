// Processes that live, die and are started again.
#include "tools/beckon/supervisor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>

#include "tools/beckon/run_folder.h"

namespace beckon::tool {
namespace {

using ::testing::HasSubstr;

TEST(BackOff, GrowsToItsLimitAndForgetsAfterAHealthyLife) {
  BackOff back_off;
  std::vector<Utime> delays;
  for (int i = 0; i < 8; ++i) delays.push_back(back_off.Next(0) / 1000);
  EXPECT_EQ(delays, (std::vector<Utime>{200, 400, 800, 1600, 3200, 5000, 5000, 5000}));
  EXPECT_EQ(back_off.deaths(), 8);
  EXPECT_EQ(back_off.Next(9 * kSecond), 5 * kSecond);
  EXPECT_EQ(back_off.Next(10 * kSecond), 200'000);
  EXPECT_EQ(back_off.deaths(), 1);
}

class SupervisorTest : public ::testing::Test {
 protected:
  SupervisorTest() {
    loop_.After(20 * kSecond, [this] {
      ADD_FAILURE() << "not done after 20 s";
      loop_.Stop();
    });
  }

  ProcessSpec Shell(const std::string& name, const std::string& script) {
    ProcessSpec spec;
    spec.name = name;
    spec.program = "/bin/sh";
    spec.args = {"-c", script};
    spec.log_file = folder_->path() + "/" + name + ".log";
    return spec;
  }

  /// Runs the loop until `n` deaths.
  void AwaitDeaths(size_t n) {
    wanted_deaths_ = n;
    if (deaths_.size() < n) loop_.Run();
    ASSERT_EQ(deaths_.size(), n);
  }

  Result<RunFolder> folder_ = RunFolder::Make("", "supervisor-test");
  RunLoop loop_;
  SteadyClock steady_;
  std::vector<Death> deaths_;
  size_t wanted_deaths_ = 0;
  Supervisor supervisor_{loop_, steady_, [this](const Death& death) {
                           deaths_.push_back(death);
                           if (deaths_.size() == wanted_deaths_) loop_.Stop();
                         }};
};

TEST_F(SupervisorTest, RefusesAProgramThatIsNotThere) {
  ProcessSpec spec;
  spec.name = "ghost";
  spec.program = "/nowhere/ghost";
  const auto started = supervisor_.Start(spec);
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().message, HasSubstr("/nowhere/ghost cannot be started: No such file"));
}

TEST_F(SupervisorTest, StartsADeadProcessAgainAndTellsWhyItDied) {
  auto spec = Shell("failing", "echo begins; echo '2026-01-02 03:04:05.678 no milk'; echo; exit 3");
  ASSERT_TRUE(supervisor_.Start(spec));
  AwaitDeaths(3);
  EXPECT_EQ(deaths_[0].exit.code, 3);
  EXPECT_EQ(deaths_[0].last_line, "no milk");
  EXPECT_EQ(deaths_[0].restart_us, 200'000);
  EXPECT_EQ(deaths_[1].restart_us, 400'000);
  EXPECT_EQ(deaths_[2].in_a_row, 3);
}

TEST_F(SupervisorTest, TellsSignalsFromExitCodes) {
  ASSERT_TRUE(supervisor_.Start(Shell("sleeper", "exec sleep 100")));
  const auto first = supervisor_.Pid("sleeper");
  ASSERT_TRUE(first);
  supervisor_.Signal("sleeper", SIGKILL);
  AwaitDeaths(1);
  EXPECT_EQ(deaths_[0].exit.signal, SIGKILL);
  EXPECT_THAT(deaths_[0].exit.Text(), HasSubstr("signal 9"));
  EXPECT_FALSE(supervisor_.Pid("sleeper"));
  loop_.Every(20'000, [this] {
    if (supervisor_.Pid("sleeper")) loop_.Stop();
  });
  loop_.Run();
  EXPECT_NE(supervisor_.Pid("sleeper"), first);
}

TEST_F(SupervisorTest, LeavesAProcessThatIsThroughAlone) {
  ProcessSpec spec = Shell("done", "exit 0");
  ASSERT_TRUE(supervisor_.Start(spec, Supervisor::Restart::kOnFailure));
  AwaitDeaths(1);
  EXPECT_FALSE(deaths_[0].restart_us);
}

TEST_F(SupervisorTest, EndsWholeGroupsEvenThoseThatDoNotListen) {
  ASSERT_TRUE(supervisor_.Start(Shell("polite", "exec sleep 100")));
  ASSERT_TRUE(supervisor_.Start(
      Shell("stubborn", "trap '' TERM; echo ready; while :; do sleep 0.05; done")));
  const pid_t polite = *supervisor_.Pid("polite");
  const pid_t stubborn = *supervisor_.Pid("stubborn");
  loop_.Every(20'000, [this] {
    if (LastLine(folder_->path() + "/stubborn.log") == "ready") loop_.Stop();
  });
  loop_.Run();
  supervisor_.Stop(/*patience_ms=*/200);
  EXPECT_NE(kill(polite, 0), 0);
  EXPECT_NE(kill(stubborn, 0), 0);
  EXPECT_TRUE(deaths_.empty()) << "ending is no death";
}

TEST_F(SupervisorTest, ChildrenHearSignalsThatWeBlock) {
  RunLoop blocking(/*handle_signals=*/true);
  ASSERT_TRUE(supervisor_.Start(
      Shell("trapper", "trap 'echo heard; exit 7' TERM; echo ready; while :; do sleep 0.02; done"),
      Supervisor::Restart::kNever));
  loop_.Every(20'000, [this] {
    if (LastLine(folder_->path() + "/trapper.log") == "ready")
      supervisor_.Signal("trapper", SIGTERM);
  });
  AwaitDeaths(1);
  EXPECT_EQ(deaths_[0].exit.code, 7);
}

TEST(LastLine, IsBoundedAndEmptyWhereThereIsNone) {
  EXPECT_EQ(LastLine("/nowhere/log"), "");
  const std::string path = ::testing::TempDir() + std::to_string(getpid()) + "_last_line_test.log";
  std::ofstream(path) << "first\n" << std::string(100'000, 'x') << "\n\n  \n";
  EXPECT_EQ(LastLine(path), std::string(300, 'x'));
}

}  // namespace
}  // namespace beckon::tool
