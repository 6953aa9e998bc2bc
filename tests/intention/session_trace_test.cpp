// The readable trace of evaluated sessions.
#include "services/intention/session_trace.h"

#include <sstream>

#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

class SessionTraceTest : public testing::Test {
 protected:
  std::string TraceOf(const std::string& policy_name, int sessions, double flip = 0) {
    const auto policy = MakePolicy(policy_name, affordances, QueryFamilies::kAll, 1);
    EvaluationConfig config;
    config.flip = flip;
    Evaluation evaluation(affordances, **policy, config, [] { return 0.0; });
    std::ostringstream out;
    SessionTrace trace(affordances, out);
    const ScenarioSession session{
        "ann",
        Things(affordances, {{"Carton", 0.5}, {"Box", 0.6}, {"Mug", 0.7}}),
        affordances.FindCategory("Carton"),
        1,
        affordances.FindAction("Open"),
        0};
    for (int i = 0; i < sessions; ++i) evaluation.Live(session, &trace);
    return out.str();
  }
  const Affordances affordances = TestAffordances();
};

TEST_F(SessionTraceTest, TellsASessionFromCandidatesToTask) {
  const std::string text = TraceOf("adaptive", 2);
  for (const char* expected :
       {"ann, session 1: wants \"Open the carton\"; 3 objects, 11 tasks possible\n",
        "\n   end        Open the carton after ",
        "ann, session 2: wants \"Open the carton\"; 3 objects, 11 tasks possible\n",
        "Open the carton                  wanted once, 1 session ago\n",
        "\n 1 question   Open the carton?\n"
        "   why        You wanted to open the carton last time; a yes settles it.\n",
        "  yes                              settles it\n", "\n   answer     yes\n",
        "   end        Open the carton after 1 question: right (posterior 1.0000)\n"}) {
    EXPECT_NE(text.find(expected), std::string::npos) << expected << "in\n" << text;
  }
}

TEST_F(SessionTraceTest, SaysWhichAnswersWereWrong) {
  const std::string text = TraceOf("adaptive", 20, 0.3);
  EXPECT_NE(text.find("\" was meant)\n"), std::string::npos) << text;
  EXPECT_EQ(TraceOf("adaptive", 20).find("was meant"), std::string::npos);
}

TEST_F(SessionTraceTest, ServesPoliciesWithoutProbabilities) {
  const std::string text = TraceOf("random-scene", 1);
  EXPECT_NE(text.find("\n   end        Open the carton after "), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace beckon::intention
