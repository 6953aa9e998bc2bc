#include <cmath>

#include "services/intention/core/answer_errors.h"
#include "services/intention/core/evaluation.h"
#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

class AdaptivePolicy : public testing::Test {
 protected:
  Evidence Said(bool yes, const ErrorModel& errors) const {
    return errors.Hear({yes ? 1.0 : 0.0, yes ? 0.0 : 1.0});
  }
  const Affordances a = TestAffordances();
  const Situation s = MakeSituation(a, Things(a, {{"Mug", 0.3},
                                                  {"Mug", 0.6},
                                                  {"Carton", 0.5},
                                                  {"Tube", 0.4},
                                                  {"Box", 0.9},
                                                  {"Bottle", 0.7}}));
  const std::unique_ptr<Policy> policy = MakeAdaptivePolicy({});
};

TEST_F(AdaptivePolicy, PosteriorIsBayes) {
  const ErrorModel errors = ErrorModel::Exact({0.1, 0.05});
  const auto dialogue = policy->Begin(s, {}, Interface::YesNo(errors), 1);
  const int best_before = dialogue->CurrentBelief().best_pair;
  const double p = dialogue->CurrentBelief().best_posterior;
  dialogue->Hear(AskPair(s, best_before), Said(true, errors));
  EXPECT_EQ(dialogue->CurrentBelief().best_pair, best_before);
  EXPECT_NEAR(dialogue->CurrentBelief().best_posterior, p * 0.95 / (p * 0.95 + (1 - p) * 0.1),
              1e-12);
}

TEST_F(AdaptivePolicy, AsksTheLearntTaskAtOnce) {
  const UserHistory history(3, {a.FindCategory("Carton"), a.FindAction("Open"), 1, {}, 0, {}});
  const auto dialogue = policy->Begin(s, history, Interface::YesNo(), 1);
  const int carton = s.Find(2, a.FindAction("Open"));
  ASSERT_EQ(dialogue->Ask(), AskPair(s, carton));
  dialogue->Hear(*dialogue->Ask(), Said(true, ErrorModel::Exact({})));
  EXPECT_EQ(dialogue->Accepted(), carton);
}

TEST_F(AdaptivePolicy, NeedsAnAcceptedFullQuery) {
  const auto dialogue = policy->Begin(s, {}, Interface::YesNo(), 1);
  dialogue->Hear(AskObject(3), Said(true, ErrorModel::Exact({})));
  dialogue->Hear(AskAction(a.FindAction("Squeeze")), Said(true, ErrorModel::Exact({})));
  EXPECT_DOUBLE_EQ(dialogue->CurrentBelief().best_posterior, 1);
  EXPECT_FALSE(dialogue->Accepted());  // certain, but never said
  EXPECT_EQ(dialogue->Ask()->kind, QuestionKind::kFull);
}

TEST_F(AdaptivePolicy, AYesAloneIsNotEnoughOverANoisyLine) {
  const ErrorModel errors = ErrorModel::Exact({0.2, 0.2});
  const UserHistory habit(30, {a.FindCategory("Carton"), a.FindAction("Open"), 1, {}, 0, {}});
  const auto dialogue = policy->Begin(s, habit, Interface::YesNo(errors), 1);
  EXPECT_LE(dialogue->CurrentBelief().best_posterior, 0.9 + 1e-12);  // the cap
  dialogue->Hear(*dialogue->Ask(), Said(true, errors));
  EXPECT_FALSE(dialogue->Accepted());
}

TEST_F(AdaptivePolicy, ContradictionWithoutNoiseRulesEverythingOut) {
  const auto dialogue = policy->Begin(s, {}, Interface::YesNo(), 1);
  int asked = 0;
  while (const auto question = dialogue->Ask()) {
    dialogue->Hear(*question, Said(false, ErrorModel::Exact({})));
    ASSERT_LT(++asked, 100);
  }
  EXPECT_FALSE(dialogue->Accepted());
  EXPECT_EQ(dialogue->CurrentBelief().possible_pairs, 0);
}

