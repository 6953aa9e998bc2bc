// Files and the commands that need no bus.
#include "services/intention/commands.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "services/intention/affordances_file.h"
#include "services/intention/store.h"
#include "services/intention/store_rows.h"
#include "tests/intention/temporary_folder.h"

namespace beckon::intention {
namespace {

const char kGood[] =
    R"({"user": "u", "scene": [{"category": "Box", "distance_m": 0.7, "lateral_m": 0.1}, {"category": "Mug", "distance_m": 0.5}], "want": {"category": "Box", "instance": 1, "action": "Open"}, "warm_up": true})";

class CommandsTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string share = std::string(BECKON_SOURCE_DIR) + "/services/intention";
    setenv("BECKON_SHARE", share.c_str(), 1);
  }
  std::string Write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return folder / name;
  }
  static std::string Read(const std::string& path) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  /// Empty where it worked, else the message.
  std::string Run(std::vector<std::string> arguments) {
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
  std::string Evaluate(const std::string& scenario, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"evaluate", "--scenario", scenario, "--jsonl",
                                          folder / "out.jsonl"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Run(arguments);
  }
  TemporaryFolder folder;
};

TEST_F(CommandsTest, ShippedAffordancesLoad) {
  const auto affordances =
      ReadAffordances(std::string(BECKON_SOURCE_DIR) + "/services/intention/affordances.toml");
  ASSERT_TRUE(affordances.ok()) << affordances.error().message;
  EXPECT_EQ(affordances->Named().categories().size(), 11u);
  EXPECT_EQ(affordances->actions().size(), 7u);
  EXPECT_EQ(affordances->Named().pair_count(), 36);
  EXPECT_EQ(affordances->categories().size(), 12u) << "with what can be done with unknown objects";
  EXPECT_EQ(Run({"--check-config"}), "");
}

TEST_F(CommandsTest, AffordanceErrorsNameTheFile) {
  const auto message = [&](const std::string& text) {
    const auto read = ReadAffordances(Write("a.toml", text));
    return read ? std::string("read") : read.error().message;
  };
  EXPECT_NE(message("[categories]\nBox = [\"Fly\"]\n[actions]\nOpen = \"open\"\n").find("a.toml"),
            std::string::npos);
  EXPECT_NE(message("[categories]\nBox = 3\n[actions]\nOpen = \"open\"\n").find("a.toml:2"),
            std::string::npos);
  EXPECT_NE(message("nonsense").find("a.toml:1"), std::string::npos);
  EXPECT_NE(message("[colours]\n").find("a.toml"), std::string::npos);
  EXPECT_FALSE(ReadAffordances(folder / "absent.toml").ok());
}

TEST_F(CommandsTest, EvaluateWritesALineASession) {
  const std::string scenario = Write("s.jsonl", std::string(kGood) + "\n\n" + kGood + "\n");
  ASSERT_EQ(Evaluate(scenario, {"--policy", "adaptive", "--queries", "aof", "--seed", "3"}), "");
  std::istringstream lines(Read(folder / "out.jsonl"));
  std::vector<nlohmann::json> out;
  for (std::string line; std::getline(lines, line);) out.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[0]["user"], "u");
  EXPECT_EQ(out[1]["session"], 2);
  EXPECT_EQ(out[1]["questions"], 1);
  EXPECT_EQ(out[1]["answered"],
            nlohmann::json::parse(R"({"category": "Box", "instance": 1, "action": "Open"})"));
  EXPECT_EQ(out[1]["correct"], true);
  EXPECT_EQ(out[1]["warm_up"], true);
  EXPECT_GT(out[1]["compute_us"].get<double>(), 0);
  EXPECT_LE(out[1]["posterior"].get<double>(), 1);
}

TEST_F(CommandsTest, EvaluateCountsTheSecondsOfAnInterface) {
  const std::string scenario = Write("s.jsonl", kGood);
  const auto first = [&] {
    std::istringstream lines(Read(folder / "out.jsonl"));
    std::string line;
    std::getline(lines, line);
    return nlohmann::json::parse(line);
  };
  ASSERT_EQ(Evaluate(scenario), "");
  EXPECT_EQ(first()["seconds"], first()["questions"]);
  const int questions = first()["questions"];
  ASSERT_EQ(Evaluate(scenario, {"--interface", "choice", "--max-options", "8",
                                "--seconds-per-question", "3", "--seconds-per-option", "0.5"}),
            "");
  EXPECT_LT(first()["questions"], questions);
  EXPECT_GE(first()["seconds"], 3 + 2 * 0.5);
  EXPECT_NE(Evaluate(scenario, {"--interface", "telepathy"}), "");
  EXPECT_NE(Evaluate(scenario, {"--max-options", "1"}), "");
  EXPECT_NE(Evaluate(scenario, {"--seconds-per-question", "0"}), "");
}

TEST_F(CommandsTest, RegretIsOfNoSceneNegative) {
  ASSERT_EQ(Run({"regret", "--scenes", "2", "--seed", "5", "--jsonl", folder / "r.jsonl"}), "");
  std::istringstream lines(Read(folder / "r.jsonl"));
  int n = 0;
  for (std::string line; std::getline(lines, line); ++n) {
    const auto scene = nlohmann::json::parse(line);
    EXPECT_GE(scene["seconds"].get<double>(), scene["best_seconds"].get<double>() - 1e-9) << line;
    EXPECT_GE(scene["seconds"].get<double>(), scene["code_questions"].get<double>() - 1e-9);
  }
  EXPECT_EQ(n, 2 * 2 * 4 * 2);  // scenes, families, distributions, sizes
  EXPECT_NE(Run({"regret", "--scenes", "0"}), "");
  EXPECT_NE(Run({"regret", "--jsonl", folder / "absent/r.jsonl"}).find("--jsonl"),
            std::string::npos);
}

