#include "services/intention/core/lookahead.h"

#include <cmath>
#include <numeric>

#include "services/intention/core/exact_policy.h"
#include "services/intention/core/question_families.h"
#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

constexpr double kAccept = 0.99;

double Sum(const std::vector<double>& p) { return std::accumulate(p.begin(), p.end(), 0.0); }

double Entropy(const std::vector<double>& p) {
  const double sum = Sum(p);
  double h = 0;
  for (const double x : p) {
    if (x > 0) h -= x / sum * std::log2(x / sum);
  }
  return h;
}

std::vector<double> RandomPosterior(const Situation& s, std::mt19937_64& random) {
  std::vector<double> p(s.pairs.size());
  for (double& x : p) x = 1e-3 + std::pow(static_cast<double>(random() % 1000) / 1000, 6);
  const double sum = Sum(p);
  for (double& x : p) x /= sum;
  return p;
}

/// The candidates' joint probability with an answer, each computed by itself.
std::vector<double> Heard(const Situation& s, const std::vector<double>& p, const Question& q,
                          const ErrorRates& rates, int said) {
  std::vector<double> joint(p);
  for (int i = 0; i < s.pair_count(); ++i)
    joint[i] *= ErrorModel::Exact(rates).Probability(0, q.answers(), q.Meant(s.pairs[i]), said);
  return joint;
}

/// Cost of a question one step ahead, or two: the best of `all` comes after it.
double BruteCost(const Situation& s, const std::vector<double>& p, const Question& q,
                 const Interface& interface, const ErrorRates& rates,
                 const std::vector<Question>& all) {
  const QuestionCost price(interface, rates, kAccept);
  double cost = 0;
  for (int said = 0; said < q.answers(); ++said) {
    const auto joint = Heard(s, p, q, rates, said);
    const double sum = Sum(joint);
    if (sum <= 1e-12) continue;
    cost += sum * interface.Seconds(q.answers(), said);
    if (const int pair = q.Accepts(said); pair >= 0 && joint[pair] >= kAccept * sum) continue;
    double left = sum * price.Remaining(Entropy(joint));
    if (!all.empty()) left = 1e9;
    for (const Question& next : all)
      left = std::min(left, BruteCost(s, joint, next, interface, rates, {}));
    cost += left;
  }
  return cost;
}

std::vector<Question> ActionObjectFull(const Situation& s) {
  std::vector<Question> all;
  for (int i = 0; i < s.pair_count(); ++i) all.push_back(AskPair(s, i));
  for (int a = 0; a < 7; ++a) all.push_back(AskAction(a));
  for (int o = 0; o < static_cast<int>(s.objects.size()); ++o) all.push_back(AskObject(o));
  return all;
}

class LookaheadAgainstBruteForce : public testing::TestWithParam<double> {};

TEST_P(LookaheadAgainstBruteForce, LooksTwoStepsAheadFromTheCheapestQuestions) {
  const ErrorRates rates{GetParam(), GetParam() / 2};
  const Affordances affordances = TestAffordances();
  const Interface yes_no = Interface::YesNo();
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 50; ++trial) {
    const Situation s = MakeSituation(affordances, RandomThings(affordances, random, 6, true));
    const auto p = RandomPosterior(s, random);
    const auto all = ActionObjectFull(s);
    const auto choice =
        ChooseQuestion(s, p, yes_no, rates, QueryFamilies::kActionObjectFull, kAccept);
    ASSERT_TRUE(choice);
    const double one_step = BruteCost(s, p, choice->question, yes_no, rates, {});
    const double two_steps = BruteCost(s, p, choice->question, yes_no, rates, all);
    // Where no other question comes near it, a second step is not looked at.
    EXPECT_LE(std::min(std::abs(choice->expected_seconds - one_step),
                       std::abs(choice->expected_seconds - two_steps)),
              1e-9);
    EXPECT_DOUBLE_EQ(choice->expected_questions, choice->expected_seconds);
    double cheapest = 1e9;
    const Question* near = nullptr;
    for (const Question& q : all) {
      const double cost = BruteCost(s, p, q, yes_no, rates, {});
      if (cost < cheapest - 1e-12) {
        cheapest = cost;
        near = &q;
      }
    }
    EXPECT_LE(two_steps, 1.002 * BruteCost(s, p, *near, yes_no, rates, all) + 1e-9);
  }
}

