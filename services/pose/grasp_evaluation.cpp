// Whether a gripper can do what a grasp's idea wants of it, and how well.
#include "services/pose/grasp_evaluation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beckon::pose {
namespace {

constexpr double kSlipWeight = 0.25, kCentreWeight = 0.25, kOpeningWeight = 0.2, kHoldWeight = 0.15,
                 kFreeWeight = 0.15;     // of the score; they sum to 1
constexpr double kLeastHold_m = 0.002;   // of the object between the fingers
constexpr double kPads = 0.25;           // of the fingers, tips to where they had best touch
constexpr double kFreeEnough = 3;        // clearances from an obstacle that could not be better
constexpr double kCautiousGap = 2;       // clearances at most, where the pose is uncertain
constexpr double kDescends = 0.3;        // cosine: moving back lifts the gripper
constexpr double kLeastSlip_rad = 1e-6;  // so that nothing is divided by 0
constexpr double kKnownTurn_rad = 0.1;
constexpr double kRounding_m = 1e-9;

Pose PoseOf(const GraspIdea& idea, const Eigen::Vector3d& tips_F) {
  Pose X_FG = Pose::Identity();
  X_FG.linear() << idea.closing_F, idea.approach_F.cross(idea.closing_F), idea.approach_F;
  X_FG.translation() = tips_F;
  return X_FG;
}

// A score without the digits that rounding makes, which would decide between equals.
double Score(double value) {
  constexpr double kSteps = 1e6;
  return std::round(std::clamp(value, 0.0, 1.0) * kSteps) / kSteps;
}

Plane Raised(const Plane& plane, double height_m) {
  return {plane.normal, plane.offset_m - height_m};
}

// What lies between fingers, along the closing direction from the body's centre.
struct Span {
  double forward_m, backward_m;
};
Span Between(const GraspedBody& body, const Pose& X_FG, double finger_half_width_m) {
  const Eigen::Vector3d closing = X_FG.linear().col(0), across = X_FG.linear().col(1);
  const double offset_m = across.dot(X_FG.translation() - body.centre_F());
  const double forward_m = body.ReachInSlab(closing, across, offset_m, finger_half_width_m);
  if (std::abs(offset_m) < kRounding_m) return {forward_m, forward_m};  // it is centrally symmetric
  return {forward_m, body.ReachInSlab(-closing, across, offset_m, finger_half_width_m)};
}

}  // namespace

GraspEvaluation::GraspEvaluation(const FitResult& fit, const GraspedBody& body,
                                 const Standing& standing, const Plane& table_F,
                                 const Obstacles& obstacles, const GripperConfig& gripper)
    : body_(body),
      standing_(standing),
      table_F_(table_F),
      floor_F_(Raised(table_F, standing.bottom_m)),
      obstacles_(obstacles),
      gripper_(gripper),
      spread_(body, fit.covariance) {
  for (const Superquadric& other : fit.alternatives) alternatives_.emplace_back(other);
}

// How far beyond the centre's level, along the approach, the tips may go: where the contacts are
// well inside the fingers, if neither palm nor floor is in the way; none where too little would be
// held. `reach_m`: of the body from its centre, along the approach.
std::optional<double> GraspEvaluation::Deepest(const GraspIdea& idea, double reach_m) const {
  const double middle_m = idea.approach_F.dot(idea.middle_F - body_.centre_F());
  const double pads_m = std::min(kPads * gripper_.finger_depth_m, 0.5 * reach_m);
  double tips_m =
      std::min(middle_m + pads_m, gripper_.finger_depth_m - gripper_.clearance_m - reach_m);
  const double descent = -idea.approach_F.dot(standing_.up);
  if (descent > kDescends) {
    const Eigen::Vector3d tips_F = idea.middle_F + (tips_m - middle_m) * idea.approach_F;
    const double lowest_m =
        LowestPoint(SweptVolume(gripper_, gripper_.max_opening_m), PoseOf(idea, tips_F), floor_F_);
    tips_m -= std::max(gripper_.clearance_m - lowest_m, 0.0) / descent;
  }
  if (tips_m + reach_m < kLeastHold_m) return std::nullopt;
  return tips_m;
}

