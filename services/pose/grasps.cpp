// Candidate grasps of a fitted object for a parallel gripper.
#include "services/pose/grasps.h"

#include <algorithm>
#include <cmath>

#include "services/pose/grasp_evaluation.h"

namespace beckon::pose {
namespace {

constexpr double kApart_m = 0.02;   // grasps this far apart differ
constexpr double kApart_rad = 0.4;  // and those turned by this
constexpr int kMostOfAKind = 8;     // before the other kinds had their chance

// How different two grasps are, 1 being enough; a gripper turned by half a turn about its approach
// is the same.
double Difference(const Pose& a, const Pose& b) {
  const Eigen::Matrix3d turn = a.linear().transpose() * b.linear();
  const double approach = std::acos(std::clamp(turn(2, 2), -1.0, 1.0));
  const double closing = std::acos(std::min(std::abs(turn(0, 0)), 1.0));
  return (a.translation() - b.translation()).norm() / kApart_m +
         std::max(approach, closing) / kApart_rad;
}

// Takes the best, again and again, that differs from all taken. Obstacles are looked at only when a
// grasp's turn has come: they can only lower its score, so that the order is that of full scores.
class Selection {
  // For a heap whose top has the highest score, the earliest of those that are equal.
  auto Later() const {
    return [this](size_t a, size_t b) {
      const double score_a = rated_[a].grasp.score, score_b = rated_[b].grasp.score;
      return score_a != score_b ? score_a < score_b : a > b;
    };
  }

 public:
  Selection(const GraspEvaluation& evaluation, std::vector<RatedGrasp> rated)
      : evaluation_(evaluation), rated_(std::move(rated)) {
    for (size_t i = 0; i < rated_.size(); ++i) order_.push_back(i);
    std::make_heap(order_.begin(), order_.end(), Later());
  }

  std::vector<GraspCandidate> Take() {
    std::vector<size_t> surplus;
    while (!order_.empty() && taken_.size() < kMostGrasps) {
      std::pop_heap(order_.begin(), order_.end(), Later());
      const size_t i = order_.back();
      order_.pop_back();
      if (!Differs(rated_[i])) continue;
      if (!rated_[i].settled) {
        if (evaluation_.Settle(rated_[i])) Push(i);
        continue;
      }
      int& of_kind = of_kind_[static_cast<int>(rated_[i].kind)];
      if (of_kind == kMostOfAKind) {
        surplus.push_back(i);
        continue;
      }
      ++of_kind;
      taken_.push_back(rated_[i].grasp);
    }
    for (const size_t i : surplus) {
      if (taken_.size() < kMostGrasps && Differs(rated_[i])) taken_.push_back(rated_[i].grasp);
    }
    std::stable_sort(taken_.begin(), taken_.end(),
                     [](const auto& a, const auto& b) { return a.score > b.score; });
    return std::move(taken_);
  }

 private:
  void Push(size_t i) {
    order_.push_back(i);
    std::push_heap(order_.begin(), order_.end(), Later());
  }
  bool Differs(const RatedGrasp& rated) const {
    return std::all_of(taken_.begin(), taken_.end(), [&](const GraspCandidate& other) {
      return Difference(rated.grasp.X_FG, other.X_FG) >= 1;
    });
  }

  const GraspEvaluation& evaluation_;
  std::vector<RatedGrasp> rated_;
  std::vector<size_t> order_;
  int of_kind_[kApproachKinds] = {};
  std::vector<GraspCandidate> taken_;
};

}  // namespace

std::vector<GraspCandidate> ProposeGrasps(const FitResult& fit,
                                          std::span<const Eigen::Vector3f> points_F,
                                          const Plane& table_F, const Obstacles& obstacles,
                                          const GripperConfig& gripper) {
  if (!fit.converged) return {};
  const GraspedBody body(fit.shape);
  const Standing standing = StandOn(body, table_F);
  const GraspEvaluation evaluation(fit, body, standing, table_F, obstacles, gripper);
  std::vector<RatedGrasp> rated;
  for (const GraspIdea& idea : FindDirections(body, standing, gripper)) {
    if (const auto grasp = evaluation.Rate(idea)) rated.push_back(*grasp);
  }
  const OpenRim rim = FindOpenRim(points_F, table_F, gripper);
  for (const RimPinch& pinch : rim.pinches) {
    if (const auto grasp = evaluation.RatePinch(pinch, rim.seen)) rated.push_back(*grasp);
  }
  return Selection(evaluation, std::move(rated)).Take();
}

}  // namespace beckon::pose
