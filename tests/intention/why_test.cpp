// Reasons for questions: habits, what answers lead to, and the sentence.
#include "services/intention/core/why.h"

#include <cmath>
#include <numeric>

#include "services/intention/core/policies.h"
#include "tests/intention/conversation_fixture.h"

namespace beckon::intention {
namespace {

class WhyTest : public testing::Test {
 protected:
  int PairOf(const std::string& category, const std::string& action, int rank = 1) const {
    return table.Find(affordances.FindCategory(category), rank, affordances.FindAction(action));
  }
  /// Sessions by their actions on the nearest carton.
  UserHistory Past(const std::vector<std::string>& actions) const {
    UserHistory history;
    for (const auto& action : actions) {
      PastSession past;
      past.category = affordances.FindCategory("Carton");
      past.action = affordances.FindAction(action);
      history.push_back(past);
    }
    return history;
  }
  Belief BeliefOf(const std::vector<double>& posterior, double expected_questions) const {
    Belief belief;
    belief.posterior = posterior;
    for (const double p : posterior) belief.possible_pairs += p > 1e-9;
    belief.expected_questions = belief.expected_seconds = expected_questions;
    return belief;
  }
  std::vector<double> Uniform() const {
    return std::vector<double>(table.pairs.size(), 1.0 / static_cast<double>(table.pairs.size()));
  }
  std::string TextOf(const UserHistory& history, const Belief& belief,
                     const Question& question) const {
    const Why why = Explain(table, history, Uniform(), belief, question, Interface::YesNo());
    return WhyText(affordances, table, history, belief, question, why);
  }

