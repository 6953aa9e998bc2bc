// Objects of no category: what can be done with any object can be done with them.
#include "services/intention/affordances_file.h"
#include "services/intention/core/question.h"
#include "services/intention/phrases_file.h"
#include "tests/intention/conversation_fixture.h"

namespace beckon::intention {
namespace {

const std::vector<std::string> kGeneric = {"Grasp", "Move", "Push"};

TEST(UnknownAffordances, AreACategoryOfTheirOwn) {
  const Affordances all = TestAffordances(kGeneric);
  EXPECT_EQ(all.FindCategory("Unknown"), all.unknown());
  EXPECT_FALSE(all.IsNamed(all.unknown()));
  EXPECT_FALSE(all.IsNamed(-1));
  EXPECT_TRUE(all.IsNamed(all.FindCategory("Tub")));
  EXPECT_TRUE(all.Affords(all.unknown(), all.FindAction("Move")));
  EXPECT_FALSE(all.Affords(all.unknown(), all.FindAction("Open")));
}

TEST(UnknownAffordances, LeaveThePairsOfTheDissertationWithoutThem) {
  const Affordances named = TestAffordances(kGeneric).Named();
  EXPECT_EQ(named.pair_count(), 36);
  EXPECT_EQ(named.categories().size(), 11u);
  EXPECT_EQ(named.unknown(), -1);
  EXPECT_EQ(TestAffordances().unknown(), -1);
}

TEST(UnknownAffordances, RefuseActionsThatAreNone) {
  const auto made =
      Affordances::Make({{"Open", "open"}}, {{"Box", {"Open"}}}, std::vector<std::string>{"Fly"});
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().message.find("'Fly'"), std::string::npos);
}

TEST(UnknownAffordances, StandInTheFileThatShips) {
  const auto read = ReadAffordances(BECKON_SOURCE_DIR "/services/intention/affordances.toml");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_TRUE(read->Affords(read->unknown(), read->FindAction("Grasp")));
  EXPECT_TRUE(read->Affords(read->unknown(), read->FindAction("Move")));
  EXPECT_EQ(read->Named().pair_count(), 36);
}

class UnknownTest : public ::testing::Test {
 protected:
  /// Sure to be none of the categories.
  static msg::SceneObject Unknown(int id, double x, double y) {
    msg::SceneObject object = SceneObject(id, msg::kUnknownCategory, x, y);
    object.probabilities = {{msg::kUnknownCategory, 0.95f}, {"Box", 0.05f}};
    return object;
  }
  static msg::SceneObject Doubtful(int id, double x, double y) {
    msg::SceneObject object = SceneObject(id, msg::kUnknownCategory, x, y, 0.3f);
    object.ask_user = true;
    object.probabilities = {{msg::kUnknownCategory, 0.4f},
                            {"Box", 0.3f},
                            {"Carton", 0.1f},
                            {"Tin", 0.1f},
                            {"Can", 0.1f}};
    return object;
  }
  FakeMemory memory;
  Desk desk{memory, kGeneric};
};

TEST_F(UnknownTest, ATaskIsPublishedForOne) {
  desk.Show(SceneOf({SceneObject(1, "Mug", 0, 0.4), Unknown(2, -0.2, 0.5)}));
  desk.Start();
  const msg::Session end = desk.Converse({"Move", 2, msg::kUnknownCategory});
  EXPECT_EQ(end.text, "Move the unknown object.");
  ASSERT_EQ(desk.tasks.size(), 1u);
  EXPECT_EQ(desk.tasks[0].object.object_id, 2);
  EXPECT_EQ(desk.tasks[0].object.category, msg::kUnknownCategory);
  for (const msg::Query& query : desk.queries)
    EXPECT_NE(query.kind, msg::QueryKind::kWhatIsIt) << "perception is sure";
}

TEST_F(UnknownTest, TheSecondTimeItIsExpected) {
  const msg::Scene scene = SceneOf({SceneObject(1, "Mug", 0, 0.4), Unknown(2, -0.2, 0.5)});
  desk.Show(scene);
  desk.Start();
  desk.Converse({"Move", 2, msg::kUnknownCategory});
  const size_t before = desk.queries.size();
  desk.Show(scene);
  desk.Start("s2");
  EXPECT_EQ(desk.queries[before].text, "Move the unknown object?");
}

TEST_F(UnknownTest, SeveralAreToldApartByTheirPlace) {
  desk.Show(SceneOf({Unknown(1, -0.3, 0.5), Unknown(2, 0.3, 0.6), Unknown(3, 0, 0.4)}));
  desk.Start();
  const msg::Session end = desk.Converse({"Grasp", 1, msg::kUnknownCategory});
  EXPECT_EQ(end.text, "Grasp the second unknown object.");
  EXPECT_EQ(desk.tasks.at(0).object.object_id, 1);
}

TEST_F(UnknownTest, OneInDoubtIsAskedAboutFirstAndNotOfferedAsUnknown) {
  desk.Show(SceneOf({SceneObject(1, "Mug", 0, 0.4), Doubtful(2, 0.2, 0.5)}));
  desk.Start();
  const msg::Query query = desk.queries.back();
  ASSERT_EQ(query.kind, msg::QueryKind::kWhatIsIt);
  std::vector<std::string> offered;
  for (const auto& option : query.options) offered.push_back(option.category);
  EXPECT_EQ(offered, (std::vector<std::string>{"Box", "Carton", "Tin", "Can", "Unknown"}));
  EXPECT_EQ(desk.Converse({"Open", 2, "Box"}, {{2, "Box"}}).text, "Open the box.");
}

TEST_F(UnknownTest, OneThatWasRefusedAllCategoriesOfCanStillBeMoved) {
  desk.Show(SceneOf({SceneObject(1, "Mug", 0, 0.4), Doubtful(2, 0.2, 0.5)}));
  desk.Start();
  desk.Answer(desk.queries.back(), 4);
  EXPECT_EQ(desk.Converse({"Move", 2, msg::kUnknownCategory}).text, "Move the unknown object.");
  ASSERT_EQ(memory.labels.size(), 1u);
  EXPECT_EQ(memory.labels[0].category, msg::kUnknownCategory);
}

TEST_F(UnknownTest, ACategoryThatNobodyKnowsIsUnknownToo) {
  desk.Show(SceneOf({SceneObject(1, "Unicorn", 0, 0.4)}));
  desk.Start();
  EXPECT_EQ(desk.Converse({"Push", 1, msg::kUnknownCategory}).text, "Push the unknown object.");
}

TEST_F(UnknownTest, WhereItsTasksAreRefusedItIsAskedAboutBeforeGivingUp) {
  desk.Announce("switch", 0, 12);
  desk.Show(SceneOf({Unknown(1, 0, 0.4)}));
  desk.Start();
  for (int i = 0; i < 20 && desk.queries.back().kind != msg::QueryKind::kWhatIsIt; ++i)
    desk.Answer(desk.queries.back(), 1);
  ASSERT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  EXPECT_EQ(desk.Converse({"Squeeze", 1, "Tube"}, {{1, "Tube"}}).text, "Squeeze the tube.");
}

TEST_F(UnknownTest, EveryWishOnRandomTablesWithThemIsFound) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 60; ++round) {
    std::vector<msg::SceneObject> objects;
    const int n = 1 + static_cast<int>(random() % 5);
    for (int id = 1; id <= n; ++id) {
      const double x = 0.1 * id - 0.3, y = 0.3 + 0.05 * static_cast<double>(random() % 10);
      objects.push_back(random() % 2 == 0 ? Unknown(id, x, y) : SceneObject(id, "Mug", x, y));
    }
    const auto& wanted = objects[random() % objects.size()];
    const bool unknown = wanted.category == msg::kUnknownCategory;
    FakeMemory fresh;
    Desk table(fresh, kGeneric);
    table.Show(SceneOf(objects));
    table.Start();
    const auto end = table.Converse({unknown ? "Push" : "Drink", wanted.id, wanted.category});
    ASSERT_EQ(end.kind, msg::SessionKind::kConfirmed) << end.text;
    EXPECT_EQ(table.tasks.at(0).object.object_id, wanted.id);
  }
}

