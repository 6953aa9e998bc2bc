// Objects in doubt, what is remembered of them, and what happens when every task was refused.
#include <set>

#include "tests/intention/conversation_fixture.h"

namespace beckon::intention {
namespace {

using Kind = msg::SessionKind;

msg::SceneObject Doubtful(int id, double x, double y) {
  msg::SceneObject object = SceneObject(id, "Box", x, y, 0.2f);
  object.ask_user = true;
  object.probabilities = {
      {"Box", 0.4f}, {"Carton", 0.3f}, {"Tin", 0.1f}, {"Can", 0.1f}, {"Tub", 0.1f}};
  return object;
}

class InterviewTest : public testing::Test {
 protected:
  void Begin(const msg::Scene& scene, const std::string& id = "s1") {
    desk.Announce("switch");
    desk.Show(scene);
    desk.Start(id);
  }
  FakeMemory memory;
  Desk desk{memory};
};

TEST_F(InterviewTest, AsksWhatADoubtfulObjectIs) {
  Begin(SceneOf({SceneObject(1, "Mug", 0, 0.4), Doubtful(2, 0.2, 0.5)}));
  const msg::Query query = desk.queries.back();
  EXPECT_EQ(query.kind, msg::QueryKind::kWhatIsIt);
  EXPECT_EQ(query.text, "What is this object?");
  ASSERT_EQ(query.options.size(), 5u);
  EXPECT_EQ(query.options[0].text, "a box");
  EXPECT_EQ(query.options[1].category, "Carton");
  EXPECT_EQ(query.options[4].text, "None of these");
  EXPECT_EQ(query.options[4].category, "Unknown");
  ASSERT_EQ(query.objects.size(), 1u);
  EXPECT_EQ(query.objects[0].object_id, 2);
  const msg::Session end = desk.Converse({"Pour", 2, "Carton"}, {{2, "Carton"}});
  EXPECT_EQ(end.text, "Pour from the carton.");
  ASSERT_EQ(memory.labels.size(), 1u);
  EXPECT_EQ(memory.labels[0].category, "Carton");
}

TEST_F(InterviewTest, RemembersTheAnswerForThatObject) {
  const msg::Scene scene = SceneOf({SceneObject(1, "Mug", 0, 0.4), Doubtful(2, 0.2, 0.5)});
  Begin(scene);
  desk.Converse({"Pour", 2, "Carton"}, {{2, "Carton"}});
  desk.Start("s2");
  EXPECT_EQ(desk.queries.back().text,
            "Pour from the carton?");  // neither the label nor the habit is asked anew
  desk.Request(Kind::kRequestCancel, "s2");
  msg::Scene moved = scene;
  moved.objects[1].centroid_W.x() += 0.05;
  desk.Show(moved);
  desk.Start("s3");
  EXPECT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);  // another place: another object
  desk.Request(Kind::kRequestCancel, "s3");
  msg::Scene elsewhere = scene;
  elsewhere.source = "another camera";
  desk.Show(elsewhere);
  desk.Start("s4");
  EXPECT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  desk.Request(Kind::kRequestCancel, "s4");
  msg::Scene swapped = scene;
  swapped.objects[1].extent_W.z() += 0.08;
  desk.Show(swapped);
  desk.Start("s5");
  EXPECT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
}

TEST_F(InterviewTest, NoneOfTheseMakesAnObjectUnknown) {
  Begin(SceneOf({SceneObject(1, "Mug", 0, 0.4), Doubtful(2, 0.2, 0.5)}));
  desk.Request(Kind::kRequestNoneOfThese);
  for (int i = 0; i < 50 && desk.events.back().kind == Kind::kBegun; ++i) {
    const msg::Query query = desk.queries.back();
    ASSERT_NE(query.kind, msg::QueryKind::kWhatIsIt);
    for (const auto& object : query.objects) EXPECT_EQ(object.object_id, 1);
    desk.Answer(query, Desk::Honest(query, {"Drink", 1, "Mug"}, {}));
  }
  EXPECT_EQ(desk.events.back().text, "Drink from the mug.");
}

std::vector<std::string> Offered(const msg::Query& query) {
  std::vector<std::string> categories;
  for (const auto& option : query.options) categories.push_back(option.category);
  return categories;
}

TEST_F(InterviewTest, OffersTheOtherCategoriesBeforeItGivesUp) {
  desk.Announce("switch", 0, 12);
  desk.Show(SceneOf({SceneObject(1, "Mug", 0, 0.4), Doubtful(2, 0.2, 0.5)}));
  desk.Start();
  desk.Answer(desk.queries.back(), 4);
  EXPECT_NE(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);  // the mug first
  while (desk.queries.back().kind != msg::QueryKind::kWhatIsIt) {
    ASSERT_EQ(desk.events.back().kind, Kind::kBegun);
    desk.Answer(desk.queries.back(), 1);
  }
  // Tub has a probability, the others follow by name.
  EXPECT_EQ(Offered(desk.queries.back()),
            (std::vector<std::string>{"Tub", "Bottle", "Bowl", "Cup", "Mug", "SprayCan", "Tube",
                                      "Unknown"}));
  EXPECT_EQ(desk.queries.back().objects[0].object_id, 2);
  desk.Answer(desk.queries.back(), 6);
  EXPECT_EQ(desk.Converse({"Squeeze", 2, "Tube"}).text, "Squeeze the tube.");
  ASSERT_EQ(memory.labels.size(), 1u);
  EXPECT_EQ(memory.labels[0].category, "Tube");
}

TEST_F(InterviewTest, OffersTheOtherCategoriesAtOnceWhereNoKnownObjectIsLeft) {
  Begin(SceneOf({Doubtful(2, 0.2, 0.5)}));
  desk.Answer(desk.queries.back(), 4);
  ASSERT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  EXPECT_EQ(Offered(desk.queries.back()).front(), "Tub");
  EXPECT_EQ(desk.queries.back().options.size(), 8u);  // all seven and none of them
  EXPECT_EQ(desk.Converse({"Squeeze", 2, "Tube"}, {{2, "Tube"}}).text, "Squeeze the tube.");
}

TEST_F(InterviewTest, OffersNoMoreAtOnceThanTheInterfaceShows) {
  desk.Announce("switch", 0, 4);
  desk.Show(SceneOf({Doubtful(2, 0.2, 0.5)}));
  desk.Start();
  std::vector<size_t> sizes;
  std::set<std::string> offered;
  while (desk.events.back().kind == Kind::kBegun) {
    const msg::Query query = desk.queries.back();
    ASSERT_EQ(query.kind, msg::QueryKind::kWhatIsIt);
    sizes.push_back(query.options.size());
    for (size_t i = 0; i + 1 < query.options.size(); ++i)
      EXPECT_TRUE(offered.insert(query.options[i].category).second) << "offered twice";
    desk.Answer(query, query.options.size() - 1);
  }
  EXPECT_EQ(sizes, (std::vector<size_t>{4, 2, 4, 4, 2}));  // 3 + 1 at first, the other 7 later
  EXPECT_EQ(offered.size(), 11u);
  EXPECT_EQ(desk.events.back().kind, Kind::kAbandoned);
  ASSERT_EQ(memory.labels.size(), 1u);
  EXPECT_EQ(memory.labels[0].category, "Unknown");
}

TEST_F(InterviewTest, AnObjectOfRefusedCategoriesIsAskedAboutAgainOnlyBeforeGivingUp) {
  const msg::Scene scene = SceneOf({SceneObject(1, "Mug", 0, 0.4), Doubtful(2, 0.2, 0.5)});
  Begin(scene);
  desk.Converse({"Drink", 1, "Mug"});  // not asked about the other thing but once
  ASSERT_EQ(memory.labels.size(), 1u);
  EXPECT_EQ(memory.labels[0].category, "Unknown");
  desk.Announce("switch", 0, 12);
  desk.Start("s2");
  EXPECT_EQ(desk.queries.back().text, "Drink from the mug?");
  desk.Request(Kind::kRequestNoneOfThese, "s2");
  ASSERT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  EXPECT_EQ(desk.queries.back().objects[0].object_id, 2);
  EXPECT_EQ(desk.queries.back().options.size(), 12u);  // at once: the likeliest were refused before
  EXPECT_EQ(desk.Converse({"Squeeze", 2, "Tube"}, {{2, "Tube"}}).text, "Squeeze the tube.");
  EXPECT_EQ(memory.labels.back().category, "Tube");
  desk.Start("s3");
  EXPECT_EQ(desk.queries.back().text, "Squeeze the tube?");
}

TEST_F(InterviewTest, ATableOfUnknownObjectsIsAskedAboutInEverySession) {
  const msg::Scene scene = SceneOf({Doubtful(2, 0.2, 0.5)});
  for (const char* id : {"s1", "s2"}) {
    desk.Clear();
    Begin(scene, id);
    int questions = 0;
    for (; desk.events.back().kind == Kind::kBegun; ++questions)
      desk.Answer(desk.queries.back(), desk.queries.back().options.size() - 1);
    EXPECT_EQ(desk.events.back().kind, Kind::kAbandoned);
    EXPECT_EQ(questions, 2);
  }
}

TEST_F(InterviewTest, RechecksAConfidentErrorThroughAllCategories) {
  Begin(SceneOf({SceneObject(1, "Mug", 0, 0.4), SceneObject(2, "Can", 0.2, 0.5, 0.6f)}));
  const std::map<int, std::string> really = {{1, "Mug"}, {2, "SprayCan"}};
  EXPECT_EQ(desk.Converse({"Grasp", 2, "SprayCan"}, really).text, "Grasp the spray can.");
}

TEST_F(InterviewTest, TasksThatWereRefusedAreNotAskedAgainWhenAnObjectBecomesUnknown) {
  desk.Announce("switch", 0, 5);
  desk.Show(SceneOf({SceneObject(1, "Mug", 0, 0.4, 0.9f), SceneObject(2, "Can", 0.2, 0.5, 0.6f),
                     SceneObject(3, "Bowl", 0.4, 0.5, 0.9f)}));
  desk.Start();
  desk.Request(Kind::kRequestNoneOfThese);
  const std::map<int, std::string> really = {{1, "Mug"}, {2, "SprayCan"}, {3, "Bowl"}};
  const Wish wish{"Grasp", 2, "SprayCan"};
  for (int i = 0; i < 3; ++i) {  // can tube bottle bowl, box carton cup mug, spray can tin tub
    ASSERT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt) << i;
    EXPECT_EQ(desk.queries.back().objects[0].object_id, 2);
    desk.Answer(desk.queries.back(), Desk::Honest(desk.queries.back(), wish, really));
  }
  EXPECT_EQ(desk.Converse(wish, really).text, "Grasp the spray can.");
}

