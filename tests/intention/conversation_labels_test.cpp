// What the user says an object is goes to perception: at once, again and again until a scene shows
// it, and no longer than it holds.
#include "tests/intention/conversation_fixture.h"

namespace beckon::intention {
namespace {

using Kind = msg::SessionKind;
using msg::LabelState;

msg::SceneObject Doubtful(int id, double x, double y) {
  msg::SceneObject object = SceneObject(id, "Box", x, y, 0.3f);
  object.ask_user = true;
  object.probabilities = {
      {"Box", 0.4f}, {"Carton", 0.3f}, {"Tin", 0.1f}, {"Can", 0.1f}, {"Tub", 0.1f}};
  return object;
}

class LabelsTest : public ::testing::Test {
 protected:
  void Begin() {
    desk.Show(scene);
    desk.Start();
    ASSERT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  }
  /// A scene as perception shows it once it was told.
  msg::Scene Told(const std::string& category) const {
    msg::Scene told = scene;
    ++told.seq;
    told.utime += kSecond;
    told.objects[1].category = category;
    told.objects[1].ask_user = false;
    told.objects[1].probabilities = {{category, 0.97f}, {"Box", 0.03f}};
    return told;
  }
  size_t LabelsIn(Utime duration) {
    desk.labels.clear();
    desk.Wait(duration);
    return desk.labels.size();
  }

  FakeMemory memory;
  Desk desk{memory, {"Grasp", "Move"}};
  const msg::Scene scene = SceneOf({SceneObject(1, "Mug", 0, 0.4), Doubtful(2, 0.2, 0.5)});
};

TEST_F(LabelsTest, AnAnswerIsToldAtOnceAndRepeatedUntilASceneShowsIt) {
  Begin();
  EXPECT_TRUE(desk.labels.empty());
  desk.Answer(desk.queries.back(), 1);
  ASSERT_EQ(desk.labels.size(), 1u);
  const msg::Label label = desk.labels.back();
  EXPECT_EQ(label.state, LabelState::kGiven);
  EXPECT_EQ(label.category, "Carton");
  EXPECT_EQ(label.object_id, 2);
  EXPECT_EQ(label.user, "ann");
  EXPECT_EQ(label.session_id, "s1");
  EXPECT_EQ(label.source, "test");
  EXPECT_EQ(label.scene_seq, scene.seq);
  EXPECT_EQ(label.scene_utime, scene.utime);

  EXPECT_GE(LabelsIn(2 * kSecond), 3u);
  for (const msg::Label& again : desk.labels) {
    EXPECT_EQ(again.label_id, label.label_id);
    EXPECT_EQ(again.utime, label.utime) << "the same label";
  }
  desk.Show(Told("Carton"));
  EXPECT_EQ(LabelsIn(2 * kSecond), 0u);
}

TEST_F(LabelsTest, ASceneThatShowsSomethingElseEndsNothing) {
  Begin();
  desk.Answer(desk.queries.back(), 1);
  desk.Show(Told("Tin"));
  EXPECT_GE(LabelsIn(2 * kSecond), 3u);
}

TEST_F(LabelsTest, UndoTakesItBackAndAnotherAnswerTellsAnew) {
  Begin();
  desk.Answer(desk.queries.back(), 1);
  const msg::Label first = desk.labels.back();
  desk.Request(Kind::kRequestUndo);
  const msg::Label back = desk.labels.back();
  EXPECT_EQ(back.state, LabelState::kRetracted);
  EXPECT_EQ(back.label_id, first.label_id);
  EXPECT_GT(back.utime, first.utime);
  ASSERT_EQ(desk.queries.back().kind, msg::QueryKind::kWhatIsIt);
  desk.Answer(desk.queries.back(), 2);
  EXPECT_EQ(desk.labels.back().state, LabelState::kGiven);
  EXPECT_EQ(desk.labels.back().category, "Tin");
  EXPECT_EQ(desk.labels.back().label_id, first.label_id);
  EXPECT_GT(desk.labels.back().utime, back.utime);
}

TEST_F(LabelsTest, ASessionThatIsCancelledOrStoppedTellsNothing) {
  Begin();
  desk.Answer(desk.queries.back(), 1);
  desk.Show(Told("Carton"));
  desk.Request(Kind::kRequestCancel);
  ASSERT_EQ(desk.labels.back().state, LabelState::kRetracted);
  EXPECT_GE(LabelsIn(3 * kSecond), 3u) << "it may be lost";
  desk.Wait(10 * kSecond);
  EXPECT_EQ(LabelsIn(3 * kSecond), 0u);

  desk.Show(scene);
  desk.Start("s2");
  desk.Answer(desk.queries.back(), 1);
  EXPECT_EQ(desk.labels.back().state, LabelState::kGiven);
  desk.Request(Kind::kRequestStop, "s2");
  EXPECT_EQ(desk.labels.back().state, LabelState::kRetracted);
}

TEST_F(LabelsTest, WhatASessionEndedWithIsRepeatedForAWhile) {
  Begin();
  desk.Converse({"Pour", 2, "Carton"}, {{2, "Carton"}});
  ASSERT_EQ(memory.labels.size(), 1u);
  EXPECT_EQ(memory.labels[0].id, desk.labels.back().label_id);
  EXPECT_GE(LabelsIn(10 * kSecond), 15u);
  EXPECT_EQ(desk.labels.back().state, LabelState::kGiven);
  desk.Wait(25 * kSecond);
  EXPECT_EQ(LabelsIn(5 * kSecond), 0u);
}

TEST_F(LabelsTest, AnObjectIsCalledByTheIdThatPerceptionHasForItNow) {
  Begin();
  desk.Answer(desk.queries.back(), 1);
  msg::Scene restarted = scene;  // as after kill -9: ids and numbers begin anew
  restarted.seq = 1;
  restarted.utime = desk.now;
  std::swap(restarted.objects[0].id, restarted.objects[1].id);
  desk.Show(restarted);
  EXPECT_GE(LabelsIn(kSecond), 1u);
  EXPECT_EQ(desk.labels.back().object_id, 1);
  EXPECT_EQ(desk.labels.back().scene_seq, 1);
  EXPECT_EQ(desk.labels.back().scene_utime, restarted.utime);
}

TEST_F(LabelsTest, NoneOfTheseIsUnknownUntilItIsNamed) {
  Begin();
  desk.Answer(desk.queries.back(), 4);
  ASSERT_EQ(desk.labels.size(), 1u);
  EXPECT_EQ(desk.labels.back().category, msg::kUnknownCategory);
}

TEST_F(LabelsTest, AnObjectStaysItselfWhenPerceptionSaysWhatItWasToldAndBeginsAnew) {
  desk.Watch(scene.objects);
  desk.Start();
  desk.Answer(desk.queries.back(), 1);
  const msg::Scene told = Told("Carton");
  desk.Watch(told.objects, 2 * kSecond);
  std::vector<msg::SceneObject> renumbered = told.objects;
  for (msg::SceneObject& object : renumbered) object.id += 10;
  desk.seq = 0;
  desk.Watch(renumbered, 2 * kSecond);
  EXPECT_EQ(desk.Converse({"Pour", 12, "Carton"}).text, "Pour from the carton.");
}

}  // namespace
}  // namespace beckon::intention
