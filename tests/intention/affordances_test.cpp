#include "services/intention/core/affordances.h"

#include "services/intention/core/situation.h"
#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

TEST(Affordances, HaveThePairsOfTheDissertation) {
  const Affordances affordances = TestAffordances();
  EXPECT_EQ(affordances.categories().size(), 11u);
  EXPECT_EQ(affordances.actions().size(), 7u);
  EXPECT_EQ(affordances.pair_count(), 36);
  EXPECT_TRUE(
      affordances.Affords(affordances.FindCategory("Tube"), affordances.FindAction("Squeeze")));
  EXPECT_FALSE(
      affordances.Affords(affordances.FindCategory("Mug"), affordances.FindAction("Open")));
  EXPECT_FALSE(affordances.Affords(-1, 0));
  EXPECT_EQ(affordances.FindCategory("Car"), -1);
}

TEST(Affordances, RefuseNonsenseByName) {
  const std::vector<Action> actions = {{"Open", "open"}};
  const auto message = [&](std::vector<Affordances::Entry> entries) {
    const auto made = Affordances::Make(actions, std::move(entries));
    return made ? std::string("made") : made.error().message;
  };
  EXPECT_NE(message({{"Box", {"Fly"}}}).find("'Fly'"), std::string::npos);
  EXPECT_NE(message({{"Box", {}}}).find("affords nothing"), std::string::npos);
  EXPECT_NE(message({{"Box", {"Open", "Open"}}}).find("twice"), std::string::npos);
  EXPECT_NE(message({{"Box", {"Open"}}, {"Box", {"Open"}}}).find("twice"), std::string::npos);
  EXPECT_NE(message({{"Unknown", {"Open"}}}).find("reserved"), std::string::npos);
  EXPECT_NE(message({}).find("none"), std::string::npos);
  EXPECT_FALSE(Affordances::Make({{"Open", ""}}, {{"Box", {"Open"}}}).ok());
  EXPECT_EQ(message({{"Box", {"Open"}}}), "made");
}

TEST(Situation, RanksInstancesByDistance) {
  const Affordances affordances = TestAffordances();
  const Situation situation = MakeSituation(
      affordances, Things(affordances, {{"Mug", 0.8}, {"Box", 0.5}, {"Mug", 0.4}, {"Mug", 0.8}}));
  EXPECT_EQ(situation.objects[0].rank, 2);  // ties by order
  EXPECT_EQ(situation.objects[1].rank, 1);
  EXPECT_EQ(situation.objects[2].rank, 1);
  EXPECT_EQ(situation.objects[3].rank, 3);
  EXPECT_EQ(situation.pair_count(), 3 * 3 + 4);
  const int nearest =
      situation.Find(affordances.FindCategory("Mug"), 1, affordances.FindAction("Drink"));
  EXPECT_EQ(situation.pairs[nearest].object, 2);
}

TEST(Situation, LeavesUnknownObjectsOut) {
  const Affordances affordances = TestAffordances();
  const Situation situation =
      MakeSituation(affordances, Things(affordances, {{"Unicorn", 0.1}, {"SprayCan", 1}}));
  EXPECT_EQ(situation.pair_count(), 1);
  EXPECT_EQ(situation.pairs[0].object, 1);
  EXPECT_EQ(situation.objects[0].rank, 0);
}

}  // namespace
}  // namespace beckon::intention