TEST_F(InterviewTest, AnAnswerMeansWhatWasOfferedWhateverTheInterfaceBecomes) {
  Begin(SceneOf({Doubtful(2, 0.2, 0.5)}));
  desk.Answer(desk.queries.back(), 3);  // a can
  desk.Announce("switch", 0, 2);
  EXPECT_EQ(desk.Converse({"Drink", 2, "Can"}, {{2, "Can"}}).text, "Drink from the can.");
  EXPECT_EQ(memory.labels[0].category, "Can");
}

TEST_F(InterviewTest, ASwitchWithTwoOptionsIsAskedOneCategoryAtATime) {
  desk.Announce("switch", 0, 2);
  desk.Show(SceneOf({Doubtful(2, 0.2, 0.5)}));
  desk.Start();
  ASSERT_EQ(desk.queries.back().options.size(), 2u);
  EXPECT_EQ(desk.queries.back().options[0].category, "Box");
  desk.Answer(desk.queries.back(), 1);
  EXPECT_EQ(desk.queries.back().options[0].category, "Carton");
  desk.Answer(desk.queries.back(), 0);
  EXPECT_NE(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  EXPECT_EQ(desk.Converse({"Pour", 2, "Carton"}).kind, Kind::kConfirmed);
}

TEST_F(InterviewTest, UndoTakesALabelBack) {
  Begin(SceneOf({SceneObject(1, "Mug", 0, 0.4), Doubtful(2, 0.2, 0.5)}));
  desk.Answer(desk.queries.back(), 0);
  ASSERT_NE(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  desk.Request(Kind::kRequestUndo);
  EXPECT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  desk.Converse({"Pour", 2, "Carton"}, {{2, "Carton"}});
  ASSERT_EQ(memory.labels.size(), 1u);
  EXPECT_EQ(memory.labels[0].category, "Carton");
}

TEST_F(InterviewTest, CancelForgetsALabelOfTheSession) {
  Begin(SceneOf({SceneObject(1, "Mug", 0, 0.4), Doubtful(2, 0.2, 0.5)}));
  desk.Answer(desk.queries.back(), 0);
  desk.Request(Kind::kRequestCancel);
  EXPECT_TRUE(memory.labels.empty());
}

TEST_F(InterviewTest, AConfidentErrorEndsInAQuestionNotInAWrongTask) {
  msg::SceneObject mistaken = SceneObject(2, "Can", 0.2, 0.5, 0.6f);
  mistaken.probabilities = {{"Can", 0.6f}, {"Carton", 0.3f}, {"Tin", 0.1f}};
  Begin(SceneOf({SceneObject(1, "Mug", 0, 0.4), mistaken}));
  const msg::Session end = desk.Converse({"Open", 2, "Carton"}, {{1, "Mug"}, {2, "Carton"}});
  EXPECT_EQ(end.kind, Kind::kConfirmed);
  EXPECT_EQ(end.text, "Open the carton.");
  ASSERT_EQ(memory.labels.size(), 1u);
  EXPECT_EQ(memory.labels[0].category, "Carton");
}

TEST_F(InterviewTest, RechecksTheLeastSureFirstThenGivesUp) {
  Begin(SceneOf({SceneObject(1, "Mug", 0, 0.4, 0.9f), SceneObject(2, "Box", 0.2, 0.5, 0.5f)}));
  desk.Request(Kind::kRequestNoneOfThese);
  ASSERT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  EXPECT_EQ(desk.queries.back().objects[0].object_id, 2);
  desk.Answer(desk.queries.back(), 0);  // it is a box
  EXPECT_EQ(desk.queries.back().objects[0].object_id, 1);
  desk.Answer(desk.queries.back(), 0);
  EXPECT_EQ(desk.events.back().kind, Kind::kAbandoned);
  EXPECT_NE(desk.events.back().text.find("none of the tasks"), std::string::npos);
  EXPECT_TRUE(desk.tasks.empty());
}

TEST_F(InterviewTest, AsksAboutUnknownObjectsWhereNothingElseIsThere) {
  Begin(SceneOf({SceneObject(1, msg::kUnknownCategory, 0, 0.4)}));
  const msg::Query query = desk.queries.back();
  EXPECT_EQ(query.kind, msg::QueryKind::kWhatIsIt);
  EXPECT_EQ(query.options.size(), 8u);  // as many as the device can show; no opinion to go by
  EXPECT_EQ(desk.Converse({"Push", 1, "Bowl"}, {{1, "Bowl"}}).text, "Push the bowl.");
}

TEST_F(InterviewTest, SoftChoicesAddUpUntilDecided) {
  Begin(SceneOf({Doubtful(2, 0.2, 0.5)}));
  for (int i = 0; i < 2; ++i) {
    const msg::Query query = desk.queries.back();
    ASSERT_EQ(query.kind, msg::QueryKind::kWhatIsIt);
    msg::Answer answer = desk.AnswerTo(query, 1);
    answer.likelihoods = {0.075, 0.7, 0.075, 0.075, 0.075};
    desk.Take(desk.conversation->OnAnswer(answer, ++desk.now));
  }
  EXPECT_NE(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  EXPECT_EQ(desk.Converse({"Pour", 2, "Carton"}).kind, Kind::kConfirmed);
}

TEST_F(InterviewTest, EveryWishOnRandomTablesIsFound) {
  std::mt19937_64 random(17);
  for (int trial = 0; trial < 60; ++trial) {
    const auto things = RandomThings(desk.affordances, random, 10, true);
    msg::Scene scene = SceneOf({});
    for (size_t i = 0; i < things.size(); ++i) {
      const std::string category = desk.affordances.categories()[things[i].category].name;
      scene.objects.push_back(SceneObject(static_cast<int>(i) + 1, category, things[i].lateral_m,
                                          things[i].distance_m));
    }
    const size_t wanted = random() % things.size();
    const auto& category = desk.affordances.categories()[things[wanted].category];
    const int action = category.actions[random() % category.actions.size()];
    desk.Clear();
    Begin(scene, "trial" + std::to_string(trial));
    const Wish wish{desk.affordances.actions()[action].name, static_cast<int>(wanted) + 1,
                    category.name};
    EXPECT_EQ(desk.Converse(wish).kind, Kind::kConfirmed);
    ASSERT_FALSE(desk.tasks.empty());
    EXPECT_EQ(desk.tasks.back().action, wish.action);
    EXPECT_EQ(desk.tasks.back().object.object_id, wish.object_id);
  }
}

}  // namespace
}  // namespace beckon::intention
