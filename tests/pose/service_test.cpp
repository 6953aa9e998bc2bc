// SCENE in, POSES out, over an in-process bus.
#include "services/pose/service.h"

#include <gtest/gtest.h>

#include <optional>

#include "services/pose/pose_message.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

msg::Scene MakeScene(const TableView& view, int64_t seq) {
  msg::Scene scene;
  scene.utime = 1'000'000 * seq;
  scene.seq = seq;
  scene.frame_seq = seq;
  scene.source = "test";
  scene.width = 640;
  scene.height = 480;
  scene.has_table = true;
  scene.X_WC = WorldFromTable(view.table_C);
  msg::SceneObject& object = scene.objects.emplace_back();
  object.id = 7;
  object.points_C = view.points_C;
  object.n_points = static_cast<int>(view.points_C.size());
  for (const auto& p : view.points_C) {
    object.centroid_W += scene.X_WC * p.cast<double>() / static_cast<double>(view.points_C.size());
  }
  object.extent_W.setConstant(0.1);
  return scene;
}

const TableView& Box() {
  static const TableView view =
      ViewOnTable(MakeShape({0.03, 0.04, 0.06}, 0.1, 0.1, {0, 0, 0.06}, {0, 0, 0.5}), 2000, 0.001);
  return view;
}

TEST(SceneEstimatorTest, GivesPosesInTheTablesFrame) {
  SceneEstimator estimator{PoseConfig{}};
  const msg::Scene scene = MakeScene(Box(), 3);
  const msg::Poses poses = estimator.Estimate(scene);
  EXPECT_EQ(poses.utime, scene.utime);
  EXPECT_EQ(poses.scene_seq, 3);
  ASSERT_EQ(poses.poses.size(), 1u);
  const msg::ObjectPose& pose = poses.poses[0];
  EXPECT_EQ(pose.object_id, 7);
  EXPECT_TRUE(pose.converged) << pose.reason;
  const Pose truth = scene.X_WC * Box().shape_C.X_FO;
  EXPECT_LT((pose.X_WO.translation() - truth.translation()).norm(), 0.002);
  EXPECT_NEAR(pose.X_WO.translation().z(), 0.06, 0.001);
  EXPECT_GT(pose.covariance(0, 0), 0);
  ASSERT_FALSE(pose.grasps.empty());
  for (const auto& grasp : pose.grasps) EXPECT_GE(grasp.X_WG.translation().z(), 0.01 - 1e-6);
}

TEST(SceneEstimatorTest, ReusesWhatDidNotChangeAndRefitsWhatDid) {
  SceneEstimator estimator{PoseConfig{}};
  msg::Scene scene = MakeScene(Box(), 1);
  const msg::Poses first = estimator.Estimate(scene);
  scene.seq = 2;
  const msg::Poses second = estimator.Estimate(scene);
  EXPECT_EQ(estimator.counts().fitted, 1);
  EXPECT_EQ(estimator.counts().reused, 1);
  EXPECT_EQ(second.scene_seq, 2);
  EXPECT_EQ(first.poses[0].X_WO.matrix(), second.poses[0].X_WO.matrix());
  EXPECT_EQ(first.poses[0].fit_ms, second.poses[0].fit_ms);

  scene.objects[0].points_C.pop_back();
  estimator.Estimate(scene);
  EXPECT_EQ(estimator.counts().fitted, 2);
  scene.objects[0].id = 8;
  estimator.Estimate(scene);
  EXPECT_EQ(estimator.counts().fitted, 3);
  scene.objects[0].rim_C = {{scene.objects[0].points_C[0], Beyond::kFarther}};
  estimator.Estimate(scene);
  EXPECT_EQ(estimator.counts().fitted, 4);
  scene.objects[0].rim_C[0].beyond = Beyond::kNearer;
  estimator.Estimate(scene);
  EXPECT_EQ(estimator.counts().fitted, 5);
  scene.X_WC.translation().z() += 0.01;
  estimator.Estimate(scene);
  EXPECT_EQ(estimator.counts().fitted, 6);
  scene.has_table = false;
  EXPECT_TRUE(estimator.Estimate(scene).poses[0].grasps.empty());
  EXPECT_EQ(estimator.counts().fitted, 7);
}