// Puts the fingers' middle where the middle of what they close on is, and opens them as far as the
// body needs, and farther where its pose is uncertain. Returns the gap on either side, m; none
// where the gripper does not open that far.
std::optional<double> GraspEvaluation::Enclose(GraspCandidate& grasp, double spread_m) const {
  const Span span = Between(body_, grasp.X_FG, gripper_.finger_half_width_m);
  const double width_m = span.forward_m + span.backward_m;
  const double widest_gap_m = 0.5 * (gripper_.max_opening_m - width_m);
  if (widest_gap_m < gripper_.clearance_m - kRounding_m) return std::nullopt;
  const Eigen::Vector3d closing = grasp.X_FG.linear().col(0);
  const double off_m = closing.dot(grasp.X_FG.translation() - body_.centre_F());
  grasp.X_FG.translation() += (0.5 * (span.forward_m - span.backward_m) - off_m) * closing;
  const double gap_m = std::min(
      {gripper_.clearance_m + 2 * spread_m, kCautiousGap * gripper_.clearance_m, widest_gap_m});
  grasp.opening_m = std::min(width_m + 2 * gap_m, gripper_.max_opening_m);
  return gap_m;
}

// Share of the object's turns at which the contacts hold: none, and one standard deviation either
// way about each of the gripper's other axes that it matters for.
double GraspEvaluation::HoldsTurned(const GraspIdea& idea, const Eigen::Vector3d& middle_F) const {
  const Eigen::Vector3d across = idea.approach_F.cross(idea.closing_F);
  int holds = 1, turns = 1;
  for (const auto& [about, aside] :
       {std::pair{idea.approach_F, across}, {across, idea.approach_F}}) {
    const double turn_rad = spread_.Turn(about);
    if (turn_rad < kKnownTurn_rad) continue;
    for (const double way : {1.0, -1.0}) {
      const Eigen::Vector3d closing =
          std::cos(turn_rad) * idea.closing_F + way * std::sin(turn_rad) * aside;
      holds += FindContacts(body_.shape(), middle_F, closing, gripper_.max_slip_rad).has_value();
      ++turns;
    }
  }
  return static_cast<double>(holds) / turns;
}

double GraspEvaluation::Quality(const GraspCandidate& grasp, double slip_rad, double held) const {
  const Eigen::Vector3d middle = 0.5 * (grasp.contacts_F[0] + grasp.contacts_F[1]);
  const double off_centre_m = (middle - body_.centre_F()).norm();
  return kSlipWeight * (1 - slip_rad / std::max(gripper_.max_slip_rad, kLeastSlip_rad)) +
         kCentreWeight / (1 + off_centre_m / gripper_.finger_depth_m) +
         kOpeningWeight * (1 - grasp.opening_m / gripper_.max_opening_m) +
         kHoldWeight * std::min(held, 1.0) + kFreeWeight;
}

std::optional<RatedGrasp> GraspEvaluation::Rate(const GraspIdea& idea) const {
  const double reach_m = body_.HalfWidth(idea.approach_F);
  const std::optional<double> tips_m = Deepest(idea, reach_m);
  if (!tips_m) return std::nullopt;
  const double held_m = *tips_m + reach_m;  // of the fingers' length
  const double middle_m = idea.approach_F.dot(idea.middle_F - body_.centre_F());
  const Eigen::Vector3d tips_F = idea.middle_F + (*tips_m - middle_m) * idea.approach_F;
  const double pads_m = std::min(kPads * gripper_.finger_depth_m, 0.5 * held_m);
  const Eigen::Vector3d inside_F = tips_F - pads_m * idea.approach_F;
  const auto contacts =
      FindContacts(body_.shape(), inside_F, idea.closing_F, gripper_.max_slip_rad);
  if (!contacts) return std::nullopt;

  RatedGrasp rated{.grasp = {.X_FG = PoseOf(idea, tips_F), .contacts_F = contacts->points_F},
                   .kind = idea.kind};
  GraspCandidate& grasp = rated.grasp;
  const double spread_m = spread_.Closing(grasp.X_FG.linear());
  const std::optional<double> gap_m = Enclose(grasp, spread_m);
  if (!gap_m || !body_.Contains(grasp.X_FG.translation())) return std::nullopt;
  if (LowestPoint(SweptVolume(gripper_, grasp.opening_m), grasp.X_FG, table_F_) <
      gripper_.clearance_m - kRounding_m) {
    return std::nullopt;
  }
  rated.probability =
      HoldsTurned(idea, inside_F) * WithinProbability(*gap_m, *gap_m, spread_m) *
      WithinProbability(held_m, gripper_.finger_depth_m - held_m, spread_.Along(idea.approach_F));
  const double most_m = std::min(2 * reach_m, gripper_.finger_depth_m - gripper_.clearance_m);
  grasp.score = Score(rated.probability *
                      Quality(grasp, contacts->slip_rad, held_m / std::max(most_m, kLeastHold_m)));
  return rated;
}