TEST(UnknownWords, AreRightInEnglishAndGerman) {
  const Affordances affordances = TestAffordances(kGeneric);
  const int unknown = affordances.unknown();
  const Situation two = MakeSituation(affordances, {{unknown, 0.4, -0.2}, {unknown, 0.6, 0.2}});
  const Situation one = MakeSituation(affordances, {{unknown, 0.4, 0}});
  const auto grasp = [&](const Situation& situation, const Phrases& phrases) {
    return TaskText(affordances, situation, {0, affordances.FindAction("Grasp")}, phrases);
  };
  const auto read = ReadPhrases(BECKON_SOURCE_DIR "/services/intention/questions.de.toml");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(grasp(one, English()), "Grasp the unknown object");
  EXPECT_EQ(grasp(two, English()), "Grasp the nearest unknown object");
  EXPECT_EQ(grasp(one, *read), "Das unbekannte Objekt greifen");
  EXPECT_EQ(grasp(two, *read), "Das vorderste unbekannte Objekt greifen");
  EXPECT_EQ(ANoun(English(), "Unknown"), "an unknown object");
  EXPECT_EQ(ANoun(*read, "Unknown"), "ein unbekanntes Objekt");
  const Question both{QuestionKind::kCategory, {{kAny, 0b11, -1}}};
  EXPECT_EQ(Text(affordances, two, both, English()), "Is it about one of the unknown objects?");
  EXPECT_EQ(Text(affordances, two, both, *read), "Geht es um eines der unbekannten Objekte?");
}

}  // namespace
}  // namespace beckon::intention