TEST_F(CommandsTest, MalformedScenariosNameTheLine) {
  const auto message = [&](std::string line) {
    return Evaluate(Write("s.jsonl", std::string(kGood) + "\n" + line + "\n"));
  };
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string line = kGood;
    return line.replace(line.find(from), from.size(), to);
  };
  for (const std::string& bad :
       {std::string("{"), std::string("[]"), std::string("{\"user\": 3}"),
        changed("\"Box\"", "\"Car\""), changed("0.7", "\"far\""), changed("0.7", "-1"),
        changed("0.7", "1e999"), changed("\"Open\"", "\"Fly\""), changed("\"Open\"", "\"Squeeze\""),
        changed("\"instance\": 1", "\"instance\": 2"),
        changed("\"instance\": 1", "\"instance\": 1.5"), changed("\"scene\"", "\"scenes\""),
        changed("\"want\"", "\"wants\"")}) {
    EXPECT_NE(message(bad).find("s.jsonl:2: "), std::string::npos) << bad << " -> " << message(bad);
  }
  EXPECT_NE(Evaluate(Write("empty.jsonl", "")).find("no session"), std::string::npos);
  EXPECT_NE(Evaluate(folder / "absent.jsonl").find("cannot read"), std::string::npos);
  EXPECT_NE(Evaluate(Write("g.jsonl", kGood), {"--policy", "psychic"}).find("psychic"),
            std::string::npos);
  EXPECT_NE(Evaluate(Write("g.jsonl", kGood), {"--flip", "0.8"}), "");
}

TEST_F(CommandsTest, HistoryTravelsByExportAndImport) {
  SessionRecord session;
  session.session_id = "s1";
  session.user = "ann";
  session.category = "Mug";
  session.action = "Drink";
  msg::Task task;
  task.utime = session.utime = 1'700'000'000 * kSecond;
  task.expires_utime = task.utime + 30 * kSecond;
  task.task_id = "s1";
  task.user = "ann";
  task.action = "Drink";
  task.object = {1, "Mug", 1};
  task.pose.object_id = 1;
  {
    auto store = Store::Open(folder / "a.db", "kitchen");
    const auto committed = (*store)->Commit(session, {}, task);
    ASSERT_TRUE(committed.ok()) << committed.error().message;
  }
  ASSERT_EQ(Run({"export", "--db", folder / "a.db", "--out", folder / "rows.jsonl"}), "");
  ASSERT_EQ(Run({"import", "--db", folder / "b.db", folder / "rows.jsonl"}), "");
  ASSERT_EQ(Run({"import", "--db", folder / "b.db", "--in", folder / "rows.jsonl"}), "");
  EXPECT_EQ(Run({"history", "--db", folder / "b.db", "--json"}), "");
  auto store = Store::Open(folder / "b.db", "bedroom");
  EXPECT_EQ((*store)->SessionsOf("ann")->size(), 1u);
  EXPECT_EQ(Run({"forget", "--db", folder / "b.db", "--last"}), "");
  EXPECT_TRUE((*store)->SessionsOf("ann")->empty());
  EXPECT_NE(Run({"forget", "--db", folder / "b.db", "--user", "nobody"}), "");
  EXPECT_NE(Run({"forget", "--db", folder / "b.db"}), "");
  EXPECT_NE(Run({"history", "--db", folder / "absent.db"}).find("no such database"),
            std::string::npos);
}

TEST_F(CommandsTest, ImportRefusesHostileLinesAndKeepsNothing) {
  for (const char* bad :
       {"{", "[1]", R"({"origin": "x", "seq": 1})",
        R"({"origin": "x", "seq": "1", "kind": "session", "body": "{}"})",
        R"({"origin": "x", "seq": 1, "kind": "session", "body": "{\"session_id\": 4}"})"}) {
    const std::string good = R"({"origin": "x", "seq": 9, "kind": "note", "body": "{}"})";
    const std::string message =
        Run({"import", "--db", folder / "c.db", Write("bad.jsonl", good + "\n" + bad + "\n")});
    EXPECT_NE(message.find("bad.jsonl:2: "), std::string::npos) << message;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "c.db"));
}

TEST_F(CommandsTest, ConfigurationIsStrict) {
  EXPECT_EQ(Run({"--check-config", "--config",
                 Write("good.toml", "policy = \"oain\"\ntask_lifetime_s = 20\n")}),
            "");
  EXPECT_NE(
      Run({"--check-config", "--config", Write("bad.toml", "polcy = \"oain\"\n")}).find("polcy"),
      std::string::npos);
  EXPECT_NE(Run({"--check-config", "--config", Write("bad.toml", "policy = \"count\"\n")}), "");
}

TEST_F(CommandsTest, ExplainsSessionsInAFile) {
  const std::string scenario = Write("s.jsonl", std::string(kGood) + "\n");
  const std::string file = folder / "explained.txt";
  EXPECT_EQ(Evaluate(scenario, {"--explain", file}), "");
  EXPECT_EQ(Read(file).find("u, session 1: wants \"Open the box\""), 0u) << Read(file);
  EXPECT_EQ(Evaluate(scenario, {"--explain=/nowhere/x"}),
            "/nowhere/x: cannot be written; check --explain");
}

}  // namespace
}  // namespace beckon::intention
