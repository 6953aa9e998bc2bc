// The JSON that pages are told, field by field as docs/front-ends/web-api.md has it.
#include "services/ui_bridge/web/page_state.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "services/ui_bridge/web/scene_feed.h"

namespace beckon::ui_bridge::web {
namespace {

using Json = nlohmann::ordered_json;

msg::Query Question() {
  msg::Query query;
  query.id = 7;
  query.kind = msg::QueryKind::kFull;
  query.text = "Open the carton?";
  query.any_action = query.any_object = false;
  query.actions = {"Open"};
  query.objects = {{.object_id = 3, .category = "Carton", .instance = 1}};
  query.options = {{.text = "Yes"}, {.text = "No"}};
  query.prospects = {{.probability = 0.75f}, {.probability = 0.25f, .questions_left = 2}};
  query.why = "because";
  query.likeliest = {{.action = "Open",
                      .object = {.object_id = 3, .category = "Carton", .instance = 1},
                      .prior = 0.1,
                      .posterior = 0.75,
                      .times = 4,
                      .sessions_ago = 2}};
  return query;
}

TEST(PageState, OfNothingYetHasEveryField) {
  const Json json = ToJson(PageState{.user = "ann"});
  for (const char* key : {"query", "task", "highlight", "settings_trial"})
    EXPECT_TRUE(json.at(key).is_null()) << key;
  EXPECT_EQ(json["stopped"], false);
  EXPECT_EQ(json["phase"], "idle");
  EXPECT_EQ(json["event"], Json::parse(R"({"kind": "idle", "text": ""})"));
  EXPECT_EQ(json["user"], "ann");
  EXPECT_EQ(json["controls"], Json::array());
}

TEST(PageState, SaysWhatAYesMeans) {
  PageState state{.query = Question(), .answered = true};
  Json query = ToJson(state)["query"];
  EXPECT_EQ(query["kind"], "full");
  EXPECT_EQ(query["answered"], true);
  EXPECT_EQ(query["yes_if"]["actions"], Json::parse(R"(["Open"])"));
  EXPECT_EQ(query["yes_if"]["objects"],
            Json::parse(R"([{"category": "Carton", "instance": 1, "object_id": 3}])"));
  EXPECT_EQ(query["options"][0]["text"], "Yes");
  EXPECT_EQ(query["options"][1]["probability"], 0.25);
  EXPECT_EQ(query["options"][1]["questions_left"], 2);
  EXPECT_EQ(query["likeliest"][0]["sessions_ago"], 2);
  state.query->any_action = state.query->any_object = true;
  state.query->prospects.clear();
  query = ToJson(state)["query"];
  EXPECT_TRUE(query["yes_if"]["actions"].is_null());
  EXPECT_TRUE(query["yes_if"]["objects"].is_null());
  EXPECT_TRUE(query["options"][0]["probability"].is_null());
}

TEST(PageState, TellsATaskAndWhatBecameOfIt) {
  PageState state;
  state.task = msg::Task{.action = "Open", .object = {3, "Carton", 2}};
  state.task->centroid_W = {0.1, 0.5, 0.04};
  Json task = ToJson(state)["task"];
  EXPECT_EQ(task["position_W"], Json::parse("[0.1, 0.5, 0.04]"));
  EXPECT_EQ(task["instance"], 2);
  EXPECT_TRUE(task["state"].is_null());
  state.task->has_pose = true;
  state.task->pose.X_WO.translation() = Eigen::Vector3d(1, 2, 3);
  for (const auto& [value, name] : {std::pair{msg::TaskState::kAccepted, "accepted"},
                                    {msg::TaskState::kRunning, "running"},
                                    {msg::TaskState::kDone, "done"},
                                    {msg::TaskState::kFailed, "failed"},
                                    {msg::TaskState::kExpired, "expired"},
                                    {msg::TaskState::kRevoked, "revoked"}}) {
    state.task_status = msg::TaskStatus{.state = value, .text = "so"};
    task = ToJson(state)["task"];
    EXPECT_EQ(task["state"], name);
    EXPECT_EQ(task["text"], "so");
  }
  EXPECT_EQ(task["position_W"], Json::parse("[1.0, 2.0, 3.0]"));
}

TEST(PageState, NamesPhaseAndEvent) {
  PageState state{.phase = Phase::kStopped, .event = msg::SessionKind::kStopped};
  EXPECT_EQ(ToJson(state)["stopped"], true);
  EXPECT_EQ(ToJson(state)["event"]["kind"], "stopped");
  state = {.phase = Phase::kRunning, .event = msg::SessionKind::kBegun};
  EXPECT_EQ(ToJson(state)["phase"], "running");
  EXPECT_EQ(ToJson(state)["event"]["kind"], "begun");
}

/// A camera 1 m above the table that looks straight down on it: C's x is W's x, its y is -y.
msg::Scene SceneFromAbove() {
  msg::Scene scene;
  scene.seq = 5;
  scene.has_table = true;
  scene.X_WC =
      Eigen::Translation3d(0, 0, 1) * Eigen::AngleAxisd(3.14159265358979, Eigen::Vector3d::UnitX());
  scene.objects.resize(2);
  scene.objects[0].id = 3;
  scene.objects[0].category = "Can";
  scene.objects[0].confidence = 0.987f;
  scene.objects[0].outline_px = {{1, 2}, {3, 4}};
  scene.objects[1].id = 4;
  return scene;
}

TEST(SceneJson, HoldsShapesAsTheCameraSeesThem) {
  msg::Poses poses;
  poses.poses.resize(2);
  poses.poses[0].object_id = 3;
  poses.poses[0].X_WO.translation() = Eigen::Vector3d(0.1, 0.2, 0.05);
  poses.poses[0].semi_axes = {0.03, 0.03, 0.05};
  poses.poses[1].object_id = 99;  // of a scene that is gone
  const Json json = ToJson(SceneFromAbove(), &poses);
  ASSERT_EQ(json["superquadrics"].size(), 1u);
  const Json& shape = json["superquadrics"][0];
  EXPECT_EQ(shape["object_id"], 3);
  EXPECT_NEAR(shape["position_C"][0], 0.1, 1e-4);
  EXPECT_NEAR(shape["position_C"][1], -0.2, 1e-4);
  EXPECT_NEAR(shape["position_C"][2], 0.95, 1e-4);
  EXPECT_NEAR(std::abs(shape["rotation_C"][1].get<double>()), 1, 1e-4);
  EXPECT_EQ(json["objects"][0]["outline_px"], Json::parse("[[1, 2], [3, 4]]"));
  EXPECT_EQ(json["objects"][0]["confidence"], 0.99);
}

TEST(SceneFeed, IsAnewOnlyWhenSomethingLooksDifferent) {
  SceneFeed feed;
  EXPECT_FALSE(feed.Refresh());
  EXPECT_TRUE(feed.json().is_null());
  msg::Scene scene = SceneFromAbove();
  feed.OnScene(scene);
  EXPECT_TRUE(feed.Refresh());
  EXPECT_EQ(feed.json()["seq"], 5);
  scene.seq = 6;
  feed.OnScene(scene);
  EXPECT_FALSE(feed.Refresh()) << "the same again";
  EXPECT_EQ(feed.json()["seq"], 5);
  scene.seq = 7;
  scene.objects[0].outline_px[0] = {9, 9};
  feed.OnScene(scene);
  EXPECT_TRUE(feed.Refresh());
  EXPECT_EQ(feed.json()["seq"], 7);
  msg::Poses poses;
  poses.poses.resize(1);
  poses.poses[0].object_id = 3;
  feed.OnPoses(poses);
  EXPECT_TRUE(feed.Refresh());
}

TEST(SceneFeed, TakesAPictureThatIsNotTheOneBefore) {
  SceneFeed feed;
  msg::Frame frame{.seq = 1, .colour_codec = msg::ColourCodec::kJpeg, .colour = {1, 2, 3}};
  feed.OnFrame(frame);
  EXPECT_TRUE(feed.Refresh());
  EXPECT_EQ(feed.frame_seq(), 1);
  EXPECT_EQ(feed.image_type(), "image/jpeg");
  frame.seq = 2;
  feed.OnFrame(frame);
  EXPECT_FALSE(feed.Refresh()) << "a still picture, repeated";
  frame.seq = 3;
  frame.colour_codec = msg::ColourCodec::kPng;
  frame.colour.push_back(4);
  feed.OnFrame(frame);
  EXPECT_TRUE(feed.Refresh());
  EXPECT_EQ(feed.frame_seq(), 3);
  EXPECT_EQ(feed.image_type(), "image/png");
  EXPECT_EQ(*feed.image(), std::string("\1\2\3\4"));
  feed.OnFrame({.seq = 4});
  EXPECT_TRUE(feed.Refresh());
  EXPECT_FALSE(feed.frame_seq());
  EXPECT_EQ(feed.image(), nullptr);
}

TEST(ProfileJson, TellsThePast) {
  msg::Profile profile{.user = "ann", .users = {"ann", "bob"}, .n_sessions = 9};
  profile.recent = {
      {.utime = 5, .action = "Open", .category = "Can", .questions = 3, .device = "d"}};
  const Json json = ToJson(profile);
  EXPECT_EQ(json["users"], Json::parse(R"(["ann", "bob"])"));
  EXPECT_EQ(json["recent"][0]["questions"], 3);
}

}  // namespace
}  // namespace beckon::ui_bridge::web
