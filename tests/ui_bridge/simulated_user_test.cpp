// What the simulated user sees and how it answers.
#include "services/ui_bridge/simulated_user.h"

#include <gtest/gtest.h>

namespace beckon::ui_bridge {
namespace {

msg::SceneObject Object(int id, const std::string& category, double y, float p = 0.9f) {
  msg::SceneObject object;
  object.id = id;
  object.category = category;
  object.probabilities = {{category, p}, {"Tub", 1 - p}};
  object.centroid_W = {0, y, 0.05};
  return object;
}

/// W is C turned so that z is up: the camera 0.5 m above the table, looking along y.
msg::Scene TestScene(std::vector<msg::SceneObject> objects) {
  msg::Scene scene;
  scene.seq = 1;
  scene.has_table = true;
  scene.X_WC.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  scene.X_WC.translation() = Eigen::Vector3d(0, 0, 0.5);
  scene.objects = std::move(objects);
  return scene;
}

TruthObject Truth(const std::string& category, double y, const msg::Scene& scene) {
  return {category, scene.X_WC.inverse() * Eigen::Vector3d(0.01, y, 0.06)};
}

msg::Query YesNo(msg::QueryKind kind, std::vector<std::string> actions,
                 std::vector<msg::ObjectRef> objects) {
  msg::Query query;
  query.id = 1;
  query.kind = kind;
  query.any_action = actions.empty();
  query.actions = std::move(actions);
  query.any_object = objects.empty();
  query.objects = std::move(objects);
  query.options = {{.text = "Yes"}, {.text = "No"}};
  return query;
}

msg::Query WhatIsIt(int id, const std::vector<std::string>& categories) {
  msg::Query query;
  query.id = 2;
  query.kind = msg::QueryKind::kWhatIsIt;
  query.objects = {{id, "Unknown", 1}};
  for (const auto& category : categories)
    query.options.push_back({"a " + category, category, {}, {id}});
  query.options.push_back({"None of these", msg::kUnknownCategory, {}, {id}});  // as intention does
  return query;
}

size_t Choice(const Response& response) {
  const auto* choice = std::get_if<Choose>(&response);
  return choice != nullptr ? choice->option : 999;
}

TEST(SimulatedUser, CannotTellBeforeItSeesAScene) {
  SimulatedUser user({.action = "Open", .category = "Carton"});
  EXPECT_TRUE(std::holds_alternative<CannotTell>(
      user.Respond(YesNo(msg::QueryKind::kAction, {"Open"}, {}))));
  user.SeeScene(msg::Scene{});  // without a table
  EXPECT_TRUE(std::holds_alternative<CannotTell>(
      user.Respond(YesNo(msg::QueryKind::kAction, {"Open"}, {}))));
}

TEST(SimulatedUser, AnswersPropositionsAboutTheNearestOfItsCategory) {
  SimulatedUser user({.action = "Open", .category = "Carton"});
  user.SeeScene(
      TestScene({Object(1, "Carton", 0.9), Object(2, "Carton", 0.6), Object(3, "Box", 0.4)}));
  using enum msg::QueryKind;
  EXPECT_EQ(Choice(user.Respond(YesNo(kAction, {"Open"}, {}))), 0u);
  EXPECT_EQ(Choice(user.Respond(YesNo(kAction, {"Grasp", "Open"}, {}))), 0u);
  EXPECT_EQ(Choice(user.Respond(YesNo(kAction, {"Grasp"}, {}))), 1u);
  EXPECT_EQ(Choice(user.Respond(YesNo(kObject, {}, {{2, "Carton", 1}}))), 0u);
  EXPECT_EQ(Choice(user.Respond(YesNo(kObject, {}, {{1, "Carton", 2}}))), 1u);
  EXPECT_EQ(Choice(user.Respond(YesNo(kSet, {}, {{3, "Box", 1}, {2, "Carton", 1}}))), 0u);
  EXPECT_EQ(Choice(user.Respond(YesNo(kFull, {"Open"}, {{2, "Carton", 1}}))), 0u);
  EXPECT_EQ(Choice(user.Respond(YesNo(kFull, {"Pour"}, {{2, "Carton", 1}}))), 1u);
  EXPECT_EQ(user.wanted_object(), 2);
}

TEST(SimulatedUser, RefusesItsObjectUnderAWrongName) {
  SimulatedUser user({.action = "Grasp", .category = "Carton"});
  auto scene = TestScene({Object(1, "Box", 0.5)});
  user.SetTruth({true, {Truth("Carton", 0.5, scene)}});
  user.SeeScene(scene);
  EXPECT_EQ(Choice(user.Respond(YesNo(msg::QueryKind::kFull, {"Grasp"}, {{1, "Box", 1}}))), 1u);
  EXPECT_EQ(Choice(user.Respond(WhatIsIt(1, {"Box", "Carton"}))), 1u);
  EXPECT_EQ(Choice(user.Respond(YesNo(msg::QueryKind::kFull, {"Grasp"}, {{1, "Carton", 1}}))), 0u);
}

TEST(SimulatedUser, SaysWhatTheTruthSays) {
  SimulatedUser user({.action = "Open", .category = "Carton"});
  auto scene = TestScene(
      {Object(1, "Tub", 0.5), Object(2, "Mug", 0.8), Object(3, "Cup", 1.2), Object(4, "Box", 1.6)});
  user.SetTruth(
      {true,
       {Truth("Carton", 0.5, scene), Truth("Bowl", 0.8, scene), Truth("Unsure", 1.2, scene)}});
  user.SeeScene(scene);
  EXPECT_EQ(Choice(user.Respond(WhatIsIt(1, {"Tub", "Carton"}))), 1u);
  EXPECT_EQ(Choice(user.Respond(WhatIsIt(2, {"Mug", "Cup"}))), 2u) << "a bowl is none of these";
  EXPECT_EQ(Choice(user.Respond(WhatIsIt(3, {"Mug", "Cup"}))), 2u) << "unsure";
  EXPECT_EQ(Choice(user.Respond(WhatIsIt(4, {"Mug", "Box"}))), 2u)
      << "nothing of the truth is there";
}

TEST(SimulatedUser, WithoutTruthWantsTheLikeliestWhereNoneWasRecognised) {
  SimulatedUser user({.action = "Grasp", .category = "Tub"});
  user.SeeScene(TestScene({Object(1, "Box", 0.5, 0.8f), Object(2, "Mug", 0.9, 0.6f)}));
  EXPECT_EQ(Choice(user.Respond(WhatIsIt(2, {"Mug", "Tub"}))), 1u);
  EXPECT_EQ(Choice(user.Respond(WhatIsIt(1, {"Tub", "Box"}))), 1u);
  EXPECT_EQ(user.wanted_object(), 2);
}

TEST(SimulatedUser, GivesUpWhereItsCategoryIsNowhere) {
  SimulatedUser user({.action = "Squeeze", .category = "Tube"});
  auto scene = TestScene({Object(1, "Box", 0.5)});
  user.SeeScene(scene);
  const auto response = user.Respond(YesNo(msg::QueryKind::kAction, {"Grasp"}, {}));
  const auto* give_up = std::get_if<GiveUp>(&response);
  ASSERT_NE(give_up, nullptr);
  EXPECT_NE(give_up->reason.find("Tube"), std::string::npos);
}

std::string ReasonToGiveUp(SimulatedUser& user) {
  const auto response = user.Respond(YesNo(msg::QueryKind::kAction, {"Grasp"}, {}));
  const auto* give_up = std::get_if<GiveUp>(&response);
  return give_up == nullptr ? "does not give up" : give_up->reason;
}

TEST(SimulatedUser, SaysWhetherItsObjectIsAbsentOrOnlyNotSegmented) {
  SimulatedUser user({.action = "Open", .category = "Box"});
  auto scene = TestScene({Object(1, "Box", 0.5)});
  user.SeeScene(scene);
  // One segment over a mug and the box behind it: its centroid is the mug's.
  user.SetTruth({true, {Truth("Mug", 0.5, scene), Truth("Box", 0.6, scene)}});
  EXPECT_EQ(ReasonToGiveUp(user),
            "no segment of the scene shows the wanted Box apart from its neighbours");
  user.SetTruth({true, {Truth("Mug", 0.5, scene)}});
  EXPECT_EQ(ReasonToGiveUp(user), "no object on the table is a Box (by the scene's ground truth)");
}

TEST(SimulatedUser, AnswersNoneOfTheseByTheOptionForIt) {
  SimulatedUser user({.action = "Grasp", .category = "Tube"});
  user.SeeScene(TestScene({Object(1, "Tube", 0.5), Object(2, "Box", 0.7)}));
  EXPECT_EQ(Choice(user.Respond(WhatIsIt(1, {"Box", "Cup"}))), 2u);
  EXPECT_EQ(Choice(user.Respond(WhatIsIt(2, {"Mug", "Cup"}))), 2u);
}

msg::Query TaskChoice(std::vector<msg::ObjectRef> objects, std::vector<msg::Option> options) {
  msg::Query query;
  query.id = 3;
  query.kind = msg::QueryKind::kChoice;
  query.objects = std::move(objects);
  query.options = std::move(options);
  return query;
}

TEST(SimulatedUser, ChoosesTheFirstOptionThatHolds) {
  SimulatedUser user({.action = "Open", .category = "Carton"});
  user.SeeScene(TestScene({Object(1, "Carton", 0.5), Object(2, "Box", 0.7)}));
  auto query = TaskChoice({{1, "Carton", 1}, {2, "Box", 1}},
                          {{"grasp the carton", "", {"Grasp"}, {1}},
                           {"open the box", "", {"Open"}, {2}},
                           {"open or grasp something here", "", {"Grasp", "Open"}, {1, 2}},
                           {"open the carton", "", {"Open"}, {1}},
                           {.text = "None of these"}});
  EXPECT_EQ(Choice(user.Respond(query)), 2u);
  query.options.erase(query.options.begin() + 2);
  EXPECT_EQ(Choice(user.Respond(query)), 2u);
  query.options.erase(query.options.begin() + 2);
  EXPECT_EQ(Choice(user.Respond(query)), 2u) << "none of these";
  query.options.pop_back();
  EXPECT_TRUE(std::holds_alternative<RefuseAll>(user.Respond(query)));
}

TEST(SimulatedUser, ChoosesAmongActionsAndAmongObjects) {
  SimulatedUser user({.action = "Open", .category = "Carton"});
  user.SeeScene(TestScene({Object(1, "Carton", 0.5), Object(2, "Box", 0.7)}));
  EXPECT_EQ(Choice(user.Respond(TaskChoice({}, {{"grasp", "", {"Grasp"}, {}},
                                                {"open", "", {"Open"}, {}},
                                                {.text = "None of these"}}))),
            1u);
  EXPECT_EQ(Choice(user.Respond(TaskChoice(
                {{1, "Carton", 1}, {2, "Box", 1}},
                {{"the box", "", {}, {2}}, {"the carton", "", {}, {1}}, {.text = "None"}}))),
            1u);
  EXPECT_EQ(Choice(user.Respond(TaskChoice(
                {{1, "Tub", 1}, {2, "Box", 1}},
                {{"the box", "", {}, {2}}, {"the tub", "", {}, {1}}, {.text = "None"}}))),
            2u)
      << "its carton is called a tub";
}

TEST(SimulatedUser, ASlippedChoiceIsAnyOtherOption) {
  SimulatedUser user({.action = "Open", .category = "Carton", .flip = 0.3, .seed = 4});
  user.SeeScene(TestScene({Object(1, "Carton", 0.5)}));
  const auto query = TaskChoice({{1, "Carton", 1}}, {{"grasp", "", {"Grasp"}, {1}},
                                                     {"open", "", {"Open"}, {1}},
                                                     {"pour", "", {"Pour"}, {1}},
                                                     {.text = "None of these"}});
  std::vector<int> chosen(4);
  for (int i = 0; i < 3000; ++i) ++chosen[Choice(user.Respond(query))];
  EXPECT_NEAR(chosen[1], 2100, 100);
  for (const int other : {0, 2, 3}) EXPECT_NEAR(chosen[other], 300, 70);
}

TEST(SimulatedUser, SlipsAsOftenAsToldAndTheSameWayForTheSameSeed) {
  const auto scene = TestScene({Object(1, "Carton", 0.5)});
  const auto run = [&](uint64_t seed) {
    SimulatedUser user({.action = "Open", .category = "Carton", .flip = 0.2, .seed = seed});
    user.SeeScene(scene);
    std::string answers;
    for (int i = 0; i < 1000; ++i) {
      answers +=
          Choice(user.Respond(YesNo(msg::QueryKind::kAction, {"Open"}, {}))) == 0 ? 'y' : 'n';
    }
    return answers;
  };
  const auto answers = run(5);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(answers, 'n')), 200, 50);
  EXPECT_EQ(answers, run(5));
  EXPECT_NE(answers, run(6));
}

TEST(SimulatedUser, KnowsItsObjectAgainByPlaceThenById) {
  SimulatedUser user({.action = "Open", .category = "Carton"});
  const auto is_it = [&user](int id) {
    return Choice(user.Respond(YesNo(msg::QueryKind::kObject, {}, {{id, "Carton", 1}}))) == 0;
  };
  user.SeeScene(TestScene({Object(1, "Carton", 0.5), Object(2, "Carton", 0.9)}));
  EXPECT_TRUE(is_it(1));
  // Perception came back with other ids.
  user.SeeScene(TestScene({Object(1, "Carton", 0.9), Object(11, "Carton", 0.51)}));
  EXPECT_TRUE(is_it(11));
  EXPECT_FALSE(is_it(1));
  user.SeeScene(TestScene({Object(1, "Carton", 0.9), Object(11, "Carton", 1.2)}));  // pushed away
  EXPECT_TRUE(is_it(11));
  user.SeeScene(TestScene({Object(1, "Carton", 0.9)}));  // out of sight
  EXPECT_TRUE(is_it(11));
  EXPECT_FALSE(is_it(1));
  user.ForgetSession();
  EXPECT_TRUE(is_it(1));
}

}  // namespace
}  // namespace beckon::ui_bridge
