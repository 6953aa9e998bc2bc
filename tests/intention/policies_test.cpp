#include "services/intention/core/policies.h"

#include "services/intention/core/evaluation.h"
#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

/// Sessions over random scenes; anything in the scene may be wanted.
std::vector<ScenarioSession> RandomSessions(const Affordances& affordances, int count,
                                            bool nearest_only) {
  std::mt19937_64 random(21);
  std::vector<ScenarioSession> sessions;
  while (static_cast<int>(sessions.size()) < count) {
    ScenarioSession session;
    session.user = "user" + std::to_string(random() % 3);
    session.scene = RandomThings(affordances, random, 15, random() % 2 == 0);
    const Situation situation = MakeSituation(affordances, session.scene);
    const Pair want = situation.pairs[random() % situation.pairs.size()];
    session.want_category = situation.objects[want.object].category;
    session.want_rank = nearest_only ? 1 : situation.objects[want.object].rank;
    session.want_action = want.action;
    sessions.push_back(session);
  }
  return sessions;
}

class EveryPolicy : public testing::TestWithParam<const char*> {};

TEST_P(EveryPolicy, EndsEverySessionRight) {
  const Affordances affordances = TestAffordances();
  const bool by_category = std::string(GetParam()) == "random";  // always means the nearest
  for (const auto families : {QueryFamilies::kActionObjectFull, QueryFamilies::kAll}) {
    const auto policy = MakePolicy(GetParam(), affordances, families);
    ASSERT_TRUE(policy.ok());
    Evaluation evaluation(affordances, **policy, {}, [] { return 0.0; });
    for (const auto& session : RandomSessions(affordances, 300, by_category)) {
      const SessionOutcome outcome = evaluation.Live(session);
      ASSERT_TRUE(outcome.answered);
      EXPECT_TRUE(outcome.correct);
      EXPECT_GE(outcome.questions, 1);
      EXPECT_LE(outcome.questions, 130);
    }
  }
}

TEST_P(EveryPolicy, IsDeterministicPerSeed) {
  const Affordances affordances = TestAffordances();
  const auto policy = MakePolicy(GetParam(), affordances, QueryFamilies::kAll);
  const auto sessions = RandomSessions(affordances, 60, true);
  const auto counts = [&](uint64_t seed) {
    EvaluationConfig config;
    config.seed = seed;
    config.flip = 0.1;
    Evaluation evaluation(affordances, **policy, config, [] { return 0.0; });
    std::vector<int> questions;
    for (const auto& session : sessions) questions.push_back(evaluation.Live(session).questions);
    return questions;
  };
  EXPECT_EQ(counts(4), counts(4));
  EXPECT_NE(counts(4), counts(5));
}

TEST_P(EveryPolicy, SurvivesNoise) {
  const Affordances affordances = TestAffordances();
  const auto policy = MakePolicy(GetParam(), affordances, QueryFamilies::kAll);
  EvaluationConfig config;
  config.flip = 0.2;
  config.assume_flip = 0;  // contradictions are impossible, and happen
  Evaluation evaluation(affordances, **policy, config, [] { return 0.0; });
  for (const auto& session : RandomSessions(affordances, 100, true)) {
    EXPECT_LT(evaluation.Live(session).questions, 500);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryPolicy,
                         testing::Values("adaptive", "oain", "count", "random", "random-scene"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(MakePolicy, RefusesUnknownNames) {
  const Affordances affordances = TestAffordances();
  const auto policy = MakePolicy("psychic", affordances, QueryFamilies::kAll);
  ASSERT_FALSE(policy.ok());
  EXPECT_NE(policy.error().message.find("'psychic'"), std::string::npos);
}

TEST(OainPolicy, PrunesAsTheDissertationDoes) {
  const Affordances a = TestAffordances();
  const Situation s =
      MakeSituation(a, Things(a, {{"Mug", 0.5}, {"Mug", 0.6}, {"Tube", 0.7}, {"SprayCan", 0.8}}));
  const auto policy = MakePolicy("oain", a, QueryFamilies::kActionObjectFull);
  const auto dialogue = (*policy)->Begin(s, {}, Interface::YesNo(), 1);
  const Evidence yes = ErrorModel::Exact({}).Hear({1, 0});
  const Evidence no = ErrorModel::Exact({}).Hear({0, 1});
  // Grasp is linked to all four objects and the likeliest.
  ASSERT_EQ(dialogue->Ask(), AskAction(a.FindAction("Grasp")));
  dialogue->Hear(*dialogue->Ask(), no);
  EXPECT_EQ(dialogue->CurrentBelief().possible_pairs, 3 + 3 + 2 + 1 - 4);
  dialogue->Hear(AskObject(0), yes);  // the nearest mug: only its full queries stay
  EXPECT_EQ(dialogue->CurrentBelief().possible_pairs, 2);
  while (dialogue->Ask()) {
    ASSERT_EQ(dialogue->Ask()->kind, QuestionKind::kFull);
    dialogue->Hear(*dialogue->Ask(), no);
  }
  EXPECT_FALSE(dialogue->Accepted());
}

}  // namespace
}  // namespace beckon::intention
