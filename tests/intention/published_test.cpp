// The author's published sessions, where they are at hand.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "services/intention/affordances_file.h"
#include "services/intention/core/policies.h"
#include "services/intention/scenario_file.h"

namespace beckon::intention {
namespace {

class PublishedSessions : public testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("BECKON_DATA");
    const std::filesystem::path folder =
        data != nullptr ? std::filesystem::path(data)
                        : std::filesystem::path(BECKON_SOURCE_DIR) / ".." / "shared" / "data";
    for (const char* name :
         {"group1_objects", "group1_position", "group2_objects", "group2_position"}) {
      const auto file = folder / "intention" / ("thesis_" + std::string(name) + ".jsonl");
      if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there; set BECKON_DATA";
      const auto read = ReadScenario(file.string(), *affordances);
      ASSERT_TRUE(read.ok()) << read.error().message;
      scenarios.push_back(*read);
    }
  }
  /// Mean questions, and mean absolute difference to the published counts of his network.
  std::pair<double, double> Live(const std::string& policy_name, QueryFamilies families) {
    const auto policy = MakePolicy(policy_name, *affordances, families);
    double questions = 0, difference = 0;
    int sessions = 0;
    for (const auto& scenario : scenarios) {
      Evaluation evaluation(*affordances, **policy, {}, [] { return 0.0; });
      for (const ScenarioLine& line : scenario) {
        const SessionOutcome outcome = evaluation.Live(line.session);
        EXPECT_TRUE(outcome.correct);
        const double published =
            nlohmann::json::parse(line.json)["published"]["OAIN"].get<double>();
        questions += outcome.questions;
        difference += std::abs(outcome.questions - published);
        ++sessions;
      }
    }
    RecordProperty(policy_name, std::to_string(questions / sessions));
    return {questions / sessions, difference / sessions};
  }
  const Result<Affordances> affordances =
      ReadAffordances(std::string(BECKON_SOURCE_DIR) + "/services/intention/affordances.toml");
  std::vector<std::vector<ScenarioLine>> scenarios;
};

TEST_F(PublishedSessions, OainReproducesThePublishedCounts) {
  const auto [mean, difference] = Live("oain", QueryFamilies::kActionObjectFull);
  EXPECT_NEAR(mean, 3.02, 0.1);
  EXPECT_LE(difference, 0.25);
}

TEST_F(PublishedSessions, AdaptiveAsksLessThanHalfAsMuch) {
  EXPECT_LE(Live("adaptive", QueryFamilies::kActionObjectFull).first, 1.28);
  EXPECT_LE(Live("adaptive", QueryFamilies::kAll).first, 1.24);
}

}  // namespace
}  // namespace beckon::intention