std::optional<RatedGrasp> GraspEvaluation::RatePinch(const RimPinch& pinch, double seen) const {
  RatedGrasp rated{.kind = ApproachKind::kRim, .probability = seen};
  GraspCandidate& grasp = rated.grasp;
  grasp.X_FG = pinch.X_FG;
  grasp.opening_m = pinch.width_m + 2 * gripper_.clearance_m;
  if (LowestPoint(SweptVolume(gripper_, grasp.opening_m), grasp.X_FG, table_F_) <
      gripper_.clearance_m - kRounding_m) {
    return std::nullopt;
  }
  const Eigen::Vector3d half = 0.5 * pinch.width_m * grasp.X_FG.linear().col(0);
  grasp.contacts_F = {grasp.X_FG.translation() + half, grasp.X_FG.translation() - half};
  const double most_m = gripper_.finger_depth_m - gripper_.clearance_m;
  grasp.score = Score(rated.probability * Quality(grasp, pinch.slip_rad,
                                                  pinch.held_m / std::max(most_m, kLeastHold_m)));
  return rated;
}

bool GraspEvaluation::Settle(RatedGrasp& rated) const {
  GraspCandidate& grasp = rated.grasp;
  const double enough_m = kFreeEnough * gripper_.clearance_m;
  const double free_m = DistanceToObstacles(obstacles_, SweptVolume(gripper_, grasp.opening_m),
                                            grasp.X_FG, gripper_.clearance_m, enough_m);
  if (free_m < gripper_.clearance_m) return false;
  if (free_m < enough_m) {
    const double lacking = (enough_m - free_m) / (enough_m - gripper_.clearance_m);
    grasp.score -= rated.probability * kFreeWeight * lacking;
  }
  const bool seen = rated.kind == ApproachKind::kRim;  // whatever the shape may be
  const auto works =
      std::count_if(alternatives_.begin(), alternatives_.end(),
                    [&](const auto& other) { return seen || WorksFor(other, grasp); });
  const double share =
      (1.0 + static_cast<double>(works)) / (1.0 + static_cast<double>(alternatives_.size()));
  grasp.score = Score(share * grasp.score);
  rated.settled = true;
  return true;
}

// Whether the grasp, as it is, goes around another shape that the object may have, and closes on
// it.
bool GraspEvaluation::WorksFor(const GraspedBody& other, const GraspCandidate& grasp) const {
  const Eigen::Vector3d closing = grasp.X_FG.linear().col(0), approach = grasp.X_FG.linear().col(2);
  const Eigen::Vector3d from_centre = grasp.X_FG.translation() - other.centre_F();
  if (!other.Contains(0.5 * (grasp.contacts_F[0] + grasp.contacts_F[1]))) return false;
  const Span span = Between(other, grasp.X_FG, gripper_.finger_half_width_m);
  const double off_m = closing.dot(from_centre), half_m = 0.5 * grasp.opening_m;
  const double to_palm_m =
      approach.dot(from_centre) - gripper_.finger_depth_m + other.HalfWidth(approach);
  return span.forward_m - off_m < half_m && span.backward_m + off_m < half_m && to_palm_m < 0;
}

}  // namespace beckon::pose
