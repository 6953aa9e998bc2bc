#include "services/intention/core/policies.h"

#include <cmath>

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

/// Questions of sessions that all want the same, by one user.
std::vector<int> Repeat(const Affordances& a, const Policy& policy, const ScenarioSession& session,
                        int times, uint64_t seed = 1) {
  EvaluationConfig config;
  config.seed = seed;
  Evaluation evaluation(a, policy, config, [] { return 0.0; });
  std::vector<int> questions;
  for (int i = 0; i < times; ++i) questions.push_back(evaluation.Live(session).questions);
  return questions;
}

ScenarioSession OpenCarton(const Affordances& a) {
  return {.user = "u",
          .scene = Things(a, {{"Bottle", 0.4},
                              {"Box", 0.5},
                              {"Carton", 0.6},
                              {"Mug", 0.7},
                              {"Tin", 0.3},
                              {"Bowl", 0.8}}),
          .want_category = a.FindCategory("Carton"),
          .want_rank = 1,
          .want_action = a.FindAction("Open")};
}

TEST(MakePolicy, RefusesLearningRatesThatAreNone) {
  const Affordances affordances = TestAffordances();
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    const auto policy = MakePolicy("oain", affordances, QueryFamilies::kAll, bad);
    ASSERT_FALSE(policy.ok());
    EXPECT_NE(policy.error().message.find("expected a number above 0"), std::string::npos);
  }
}

TEST(OainPolicy, LearnsFasterAtAHigherRate) {
  const Affordances a = TestAffordances();
  const auto last_session = [&](double lambda) {
    return Repeat(a, **MakePolicy("oain", a, QueryFamilies::kAll, lambda), OpenCarton(a), 9).back();
  };
  EXPECT_EQ(last_session(9), 1);
  EXPECT_GT(last_session(1), 1);
  EXPECT_GT(last_session(0.1), last_session(1));
}

TEST(OainPolicy, GivesTiesToFullQueries) {
  const Affordances a = TestAffordances();
  const Situation s = MakeSituation(a, OpenCarton(a).scene);
  PastSession past;
  past.category = a.FindCategory("Carton");
  past.action = a.FindAction("Open");
  // By now the action, the object and their pair are within 1e-8 of certain.
  const UserHistory history(40, past);
  const auto policy = MakePolicy("oain", a, QueryFamilies::kAll);
  for (uint64_t seed = 1; seed < 20; ++seed) {
    const auto dialogue = (*policy)->Begin(s, history, Interface::YesNo(), seed);
    EXPECT_EQ(dialogue->Ask(), AskPair(s, s.Find(past.category, 1, past.action)));
  }
}

TEST(CountPolicy, AsksActionsFirstAndNeverLearns) {
  const Affordances a = TestAffordances();
  const auto policy = MakePolicy("count", a, QueryFamilies::kActionObjectFull);
  const Situation s = MakeSituation(a, OpenCarton(a).scene);
  PastSession past;
  past.category = a.FindCategory("Mug");
  past.action = a.FindAction("Drink");
  for (uint64_t seed = 1; seed < 20; ++seed) {
    const auto fresh = (*policy)->Begin(s, {}, Interface::YesNo(), seed);
    const auto used = (*policy)->Begin(s, UserHistory(50, past), Interface::YesNo(), seed);
    const Evidence no = Interface::YesNo().errors.Hear({0, 1});
    int actions = 0;
    for (; fresh->Ask() && fresh->Ask()->kind == QuestionKind::kAction; ++actions) {
      ASSERT_EQ(fresh->Ask(), used->Ask());
      // What was frozen is opening, grasping and pouring.
      const Question question = *fresh->Ask();
      const bool frozen = question == AskAction(a.FindAction("Open")) ||
                          question == AskAction(a.FindAction("Grasp")) ||
                          question == AskAction(a.FindAction("Pour"));
      EXPECT_EQ(frozen, actions < 3);
      fresh->Hear(question, no);
      used->Hear(question, no);
    }
    EXPECT_EQ(actions, 6);  // all that the scene has
  }
}

TEST(CountPolicy, WorksWithoutTheVocabularyItWasFrozenWith) {
  const auto a = Affordances::Make({{"Sit", "sit on"}}, {{"Chair", {"Sit"}}});
  ASSERT_TRUE(a.ok());
  const ScenarioSession sit{.user = "u", .scene = {{0, 1.0, 0}}};
  EXPECT_LE(Repeat(*a, **MakePolicy("count", *a, QueryFamilies::kAll), sit, 1).front(), 2);
}

}  // namespace
}  // namespace beckon::intention
