#include "services/intention/core/prior.h"

#include <numeric>

#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

class Prior : public testing::Test {
 protected:
  double Of(const std::vector<double>& prior, const char* category, int rank,
            const char* action) const {
    return prior[s.Find(a.FindCategory(category), rank, a.FindAction(action))];
  }
  PastSession Past(const char* category, const char* action, int rank = 1) const {
    return {a.FindCategory(category), a.FindAction(action), rank, {}, 0, {}};
  }
  const Affordances a = TestAffordances();
  const Situation s = MakeSituation(
      a, Things(a, {{"Mug", 0.3}, {"Mug", 0.6}, {"Carton", 0.5}, {"Tube", 0.4}, {"Box", 0.9}}));
};

TEST_F(Prior, SumsToOneWhateverThePast) {
  std::mt19937_64 random(5);
  UserHistory history;
  for (int i = 0; i < 300; ++i) {
    const int category = static_cast<int>(random() % a.categories().size());
    const auto& actions = a.categories()[category].actions;
    history.push_back({category,
                       actions[random() % actions.size()],
                       1 + static_cast<int>(random() % 9),
                       {},
                       0,
                       {}});
    const auto prior = PriorOver(s, history);
    EXPECT_NEAR(std::accumulate(prior.begin(), prior.end(), 0.0), 1, 1e-12);
    for (const double p : prior) EXPECT_GT(p, 0);
  }
}

TEST_F(Prior, PrefersTheNearestAndWhatWasWanted) {
  const auto fresh = PriorOver(s, {});
  EXPECT_GT(Of(fresh, "Mug", 1, "Drink"), Of(fresh, "Mug", 2, "Drink"));
  EXPECT_DOUBLE_EQ(Of(fresh, "Mug", 1, "Drink"), Of(fresh, "Carton", 1, "Open"));
  const auto learnt = PriorOver(s, {Past("Carton", "Open")});
  EXPECT_GT(Of(learnt, "Carton", 1, "Open"), 0.5);
  EXPECT_GT(Of(learnt, "Carton", 1, "Pour"), 0);
}

TEST_F(Prior, LearnsWhetherTheUserRepeats) {
  const UserHistory repeats(10, Past("Carton", "Open"));
  UserHistory switches;
  for (int i = 0; i < 10; ++i)
    switches.push_back(i % 2 == 0 ? Past("Box", "Push") : Past("Carton", "Open"));
  EXPECT_GT(Of(PriorOver(s, repeats), "Carton", 1, "Open"), 0.95);
  EXPECT_GT(Of(PriorOver(s, switches), "Box", 1, "Push"), 0.25);
}

TEST_F(Prior, CopesWithALastTaskThatIsNotThere) {
  const auto prior = PriorOver(s, {Past("Bottle", "Pour"), Past("Mug", "Drink", 5)});
  EXPECT_NEAR(std::accumulate(prior.begin(), prior.end(), 0.0), 1, 1e-12);
  EXPECT_GT(Of(prior, "Mug", 1, "Drink"), 0.3);  // rank 5 is absent: the nearest
  EXPECT_TRUE(PriorOver(MakeSituation(a, {}), {}).empty());
}

TEST_F(Prior, LooksBackSoFarAndNoFurther) {
  UserHistory history(1000, Past("Box", "Push"));
  history.resize(1500, Past("Mug", "Drink", 2));
  UserHistory longer(700, Past("Tube", "Squeeze"));
  longer.insert(longer.end(), history.begin() + 500, history.end());
  const auto prior = PriorOver(s, UserHistory(history.begin() + 500, history.end()));
  EXPECT_EQ(PriorOver(s, history), prior);
  EXPECT_EQ(PriorOver(s, longer), prior);
}

TEST_F(Prior, KnowsTheTimeOfDay) {
  UserHistory history;
  for (int i = 0; i < 60; ++i) {
    const bool morning = (i * i / 3) % 2 == 0;
    PastSession past = morning ? Past("Carton", "Pour") : Past("Mug", "Drink");
    past.utime = (i + 1) * 24 * 3'600 * kSecond + (morning ? 8 : 20) * 3'600 * kSecond;
    history.push_back(past);
  }
  Situation morning = s, evening = s;
  morning.utime = (100 * 24 + 8) * 3'600 * kSecond;
  evening.utime = (100 * 24 + 20) * 3'600 * kSecond;
  EXPECT_GT(Of(PriorOver(morning, history), "Carton", 1, "Pour"), 0.85);
  EXPECT_GT(Of(PriorOver(evening, history), "Mug", 1, "Drink"), 0.85);
}

TEST_F(Prior, KeepsToTheFavouriteInstance) {
  PastSession past = Past("Mug", "Drink", 2);
  past.present = Situation(s).Present(a);
  const auto prior = PriorOver(s, UserHistory(8, past));
  EXPECT_GT(Of(prior, "Mug", 2, "Drink"), 0.7);
}

TEST_F(Prior, PassesOverWhatCannotBe) {
  PastSession odd = Past("Mug", "Drink", 1'000'000'000);
  odd.present.assign(a.categories().size(), 0);  // not even the mug that was wanted
  PastSession none = Past("Carton", "Open", -3);
  none.present = {1};
  for (const double p : PriorOver(s, {odd, none, odd})) {
    EXPECT_GT(p, 0);
    EXPECT_LT(p, 1);
  }
}

TEST_F(Prior, CapKeepsTheSum) {
  std::vector<double> prior = {0.97, 0.02, 0.01};
  CapPrior(prior, 0.9);
  EXPECT_DOUBLE_EQ(prior[0], 0.9);
  EXPECT_NEAR(prior[1] / prior[2], 2, 1e-9);
  EXPECT_NEAR(prior[0] + prior[1] + prior[2], 1, 1e-12);
  std::vector<double> certain = {1, 0};
  CapPrior(certain, 0.9);
  EXPECT_NEAR(certain[1], 0.1, 1e-12);
  std::vector<double> alone = {1};
  CapPrior(alone, 0.9);
  EXPECT_DOUBLE_EQ(alone[0], 1);
}

}  // namespace
}  // namespace beckon::intention
