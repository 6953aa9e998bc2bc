// The pose service: newest SCENE in, POSES out.
#include "services/pose/service.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "services/pose/pose_message.h"

namespace beckon::pose {

msg::Poses SceneEstimator::Estimate(const msg::Scene& scene) {
  msg::Poses poses;
  poses.utime = scene.utime;
  poses.scene_seq = scene.seq;
  std::map<int, Known> now;
  for (const msg::SceneObject& object : scene.objects) {
    poses.poses.push_back(EstimateOne(object, scene));
    now[object.id] = {object.points_C, object.rim_C, scene.X_WC, poses.poses.back()};
  }
  FitDatagram(poses);
  known_ = std::move(now);
  ++counts_.scenes;
  return poses;
}

msg::ObjectPose SceneEstimator::EstimateOne(const msg::SceneObject& object,
                                            const msg::Scene& scene) {
  const auto known = known_.find(object.id);
  if (known != known_.end() && known->second.points_C == object.points_C &&
      known->second.rim_C == object.rim_C && known->second.X_WC.matrix() == scene.X_WC.matrix()) {
    ++counts_.reused;
    return known->second.pose;
  }
  const Stopwatch stopwatch;
  FitInput input;
  input.points_F = object.points_C;
  input.rim_F = object.rim_C;
  if (scene.has_table) input.table_F = TableInCamera(scene.X_WC);
  const pose::Estimate estimate = EstimateObject(input, config_);
  ++counts_.fitted;
  if (!estimate.fit.converged) ++counts_.not_converged;
  return ToMessage(estimate, scene.X_WC, object.id, stopwatch.Milliseconds());
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
