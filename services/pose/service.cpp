// The pose service: newest SCENE in, POSES out.
#include "services/pose/service.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "services/pose/pose_message.h"

namespace beckon::pose {

msg::Poses SceneEstimator::Estimate(const msg::Scene& scene) {
  std::vector<Known> now;
  bool changed = scene.objects.size() != known_.size();
  for (const msg::SceneObject& object : scene.objects) {
    if (Known* same = FindSame(object, scene)) {
      now.push_back(std::move(*same));
      ++counts_.reused;
    } else {
      now.push_back(FitOne(object, scene));
      changed = true;
    }
  }
  known_ = std::move(now);
  if (changed) GraspAll(scene);

  msg::Poses poses;
  poses.utime = scene.utime;
  poses.scene_seq = scene.seq;
  for (const Known& known : known_) poses.poses.push_back(known.pose);
  FitDatagram(poses);
  ++counts_.scenes;
  return poses;
}

SceneEstimator::Known* SceneEstimator::FindSame(const msg::SceneObject& object,
                                                const msg::Scene& scene) {
  const auto known = std::find_if(known_.begin(), known_.end(), [&](const Known& k) {
    return k.pose.object_id == object.id && k.points_C == object.points_C &&
           k.rim_C == object.rim_C && k.has_table == scene.has_table &&
           k.X_WC.matrix() == scene.X_WC.matrix();
  });
  return known == known_.end() ? nullptr : &*known;
}

FitInput SceneEstimator::InputOf(const Known& known, const msg::Scene& scene) {
  FitInput input;
  input.points_F = known.points_C;
  input.rim_F = known.rim_C;
  if (scene.has_table) input.table_F = TableInCamera(scene.X_WC);
  return input;
}

SceneEstimator::Known SceneEstimator::FitOne(const msg::SceneObject& object,
                                             const msg::Scene& scene) {
  const Stopwatch stopwatch;
  Known known{object.points_C, object.rim_C, scene.has_table, scene.X_WC, {}, 0, {}};
  known.fit = FitObject(InputOf(known, scene), config_.fit);
  known.fit_ms = stopwatch.Milliseconds();
  known.pose.object_id = object.id;
  ++counts_.fitted;
  if (!known.fit.converged) ++counts_.not_converged;
  return known;
}

// Who moves, comes or goes changes how its neighbours can be grasped.
void SceneEstimator::GraspAll(const msg::Scene& scene) {
  std::vector<Obstacle> obstacles;
  for (const Known& known : known_) {
    obstacles.push_back(MakeObstacle(known.points_C, known.fit, config_.gripper.clearance_m));
  }
  for (size_t i = 0; i < known_.size(); ++i) {
    Known& known = known_[i];
    const Stopwatch stopwatch;
    const pose::Estimate estimate{
        known.fit, GraspObject(InputOf(known, scene), known.fit, {obstacles, i}, config_.gripper)};
    known.pose = ToMessage(estimate, scene.X_WC, known.pose.object_id,
                           known.fit_ms + stopwatch.Milliseconds());
  }
}

PoseService::PoseService(Bus& bus, RunLoop& loop, const PoseConfig& config)
    : bus_(bus), loop_(loop), estimator_(std::make_unique<SceneEstimator>(config)) {
  worker_ = std::make_unique<LatestWorker<msg::Scene>>([this](msg::Scene scene) {
    const Stopwatch stopwatch;
    msg::Poses poses = estimator_->Estimate(scene);
    const double ms = stopwatch.Milliseconds();
    loop_.Post([this, ms, poses = std::move(poses), counts = estimator_->counts()]() mutable {
      last_ms_ = ms;
      Publish(std::move(poses), counts);
    });
  });
  bus_.Subscribe<msg::Scene>([this](msg::Scene scene) { worker_->Offer(std::move(scene)); }, 1);
  status_ = std::make_unique<StatusReporter>("pose", bus_, loop_,
                                             [this](msg::Status& status) { FillStatus(status); });
}

void PoseService::Publish(msg::Poses poses, const PoseCounts& counts) {
  counts_ = counts;
  poses.seq = ++seq_;
  if (const Status sent = bus_.Publish(poses); !sent) spdlog::error("{}", sent.error().message);
}

void PoseService::FillStatus(msg::Status& status) const {
  status.state = seq_ == 0 ? "waiting for a scene"
                           : "the last scene took " + std::to_string(last_ms_).substr(0, 5) + " ms";
  status.counters.push_back({"scenes", counts_.scenes});
  status.counters.push_back({"dropped", worker_->dropped()});
  status.counters.push_back({"fitted", counts_.fitted});
  status.counters.push_back({"reused", counts_.reused});
  status.counters.push_back({"not_converged", counts_.not_converged});
}

}  // namespace beckon::pose