TEST(SceneEstimatorTest, GraspsAnewWhenANeighbourComes) {
  SceneEstimator estimator{PoseConfig{}};
  msg::Scene scene = MakeScene(Box(), 1);
  const msg::Poses alone = estimator.Estimate(scene);
  msg::SceneObject neighbour = scene.objects[0];
  neighbour.id = 8;
  const Eigen::Vector3d aside_W = alone.poses[0].X_WO.linear().col(0) * 0.075;  // 15 mm between
  const Eigen::Vector3f aside_C = (scene.X_WC.linear().transpose() * aside_W).cast<float>();
  for (auto& p : neighbour.points_C) p += aside_C;
  scene.objects.push_back(neighbour);
  const msg::Poses together = estimator.Estimate(scene);
  EXPECT_EQ(estimator.counts().fitted, 2);
  EXPECT_EQ(estimator.counts().reused, 1);
  EXPECT_EQ(together.poses[0].X_WO.matrix(), alone.poses[0].X_WO.matrix());
  EXPECT_LT(together.poses[0].grasps.size(), alone.poses[0].grasps.size());
  scene.objects.pop_back();
  EXPECT_EQ(estimator.Estimate(scene).poses[0].grasps.size(), alone.poses[0].grasps.size());
}

TEST(SceneEstimatorTest, CountsWhatDidNotConverge) {
  SceneEstimator estimator{PoseConfig{}};
  msg::Scene scene = MakeScene(Box(), 1);
  scene.objects[0].points_C.resize(5);
  const msg::Poses poses = estimator.Estimate(scene);
  ASSERT_EQ(poses.poses.size(), 1u);
  EXPECT_FALSE(poses.poses[0].converged);
  EXPECT_FALSE(poses.poses[0].reason.empty());
  EXPECT_EQ(estimator.counts().not_converged, 1);
}

TEST(PoseMessage, PutsTheTableAtHeightZero) {
  const Pose X_WC = WorldFromTable(Box().table_C);
  const Plane table = TableInCamera(X_WC);
  EXPECT_LT((table.normal - Box().table_C.normal).norm(), 1e-9);
  EXPECT_NEAR(table.offset_m, Box().table_C.offset_m, 1e-9);
}

// A service on a bus and loop of its own; runs until POSES or STATUS satisfied `done`.
class PoseServiceTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto bus = Bus::Open("memq://");
    ASSERT_TRUE(bus);
    bus_ = std::move(*bus);
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    loop_.After(20 * kSecond, [this] { loop_.Stop(); });
    service_ = std::make_unique<PoseService>(*bus_, loop_, PoseConfig{});
    bus_->Subscribe<msg::Poses>([this](msg::Poses poses) {
      poses_.push_back(std::move(poses));
      loop_.Stop();
    });
  }

  RunLoop loop_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<PoseService> service_;
  std::vector<msg::Poses> poses_;
};

TEST_F(PoseServiceTest, AnswersASceneWithItsPoses) {
  ASSERT_TRUE(bus_->Publish(MakeScene(Box(), 5)));
  loop_.Run();
  ASSERT_EQ(poses_.size(), 1u);
  EXPECT_EQ(poses_[0].seq, 1);
  EXPECT_EQ(poses_[0].scene_seq, 5);
  ASSERT_EQ(poses_[0].poses.size(), 1u);
  EXPECT_TRUE(poses_[0].poses[0].converged);
  EXPECT_GT(poses_[0].poses[0].fit_ms, 0);
}

TEST_F(PoseServiceTest, AnswersAnEmptySceneWithNoPoses) {
  msg::Scene scene = MakeScene(Box(), 1);
  scene.objects.clear();
  scene.has_table = false;
  scene.X_WC = Pose::Identity();
  ASSERT_TRUE(bus_->Publish(scene));
  loop_.Run();
  ASSERT_EQ(poses_.size(), 1u);
  EXPECT_TRUE(poses_[0].poses.empty());
}

TEST_F(PoseServiceTest, CountsInItsStatus) {
  std::optional<msg::Status> status;
  bus_->Subscribe<msg::Status>([&](msg::Status s) {
    status = std::move(s);
    loop_.Stop();
  });
  ASSERT_TRUE(bus_->Publish(MakeScene(Box(), 1)));
  while (!status || poses_.empty()) loop_.Run();
  status.reset();
  while (!status) loop_.Run();
  EXPECT_EQ(status->service, "pose");
  std::map<std::string, int64_t> counters;
  for (const auto& c : status->counters) counters[c.name] = c.value;
  EXPECT_EQ(counters.at("scenes"), 1);
  EXPECT_EQ(counters.at("fitted"), 1);
  EXPECT_EQ(counters.at("dropped"), 0);
  EXPECT_EQ(counters.at("not_converged"), 0);
}

}  // namespace
}  // namespace beckon::pose