TEST_P(LookaheadAgainstBruteForce, PricesChoicesAsTheirPosteriors) {
  const ErrorRates rates{GetParam(), GetParam() / 2};
  const Affordances affordances = TestAffordances();
  Interface scan = Interface::YesNo();
  scan.kind = InterfaceKind::kScan;
  scan.max_options = 6;
  scan.seconds_per_question = 0.5;
  scan.seconds_per_option = 0.8;
  const QuestionCost price(scan, rates, kAccept);
  std::mt19937_64 random(12);
  int choices = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const Situation s = MakeSituation(affordances, RandomThings(affordances, random, 6, true));
    const auto p = RandomPosterior(s, random);
    std::vector<Mass> masses;
    for (const double x : p) masses.push_back(Mass::Of(x));
    const ObjectGroups groups(s);
    const CheapestQuestions cheapest(s, groups, price, QueryFamilies::kAll, masses, {}, 10);
    for (const PricedQuestion& priced : cheapest.best()) {
      const Question question = priced.AsQuestion();
      EXPECT_LE(question.answers(), scan.max_options);
      EXPECT_NEAR(priced.cost, BruteCost(s, p, question, scan, rates, {}), 1e-9);
      choices += question.kind == QuestionKind::kChoice;
    }
  }
  EXPECT_GT(choices, 50);
}

INSTANTIATE_TEST_SUITE_P(Rates, LookaheadAgainstBruteForce, testing::Values(0.0, 0.05, 0.2));

/// Mean cost of the policy over that of the best one, on small scenes.
double Regret(const Interface& interface, QueryFamilies families) {
  const Affordances affordances = TestAffordances();
  std::mt19937_64 random(13);
  double policy = 0, best = 0;
  for (int scenes = 0; scenes < 25;) {
    const Situation s = MakeSituation(affordances, RandomThings(affordances, random, 5, true));
    if (s.pair_count() > 12) continue;
    ++scenes;
    const auto p = RandomPosterior(s, random);
    const auto cost = CostOf(s, p, interface, [&](const std::vector<double>& posterior) {
      const auto choice = ChooseQuestion(s, posterior, interface, {}, families, kAccept);
      return choice ? std::optional(choice->question) : std::nullopt;
    });
    const double least = BestSeconds(s, p, interface, families);
    EXPECT_GE(cost.seconds, least - 1e-9);
    policy += cost.seconds;
    best += least;
  }
  return policy / best - 1;
}

TEST(ChooseQuestion, IsWithinHalfAPercentOfTheBestPolicy) {
  EXPECT_LE(Regret(Interface::YesNo(), QueryFamilies::kActionObjectFull), 0.005);
  EXPECT_LE(Regret(Interface::YesNo(), QueryFamilies::kAll), 0.005);
  for (const InterfaceKind kind :
       {InterfaceKind::kChoice, InterfaceKind::kScan, InterfaceKind::kVector}) {
    Interface interface = Interface::YesNo();
    interface.kind = kind;
    interface.max_options = 5;
    interface.seconds_per_option = 0.4;
    EXPECT_LE(Regret(interface, QueryFamilies::kAll), 0.005);
  }
}

TEST(ChooseQuestion, OffersNoMoreOptionsThanTheInterfaceShows) {
  const Affordances affordances = TestAffordances();
  std::mt19937_64 random(14);
  const Situation s = MakeSituation(affordances, RandomThings(affordances, random, 14, true));
  const auto p = RandomPosterior(s, random);
  const auto yes_no = ChooseQuestion(s, p, Interface::YesNo(), {}, QueryFamilies::kAll, kAccept);
  for (const int options : {2, 3, 5, 9, 64}) {
    Interface interface = Interface::YesNo();
    interface.kind = InterfaceKind::kChoice;
    interface.max_options = options;
    const auto choice = ChooseQuestion(s, p, interface, {}, QueryFamilies::kAll, kAccept);
    EXPECT_LE(choice->question.answers(), options);
    if (options == 2) {
      EXPECT_EQ(choice->question, yes_no->question);
    } else {
      EXPECT_LT(choice->expected_seconds, yes_no->expected_seconds);
    }
  }
}

TEST(ChooseQuestion, OffersFewerOptionsWhereTheyTakeLonger) {
  const Affordances affordances = TestAffordances();
  const Situation s = MakeSituation(affordances, Things(affordances, {{"Bottle", 1}, {"Tin", 2}}));
  const std::vector<double> p = {0.5, 0.3, 0.1, 0.04, 0.02, 0.01, 0.01, 0.01, 0.01};
  Interface interface = Interface::YesNo();
  interface.kind = InterfaceKind::kChoice;
  interface.max_options = 10;
  const auto cheap = ChooseQuestion(s, p, interface, {}, QueryFamilies::kAll, kAccept);
  EXPECT_EQ(cheap->question.answers(), 10);
  EXPECT_DOUBLE_EQ(cheap->expected_seconds, 1);
  interface.seconds_per_option = 1;
  EXPECT_LT(ChooseQuestion(s, p, interface, {}, QueryFamilies::kAll, kAccept)->question.answers(),
            6);
}

TEST(ChooseQuestion, AnOptionThatLeavesOnePairIsThatPair) {
  const Affordances affordances = TestAffordances();
  const Situation s =
      MakeSituation(affordances, Things(affordances, {{"SprayCan", 1}, {"Tube", 2}, {"Bowl", 3}}));
  Interface interface = Interface::YesNo();
  interface.kind = InterfaceKind::kChoice;
  interface.max_options = 4;
  const std::vector<double> p(s.pairs.size(), 1.0 / static_cast<double>(s.pairs.size()));
  const auto choice = ChooseQuestion(s, p, interface, {}, QueryFamilies::kAll, kAccept);
  ASSERT_EQ(choice->question.kind, QuestionKind::kChoice);
  for (const Proposition& option : choice->question.options) {
    if (option.objects == 1) {
      EXPECT_EQ(option.pair, 0);  // nothing but grasping the spray can
    }
  }
}

