// The pose service: newest SCENE in, POSES out.
#pragma once

#include <memory>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/bus.h"
#include "services/base/latest_worker.h"
#include "services/base/run_loop.h"
#include "services/base/status_reporter.h"
#include "services/pose/estimate.h"

namespace beckon::pose {

/// What became of the scenes so far; STATUS carries it.
struct PoseCounts {
  int64_t scenes = 0;         // answered by POSES
  int64_t fitted = 0;         // objects
  int64_t reused = 0;         // objects whose points, rim, table and camera had not changed
  int64_t not_converged = 0;  // of those fitted
};

/// Estimates every object of a scene; objects that look exactly as in the last scene keep their
/// pose, and their grasps too where all of the scene does.
class SceneEstimator {
 public:
  explicit SceneEstimator(const PoseConfig& config) : config_(config) {}

  /// POSES for `scene`; `seq` is left 0.
  msg::Poses Estimate(const msg::Scene& scene);
  const PoseCounts& counts() const { return counts_; }

 private:
  struct Known {
    std::vector<Eigen::Vector3f> points_C;
    std::vector<RimPoint> rim_C;
    bool has_table;
    Pose X_WC;
    FitResult fit;
    double fit_ms = 0;  // of the fit alone
    msg::ObjectPose pose;
  };

  static FitInput InputOf(const Known& known, const msg::Scene& scene);
  Known* FindSame(const msg::SceneObject& object, const msg::Scene& scene);
  Known FitOne(const msg::SceneObject& object, const msg::Scene& scene);
  void GraspAll(const msg::Scene& scene);

  const PoseConfig config_;
  std::vector<Known> known_;  // the objects of the last scene, in its order
  PoseCounts counts_;
};

/// Estimates in a worker thread, publishes in the loop's; scenes that cannot be kept up with are
/// skipped and counted. Bus and loop outlive it, and the loop does not run after it is gone.
class PoseService {
 public:
  PoseService(Bus& bus, RunLoop& loop, const PoseConfig& config);

 private:
  void Publish(msg::Poses poses, const PoseCounts& counts);
  void FillStatus(msg::Status& status) const;

  Bus& bus_;
  RunLoop& loop_;
  int64_t seq_ = 0;
  PoseCounts counts_;  // as of the last POSES
  double last_ms_ = 0;
  std::unique_ptr<SceneEstimator> estimator_;  // used in the worker's thread only
  std::unique_ptr<LatestWorker<msg::Scene>> worker_;
  std::unique_ptr<StatusReporter> status_;
};

}  // namespace beckon::pose