  const Affordances affordances = TestAffordances();
  const Situation table = MakeSituation(
      affordances, Things(affordances, {{"Carton", 0.5}, {"Box", 0.6}, {"Carton", 0.8}}));
};

TEST_F(WhyTest, CountsTheSessionsThatEndedInACandidate) {
  std::vector<double> posterior(table.pairs.size(), 0.0);
  posterior[PairOf("Carton", "Open")] = 0.7;
  posterior[PairOf("Carton", "Pour")] = 0.2;
  posterior[PairOf("Carton", "Open", 2)] = 0.1;
  const auto history = Past({"Open", "Pour", "Open", "Open", "Pour", "Grasp"});
  const Why why = Explain(table, history, Uniform(), BeliefOf(posterior, 2),
                          AskPair(table, PairOf("Carton", "Open")), Interface::YesNo());
  ASSERT_EQ(why.likeliest.size(), 3u);
  EXPECT_EQ(why.likeliest[0].pair, PairOf("Carton", "Open"));
  EXPECT_EQ(why.likeliest[0].times, 3);
  EXPECT_EQ(why.likeliest[0].sessions_ago, 3);
  EXPECT_DOUBLE_EQ(why.likeliest[0].posterior, 0.7);
  EXPECT_DOUBLE_EQ(why.likeliest[0].prior, 1.0 / static_cast<double>(table.pairs.size()));
  EXPECT_EQ(why.likeliest[1].times, 2);
  EXPECT_EQ(why.likeliest[1].sessions_ago, 2);
  EXPECT_EQ(why.likeliest[2].times, 0) << "the second carton never was it";
  EXPECT_EQ(why.likeliest[2].sessions_ago, 0);
}

TEST_F(WhyTest, NamesTheLikeliestFirstAndNoMoreThanEight) {
  const Why why = Explain(table, {}, Uniform(), BeliefOf(Uniform(), 4),
                          AskAction(affordances.FindAction("Open")), Interface::YesNo());
  ASSERT_EQ(why.likeliest.size(), 8u);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(why.likeliest[i].pair, i) << "ties in order";
}

TEST_F(WhyTest, AnEvenQuestionWithoutErrorsTellsOneBit) {
  std::vector<double> posterior(table.pairs.size(), 0.0);
  posterior[PairOf("Carton", "Open")] = posterior[PairOf("Carton", "Grasp")] = 0.25;
  posterior[PairOf("Box", "Open")] = posterior[PairOf("Box", "Grasp")] = 0.25;
  const Question question = AskAction(affordances.FindAction("Open"));
  const Why why =
      Explain(table, {}, Uniform(), BeliefOf(posterior, 3), question, Interface::YesNo());
  EXPECT_NEAR(why.information_bits, 1, 1e-12);
  ASSERT_EQ(why.prospects.size(), 2u);
  for (const Prospect& prospect : why.prospects) {
    EXPECT_NEAR(prospect.probability, 0.5, 1e-12);
    EXPECT_NEAR(prospect.questions_left, 2, 1e-12);
    EXPECT_NEAR(prospect.seconds_left, 2, 1e-12);
  }
  // A symmetric channel: 1 - H(0.1).
  const Why noisy = Explain(table, {}, Uniform(), BeliefOf(posterior, 3), question,
                            Interface::YesNo(ErrorModel::Exact({0.1, 0.1})));
  EXPECT_NEAR(noisy.information_bits, 1 + 0.1 * std::log2(0.1) + 0.9 * std::log2(0.9), 1e-12);
}

TEST_F(WhyTest, NothingIsLeftAfterTheYesThatSettlesIt) {
  std::vector<double> posterior(table.pairs.size(), 0.0);
  posterior[PairOf("Carton", "Open")] = 0.8;
  posterior[PairOf("Box", "Open")] = 0.2;
  const Question question = AskPair(table, PairOf("Carton", "Open"));
  const Why why =
      Explain(table, {}, Uniform(), BeliefOf(posterior, 1.2), question, Interface::YesNo());
  EXPECT_TRUE(why.prospects[0].accepts);
  EXPECT_EQ(why.prospects[0].questions_left, 0);
  EXPECT_FALSE(why.prospects[1].accepts);
  EXPECT_NEAR(why.prospects[1].questions_left, 1, 1e-12);
  const Why noisy = Explain(table, {}, Uniform(), BeliefOf(posterior, 3), question,
                            Interface::YesNo(ErrorModel::Exact({0.1, 0.1})));
  EXPECT_FALSE(noisy.prospects[0].accepts) << "a single yes is not enough";
  EXPECT_GT(noisy.prospects[0].questions_left, 0);
}

TEST_F(WhyTest, ProspectsAgreeWithWhatThePolicyExpects) {
  const auto policy = MakeAdaptivePolicy({});
  const auto history = Past({"Open", "Pour", "Open", "Grasp"});
  const auto dialogue = policy->Begin(table, history, Interface::YesNo(), 1);
  const auto question = dialogue->Ask();
  ASSERT_TRUE(question.has_value());
  const Belief belief = dialogue->CurrentBelief();
  const Why why = Explain(table, history, belief.posterior, belief, *question, Interface::YesNo());
  double probability = 0, questions = 1;
  for (const Prospect& prospect : why.prospects) {
    probability += prospect.probability;
    questions += prospect.probability * prospect.questions_left;
  }
  EXPECT_NEAR(probability, 1, 1e-9);
  EXPECT_NEAR(questions, belief.expected_questions, 1e-9);
}

TEST_F(WhyTest, AChoiceHasAProspectAnOption) {
  std::vector<double> posterior(table.pairs.size(), 0.0);
  const std::vector<int> pairs = {PairOf("Carton", "Open"), PairOf("Carton", "Grasp"),
                                  PairOf("Box", "Open"), PairOf("Box", "Grasp")};
  for (const int pair : pairs) posterior[pair] = 0.25;
  Question question{QuestionKind::kChoice, {}};
  for (int i = 0; i < 3; ++i) question.options.push_back(PairProposition(table, pairs[i]));
  Interface interface = Interface::YesNo();
  interface.kind = InterfaceKind::kChoice;
  interface.max_options = 4;
  const Why why = Explain(table, {}, Uniform(), BeliefOf(posterior, 1.25), question, interface);
  ASSERT_EQ(why.prospects.size(), 4u);
  EXPECT_NEAR(why.information_bits, 2, 1e-12);
  EXPECT_TRUE(why.prospects[0].accepts);
  EXPECT_FALSE(why.prospects[3].accepts);
  EXPECT_NEAR(why.prospects[3].questions_left, 1, 1e-12);
}

TEST_F(WhyTest, SpeaksOfHabits) {
  std::vector<double> posterior(table.pairs.size(), 0.0);
  posterior[PairOf("Carton", "Open")] = 0.9;
  posterior[PairOf("Box", "Open")] = 0.1;
  const Belief belief = BeliefOf(posterior, 1.1);
  const Question question = AskPair(table, PairOf("Carton", "Open"));
  const auto text = [&](const std::vector<std::string>& past) {
    return TextOf(Past(past), belief, question);
  };
  EXPECT_EQ(text({"Open", "Open", "Pour", "Open"}),
            "You wanted to open the nearest carton in 3 of the last 4 sessions; a yes settles it.");
  EXPECT_EQ(text({"Open", "Open"}),
            "You wanted to open the nearest carton in each of the last 2 sessions; a yes settles "
            "it.");
  EXPECT_EQ(text({"Open"}), "You wanted to open the nearest carton last time; a yes settles it.");
  std::vector<std::string> long_ago(11, "Pour");
  long_ago[0] = "Open";
  EXPECT_EQ(text(long_ago), "You wanted to open the nearest carton before; a yes settles it.");
  EXPECT_EQ(text({}), "Of two tasks that are possible this is the likeliest; a yes settles it.");
}

TEST_F(WhyTest, SpeaksOfWhatAnswersTell) {
  EXPECT_EQ(TextOf({}, BeliefOf(Uniform(), 4.2), AskObject(0)),
            "Twelve tasks are possible and either answer rules out about half; about three more "
            "questions will follow.");
  EXPECT_EQ(
      TextOf(Past({"Open"}), BeliefOf(Uniform(), 2.2), AskAction(affordances.FindAction("Open"))),
      "You wanted to open the nearest carton last time; about one more question will "
      "follow.");
  EXPECT_EQ(TextOf({}, BeliefOf(Uniform(), 2.2), AskAction(affordances.FindAction("Push"))),
            "Twelve tasks are possible and this tells most about which it is; about one more "
            "question will follow.");
}

TEST_F(WhyTest, IsSilentWhereThePolicyHasNoProbabilities) {
  Belief belief;
  belief.possible_pairs = 5;
  const Question question = AskPair(table, 0);
  const Why why = Explain(table, Past({"Open"}), {}, belief, question, Interface::YesNo());
  EXPECT_TRUE(why.likeliest.empty());
  EXPECT_TRUE(why.prospects.empty());
  EXPECT_FALSE(WhyText(affordances, table, Past({"Open"}), belief, question, why).empty());
}

TEST_F(WhyTest, StaysWithinTheRangesOfAMessage) {
  std::mt19937_64 random(5);
  const auto policy = MakeAdaptivePolicy({});
  for (int round = 0; round < 40; ++round) {
    const Situation situation =
        MakeSituation(affordances, RandomThings(affordances, random, 20, true));
    Interface interface =
        Interface::YesNo(round % 2 == 0 ? ErrorModel::Unknown() : ErrorModel::Exact({}));
    const auto dialogue = policy->Begin(situation, {}, interface, 1);
    const auto prior = dialogue->CurrentBelief().posterior;
    for (int i = 0; i < 20; ++i) {
      const auto question = dialogue->Ask();
      if (!question || dialogue->Accepted()) break;
      const Why why =
          Explain(situation, {}, prior, dialogue->CurrentBelief(), *question, interface);
      EXPECT_GE(why.information_bits, 0);
      EXPECT_LE(why.information_bits, 1 + 1e-9);
      for (const Prospect& p : why.prospects) {
        EXPECT_TRUE(p.probability >= 0 && p.probability < 1 + 1e-9) << p.probability;
        EXPECT_TRUE(p.questions_left >= 0 && p.questions_left < 1000) << p.questions_left;
        EXPECT_TRUE(p.seconds_left >= 0 && p.seconds_left < 1000) << p.seconds_left;
      }
      std::vector<double> said(2, 0.0);
      said[random() % 2] = 1;
      dialogue->Hear(*question, interface.errors.Hear(said));
    }
  }
}

TEST(WhyQuery, CarriesTheReasons) {
  FakeMemory memory;
  Desk desk(memory);
  const msg::Scene scene =
      SceneOf({SceneObject(1, "Mug", 0, 0.4), SceneObject(2, "Carton", 0.2, 0.5)});
  desk.Announce("switch");
  desk.Show(scene);
  desk.Start("s1");
  desk.Converse({"Open", 2, "Carton"});
  desk.Start("s2");
  const msg::Query query = desk.queries.back();
  EXPECT_EQ(query.why, "You wanted to open the carton last time; a yes settles it.");
  ASSERT_FALSE(query.likeliest.empty());
  const msg::Candidate& first = query.likeliest.front();
  EXPECT_EQ(first.action, "Open");
  EXPECT_EQ(first.object.object_id, 2);
  EXPECT_EQ(first.times, 1);
  EXPECT_EQ(first.sessions_ago, 1);
  EXPECT_DOUBLE_EQ(first.prior, first.posterior) << "before any answer";
  ASSERT_EQ(query.prospects.size(), 2u);
  EXPECT_EQ(query.prospects[0].questions_left, 0);
  desk.Answer(query, 1);
  const msg::Query next = desk.queries.back();
  for (const auto& candidate : next.likeliest) {
    EXPECT_FALSE(candidate.action == "Open" && candidate.object.object_id == 2) << "ruled out";
    EXPECT_GT(candidate.posterior, candidate.prior);
  }
}

TEST(WhyQuery, SaysWhyItAsksWhatAnObjectIs) {
  FakeMemory memory;
  Desk desk(memory);
  msg::SceneObject doubtful = SceneObject(1, "Box", 0, 0.4, 0.2f);
  doubtful.ask_user = true;
  doubtful.probabilities = {{"Box", 0.4f}, {"SprayCan", 0.3f}, {"Tin", 0.1f}};
  desk.Announce("switch");
  desk.Show(SceneOf({doubtful, SceneObject(2, "Tube", 0.3, 0.5)}));
  desk.Start();
  EXPECT_EQ(desk.queries.back().why,
            "It looks like a box (40 %) or a spray can (30 %); your answer is remembered.");
  desk.Answer(desk.queries.back(), desk.queries.back().options.size() - 1);
  while (desk.queries.back().kind != msg::QueryKind::kWhatIsIt) {
    ASSERT_EQ(desk.events.back().kind, msg::SessionKind::kBegun);
    desk.Answer(desk.queries.back(), 1);
  }
  EXPECT_EQ(desk.queries.back().why,
            "None of the tasks that I know was right, so an object may be another than I took it "
            "for.");
}

}  // namespace
}  // namespace beckon::intention