TEST(ChooseQuestion, PrefersTheEasierOfTwoThatCostTheSame) {
  const Affordances affordances = TestAffordances();
  // Every object is the only one of its category, and the nearest is a set of one.
  const Situation s =
      MakeSituation(affordances, Things(affordances, {{"SprayCan", 1}, {"SprayCan", 2}}));
  const auto choice =
      ChooseQuestion(s, {0.5, 0.5}, Interface::YesNo(), {}, QueryFamilies::kAll, kAccept);
  EXPECT_EQ(choice->question.kind, QuestionKind::kFull);
}

TEST(ChooseQuestion, LooksAtABoundedNumberOfQuestions) {
  const Affordances affordances = TestAffordances();
  std::vector<Thing> things;
  for (int i = 0; i < 60; ++i)
    things.push_back({affordances.FindCategory("Bottle"), 0.2 + 0.01 * i, 0.3 * std::sin(i)});
  const Situation s = MakeSituation(affordances, things);
  ASSERT_EQ(s.pair_count(), 300);
  std::mt19937_64 random(15);
  const auto p = RandomPosterior(s, random);
  const auto yes_no =
      ChooseQuestion(s, p, Interface::YesNo(), {0.05, 0.05}, QueryFamilies::kAll, kAccept);
  EXPECT_LT(yes_no->priced, 2'000);
  Interface wide = Interface::YesNo();
  wide.kind = InterfaceKind::kVector;
  wide.max_options = 64;
  const auto choice = ChooseQuestion(s, p, wide, {0.05, 0.05}, QueryFamilies::kAll, kAccept);
  EXPECT_LT(choice->priced, 30'000);
}

TEST(ChooseQuestion, AsksNothingWhereNothingIsLeft) {
  const Affordances affordances = TestAffordances();
  const Situation s = MakeSituation(affordances, Things(affordances, {{"Tube", 1}}));
  const Interface yes_no = Interface::YesNo();
  EXPECT_FALSE(ChooseQuestion(s, {0, 0}, yes_no, {}, QueryFamilies::kAll, 0.99));
  const auto sure = ChooseQuestion(s, {0, 1}, yes_no, {}, QueryFamilies::kAll, 0.99);
  ASSERT_TRUE(sure);
  EXPECT_EQ(sure->question, AskPair(s, 1));
  EXPECT_DOUBLE_EQ(sure->expected_questions, 1);
}

TEST(RemainingQuestions, IsNearTheBestCodeOfAllKindsOfDistributions) {
  EXPECT_DOUBLE_EQ(RemainingQuestions(0, 1), 1);
  double difference = 0;
  int n = 0;
  for (double ratio = 0.3; ratio < 1.01; ratio += 0.05) {
    for (const int pairs : {2, 5, 12, 30}) {
      std::vector<double> p;
      for (int i = 0; i < pairs; ++i) p.push_back(std::pow(ratio, i));
      const double sum = Sum(p), entropy = Entropy(p);
      difference += std::abs(RemainingQuestions(entropy, 1) - BestCode(p) / sum);
      EXPECT_LE(RemainingQuestions(entropy, 1), BestCode(p) / sum + 0.1);
      ++n;
    }
  }
  EXPECT_LT(difference / n, 0.15);
}

TEST(QuestionCost, RemainsAsRemainingQuestionsWhereAQuestionIsASecond) {
  const Interface yes_no = Interface::YesNo();
  for (const double entropy : {0.0, 0.3, 1.0, 5.0}) {
    const QuestionCost exact(yes_no, {}, kAccept), noisy(yes_no, {0.1, 0.1}, kAccept);
    EXPECT_NEAR(exact.Remaining(entropy), RemainingQuestions(entropy, 1), 1e-12);
    EXPECT_NEAR(noisy.Remaining(entropy), RemainingQuestions(entropy, Capacity(2, {0.1, 0.1})),
                1e-12);
  }
}

TEST(Capacity, IsABitOfYesAndNoWithoutErrors) {
  EXPECT_DOUBLE_EQ(Capacity(2, {0, 0}), 1);
  EXPECT_NEAR(Capacity(2, {0.05, 0.05}), 0.7136, 1e-4);
  EXPECT_GT(Capacity(2, {0.5, 0.5}), 0);
  EXPECT_DOUBLE_EQ(Capacity(8, {0, 0}), 3);
  EXPECT_LT(Capacity(8, {0.05, 0.05}), 3);
  EXPECT_GT(Capacity(8, {0.9, 0.9}), 0);
}

}  // namespace
}  // namespace beckon::intention