TEST_F(AdaptivePolicy, GivesUpWhereNoneOfThePairsIsMeant) {
  AdaptiveConfig config;
  config.none_prior = 0.002;
  const ErrorModel errors = ErrorModel::Announced({0.05, 0.05});
  const auto careful = MakeAdaptivePolicy(config);
  const auto dialogue = careful->Begin(s, {}, Interface::YesNo(errors), 1);
  int asked = 0;
  while (const auto question = dialogue->Ask()) {
    dialogue->Hear(*question, Said(false, errors));
    ASSERT_LT(++asked, 200);
  }
  EXPECT_GT(asked, 3);
}

TEST_F(AdaptivePolicy, SoftAnswersCountByTheirLikelihood) {
  const ErrorModel exact = ErrorModel::Exact({});
  const auto dialogue = policy->Begin(s, {}, Interface::YesNo(exact), 1);
  const Question question = AskObject(2);
  dialogue->Hear(question, exact.Hear({0.5, 0.5}));  // says nothing
  const Belief before = dialogue->CurrentBelief();
  EXPECT_EQ(before.possible_pairs, s.pair_count());
  dialogue->Hear(question, exact.Hear({0.7, 0.3}));
  EXPECT_EQ(dialogue->CurrentBelief().possible_pairs, s.pair_count());  // nothing is pruned
}

TEST_F(AdaptivePolicy, AnUndecidedAnswerAcceptsNothing) {
  const ErrorModel exact = ErrorModel::Exact({});
  const auto dialogue = policy->Begin(s, {}, Interface::YesNo(exact), 1);
  dialogue->Hear(AskObject(3), Said(true, exact));
  dialogue->Hear(AskAction(a.FindAction("Squeeze")), Said(true, exact));
  dialogue->Hear(*dialogue->Ask(), exact.Hear({0.5, 0.5}));
  EXPECT_FALSE(dialogue->Accepted());
}

TEST_F(AdaptivePolicy, LearnsHowOftenAnswersAreWrong) {
  const ErrorModel start = ErrorModel::Unknown();
  const auto mean = [](const ErrorModel& m) {
    double sum = 0;
    for (int i = 0; i < ErrorModel::kLevels; ++i) sum += m.weights[i] * m.rates[i].false_yes;
    return sum;
  };
  EXPECT_LT(mean(start.Learnt({100, 0, 100, 0}).Learnt({0, 0, 0, 0})), 1);
  EXPECT_LT(mean(start.Learnt({200, 0, 0, 200})), 0.01);
  EXPECT_NEAR(mean(start.Learnt({160, 40, 40, 160})), 0.2, 0.02);
  EXPECT_FALSE(ErrorModel::Exact({}).noisy());
  EXPECT_TRUE(start.noisy());
  EXPECT_FALSE(ErrorModel::Announced({0, 0}).noisy());
}

TEST_F(AdaptivePolicy, CountsAnswersPerDevice) {
  UserHistory history;
  for (int i = 0; i < 4; ++i)
    history.push_back({0, 0, 1, {{i % 2 == 0 ? "switch" : "speech", {1, 2, 3, 4}}}, 0, {}});
  EXPECT_NEAR(PastAnswers(history, "switch").meant_no_said_no, 4 + 4 * 0.98, 1e-12);
  EXPECT_EQ(PastAnswers(history, "bci").meant_yes_said_yes, 0);
}

TEST_F(AdaptivePolicy, HardlyEverErrsUnderNoiseOfUnknownRate) {
  std::mt19937_64 random(8);
  for (const double flip : {0.05, 0.1, 0.2}) {
    EvaluationConfig config;
    config.flip = flip;
    Evaluation evaluation(a, *policy, config, [] { return 0.0; });
    int wrong = 0, none = 0;
    const int sessions = 400;
    for (int i = 0; i < sessions; ++i) {
      ScenarioSession session;
      session.user = "user" + std::to_string(i / 40);
      session.scene = RandomThings(a, random, 14, false);
      const Situation situation = MakeSituation(a, session.scene);
      const Pair want = situation.pairs[random() % situation.pairs.size()];
      session.want_category = situation.objects[want.object].category;
      session.want_rank = situation.objects[want.object].rank;
      session.want_action = want.action;
      const SessionOutcome outcome = evaluation.Live(session);
      wrong += outcome.answered && !outcome.correct;
      none += !outcome.answered;
    }
    EXPECT_LE(wrong, sessions / 100) << flip;  // 1 %, 3 sigma above the 0.2 % it has at most
    EXPECT_EQ(none, 0) << flip;
  }
}

}  // namespace
}  // namespace beckon::intention
