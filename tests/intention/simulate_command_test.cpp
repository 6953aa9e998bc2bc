// `beckon-intention simulate` writes scenarios that `evaluate` reads.
#include "services/intention/simulate_command.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <sstream>

#include "services/intention/commands.h"
#include "tests/intention/fixtures.h"
#include "tests/intention/temporary_folder.h"

namespace beckon::intention {
namespace {

class SimulateCommandTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string share = std::string(BECKON_SOURCE_DIR) + "/services/intention";
    setenv("BECKON_SHARE", share.c_str(), 1);
  }
  /// Empty where it worked, else the message.
  static std::string Run(std::vector<std::string> arguments) {
    CLI::App app("test", "beckon-intention");
    CommandLine command_line(app);
    std::reverse(arguments.begin(), arguments.end());
    try {
      app.parse(arguments);
    } catch (const CLI::ParseError& e) {
      return e.what();
    }
    const Status status = command_line.Run();
    return status ? "" : status.error().message;
  }
  std::string Simulate(const std::string& out, const std::string& kind,
                       std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"simulate", "--kind", kind, "--out", folder / out});
    return Run(more);
  }
  std::string Read(const std::string& name) const {
    std::stringstream text;
    text << std::ifstream(folder / name).rdbuf();
    return text.str();
  }
  TemporaryFolder folder;
};

TEST_F(SimulateCommandTest, EveryKindIsReadAsItWasMade) {
  const Affordances affordances = TestAffordances();
  for (const SimulatedKind& kind : SimulatedKinds()) {
    SCOPED_TRACE(kind.name);
    ASSERT_EQ(Simulate("a.jsonl", kind.name, {"--users", "2", "--sessions", "15", "--seed", "7"}),
              "");
    const auto made = beckon::intention::Simulate(affordances, {kind.name, 2, 15, 0, 7});
    const auto read = ReadScenario(folder / "a.jsonl", affordances);
    ASSERT_TRUE(read.ok()) << read.error().message;
    ASSERT_EQ(read->size(), 30u);
    for (size_t i = 0; i < read->size(); ++i) {
      const ScenarioSession& session = (*read)[i].session;
      EXPECT_EQ(session.user, (*made)[i].user);
      EXPECT_EQ(session.want_category, (*made)[i].want_category);
      EXPECT_EQ(session.want_rank, (*made)[i].want_rank);
      EXPECT_EQ(session.want_action, (*made)[i].want_action);
      EXPECT_EQ(session.utime, (*made)[i].utime);
      ASSERT_EQ(session.scene.size(), (*made)[i].scene.size());
      for (size_t k = 0; k < session.scene.size(); ++k) {
        EXPECT_EQ(session.scene[k].distance_m, (*made)[i].scene[k].distance_m);
        EXPECT_EQ(session.scene[k].lateral_m, (*made)[i].scene[k].lateral_m);
      }
    }
  }
}

TEST_F(SimulateCommandTest, TheSameSeedWritesTheSameBytes) {
  ASSERT_EQ(Simulate("a.jsonl", "sparse", {"--seed", "3"}), "");
  ASSERT_EQ(Simulate("b.jsonl", "sparse", {"--seed", "3"}), "");
  ASSERT_EQ(Simulate("c.jsonl", "sparse", {"--seed", "4"}), "");
  EXPECT_EQ(Read("a.jsonl"), Read("b.jsonl"));
  EXPECT_NE(Read("a.jsonl"), Read("c.jsonl"));
}

TEST_F(SimulateCommandTest, OnlyThoseWhoLiveByTheClockTellTheTime) {
  ASSERT_EQ(Simulate("routine.jsonl", "routine"), "");
  ASSERT_EQ(Simulate("sparse.jsonl", "sparse"), "");
  EXPECT_NE(Read("routine.jsonl").find("\"utime\""), std::string::npos);
  EXPECT_EQ(Read("sparse.jsonl").find("\"utime\""), std::string::npos);
}

TEST_F(SimulateCommandTest, BadInputIsOneClearMessage) {
  EXPECT_NE(Simulate("a.jsonl", "wild").find("--kind wild: expected one of sparse"),
            std::string::npos);
  EXPECT_NE(Simulate("a.jsonl", "sparse", {"--repeat", "1.5"}), "");
  EXPECT_NE(Simulate("a.jsonl", "sparse", {"--users", "0"}), "");
  EXPECT_NE(Simulate("a.jsonl", "sparse", {"--sessions", "many"}), "");
  EXPECT_NE(Run({"simulate", "--kind", "sparse"}).find("--out"), std::string::npos);
  EXPECT_NE(Simulate("absent/a.jsonl", "sparse").find("check --out"), std::string::npos);
}

}  // namespace
}  // namespace beckon::intention
