#include "tests/lcmtypes/examples.h"

#include "lcmtypes/frame_image.h"

namespace beckon::msg {
namespace {

Pose ExamplePose() {
  Pose pose = Pose::Identity();
  pose.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  pose.translation() = Eigen::Vector3d(0.1, 0.6, 0.05);
  return pose;
}

ObjectPose ExampleObjectPose() {
  ObjectPose pose;
  pose.object_id = 2;
  pose.X_WO = ExamplePose();
  pose.semi_axes = {0.03, 0.04, 0.1};
  pose.epsilon = {0.1, 1.0};
  pose.taper = {0.1, -0.1};
  pose.mean_radial_distance_m = 0.001f;
  pose.converged = true;
  pose.ambiguous = true;
  pose.reason = "box or cylinder";
  pose.covariance.setIdentity();
  pose.alternatives = {
      {.X_WO = ExamplePose(), .semi_axes = {0.03, 0.03, 0.1}, .epsilon = {0.1, 0.2}}};
  pose.parts = {{.X_WO = ExamplePose(), .semi_axes = {0.02, 0.03, 0.1}, .taper = {0.5, 0}},
                {.X_WO = Pose::Identity(), .semi_axes = {0.01, 0.02, 0.03}}};
  pose.grasps = {{.X_WG = ExamplePose(), .opening_m = 0.08, .score = 0.9f}};
  pose.fit_ms = 1.5f;
  return pose;
}

}  // namespace

Frame ExampleFrame() {
  RgbdImage image{.width = 8, .height = 6, .intrinsics = {}, .depth_m = {}, .colour = {}};
  for (int i = 0; i < 48; ++i) {
    image.depth_m.push_back(i % 7 == 0 ? 0.f : 0.5f + 0.01f * static_cast<float>(i));
    image.colour.push_back({static_cast<uint8_t>(i * 5), 100, 200});
  }
  Frame frame{.utime = 1, .seq = 2, .source = "example"};
  const auto encoded = EncodeImage(image, 1e-4, 95, frame);
  (void)encoded;
  return frame;
}

Seal ExampleSeal() {
  Seal seal{.sender = "kitchen/test", .counter = 7, .expires_utime = 99};
  seal.key_id.fill(3);
  seal.signature.fill(9);
  return seal;
}

Scene ExampleScene() {
  Scene scene{
      .utime = 1, .seq = 2, .frame_seq = 3, .source = "example", .width = 640, .height = 480};
  scene.intrinsics = {600, 610, 330, 250};
  scene.seal = ExampleSeal();
  scene.has_table = true;
  scene.X_WC = ExamplePose();
  scene.table_W = {{-0.5, 0.2}, {0.5, 0.2}, {0, 1}};
  for (int id : {4, 5}) {
    SceneObject object;
    object.id = id;
    object.category = "Carton";
    object.confidence = 0.8f;
    object.ask_user = id == 5;
    object.probabilities = {{"Carton", 0.75f}, {"Box", 0.25f}};
    object.centroid_W = {0.1, 0.5, 0.1};
    object.extent_W = {0.06, 0.07, 0.2};
    object.n_points = 1234;
    object.points_C = {{0.1f, 0.2f, 0.9f}, {0.11f, 0.2f, 0.9f}, {0.1f, 0.1f, 0.95f}};
    object.rim_C = {{{0.1f, 0.2f, 0.91f}, Beyond::kFarther},
                    {{0.12f, 0.2f, 0.9f}, Beyond::kNearer},
                    {{0.1f, 0.11f, 0.95f}, Beyond::kImageBorder}};
    object.outline_px = {{100, 100}, {120, 100}, {110, 160}};
    scene.objects.push_back(object);
  }
  scene.segmentation_ms = 200;
  scene.categorisation_ms = 50;
  return scene;
}

Poses ExamplePoses() {
  return {.utime = 1,
          .seq = 2,
          .scene_seq = 3,
          .poses = {ExampleObjectPose(), ExampleObjectPose()},
          .seal = ExampleSeal()};
}

Interface ExampleInterface() {
  Interface interface {
    .utime = 1, .device = "console@test", .kind = InterfaceKind::kChoice, .max_options = 3
  };
  interface.false_yes = 0.05f;
  interface.false_no = 0.1f;
  interface.confusion = {{0.9f, 0.1f}, {0.2f, 0.8f}};
  interface.seal = ExampleSeal();
  return interface;
}

Query ExampleQuery() {
  Query query{.utime = 1, .id = 2, .session_id = "s", .user = "ann", .kind = QueryKind::kFull};
  query.text = "Open the carton?";
  query.any_action = false;
  query.actions = {"Open"};
  query.any_object = false;
  query.objects = {{.object_id = 4, .category = "Carton", .instance = 1}};
  query.options = {
      {.text = "Yes", .category = "Carton", .actions = {"Grasp", "Open"}, .objects = {4, 5}},
      {.text = "No"}};
  query.scene_seq = 2;
  query.questions_asked = 1;
  query.n_candidates = 12;
  query.expected_questions = 2.5;
  query.expected_seconds = 20;
  query.best_posterior = 0.4;
  query.why = "You wanted to open the carton in 7 of the last 9 sessions.";
  query.information_bits = 0.97;
  query.prospects = {{.probability = 0.4f, .questions_left = 0, .seconds_left = 0},
                     {.probability = 0.6f, .questions_left = 2.5f, .seconds_left = 20}};
  query.likeliest = {{.action = "Open",
                      .object = query.objects[0],
                      .prior = 0.3,
                      .posterior = 0.4,
                      .times = 7,
                      .sessions_ago = 2},
                     {.action = "Pour",
                      .object = {.object_id = 5, .category = "Carton", .instance = 2},
                      .prior = 0.1,
                      .posterior = 0.2,
                      .times = 0,
                      .sessions_ago = 0}};
  query.seal = ExampleSeal();
  return query;
}

Answer ExampleAnswer() {
  return {.utime = 1,
          .query_id = 2,
          .session_id = "s",
          .device = "console@test",
          .likelihoods = {1, 0},
          .seal = ExampleSeal()};
}

Session ExampleSession() {
  return {.utime = 1,
          .session_id = "s",
          .user = "ann.b-c_1",
          .device = "console@test",
          .kind = SessionKind::kBegun,
          .questions = 2,
          .text = "waiting for a scene",
          .seal = ExampleSeal()};
}

Task ExampleTask() {
  Task task{.utime = 1, .task_id = "s", .user = "ann", .action = "Open"};
  task.object = {.object_id = 4, .category = "Carton", .instance = 1};
  task.centroid_W = {0.1, 0.5, 0.1};
  task.has_pose = true;
  task.pose = ExampleObjectPose();
  task.X_WC = ExamplePose();
  task.posterior = 0.995;
  task.questions = 3;
  task.expires_utime = 30'000'001;
  task.seal = ExampleSeal();
  return task;
}

TaskStatus ExampleTaskStatus() {
  return {.utime = 1,
          .task_id = "s",
          .state = TaskState::kDone,
          .text = "opened",
          .seal = ExampleSeal()};
}

Label ExampleLabel() {
  return {.utime = 5,
          .label_id = "s/label/4",
          .session_id = "s",
          .user = "ann",
          .state = LabelState::kGiven,
          .category = "Mug",
          .source = "example",
          .scene_seq = 2,
          .scene_utime = 1,
          .object_id = 4,
          .seal = ExampleSeal()};
}

Profile ExampleProfile() {
  return {.utime = 5,
          .user = "ann",
          .users = {"ann", "ben"},
          .n_sessions = 12,
          .recent = {{.utime = 3,
                      .action = "Open",
                      .category = "Carton",
                      .instance = 1,
                      .questions = 4,
                      .device = "switch@kitchen"},
                     {.utime = 4, .action = "Grasp", .category = "Mug", .questions = 1}},
          .seal = ExampleSeal()};
}

Highlight ExampleHighlight() {
  return {.utime = 5,
          .device = "switch@kitchen",
          .user = "ann",
          .query_id = 7,
          .options = {0, 2},
          .controls = {"undo"},
          .pressed = true,
          .paused = false,
          .dwell_ms = 1000,
          .seal = ExampleSeal()};
}

Stimulus ExampleStimulus() {
  return {.utime = 5,
          .device = "bci@kitchen",
          .trial = 9,
          .query_id = 7,
          .repetition = 2,
          .mode = StimulusMode::kMatrix,
          .rows = 1,
          .columns = 3,
          .labels = {"Open", "Grasp", ""},
          .seal = ExampleSeal()};
}

Decoding ExampleDecoding() {
  return {.utime = 6,
          .decoder = "p300",
          .device = "bci@kitchen",
          .trial = 9,
          .probabilities = {0.5, 0.25, 0.25},
          .seal = ExampleSeal()};
}

History ExampleHistory() {
  return {.utime = 1,
          .machine = "kitchen",
          .run = "3f2a",
          .complete = true,
          .digests = {{.origin = "kitchen", .highest_seq = 12, .checksum = -5}},
          .rows = {{.origin = "kitchen",
                    .seq = 12,
                    .hybrid_utime = 7,
                    .kind = "session",
                    .body = "{\"a\": 1}"}},
          .seal = ExampleSeal()};
}

Lease ExampleLease() {
  return {.utime = 5,
          .user = "ann",
          .session_id = "s",
          .holder = "kitchen",
          .run = "3f2a",
          .term = 3,
          .remaining_ms = 1500,
          .seal = ExampleSeal()};
}

Status ExampleStatus() {
  return {.utime = 1,
          .service = "pose",
          .host = "lab",
          .pid = 5,
          .started_utime = 1,
          .build = "0.1.0",
          .state = "5 objects",
          .counters = {{"frames", 12}, {"dropped", 0}}};
}

}  // namespace beckon::msg
