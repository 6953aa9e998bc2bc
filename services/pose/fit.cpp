// Fitting a superquadric: checks of the input, the method, and what its result is worth.
#include "services/pose/fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "services/pose/distance_kernel.h"
#include "services/pose/fit_stage.h"

namespace beckon::pose {
namespace {

constexpr size_t kFewestPoints = 20;
constexpr int kJudges = 1000;  // points that the mean distance is taken of, at most
// Points that the covariance counts, at most: neighbours in a depth image err together, so that ten
// thousand of them do not know ten times as much as a hundred.
constexpr int kWitnesses = 300;
// From the frame's origin: no depth camera sees farther, and single precision is coarse there.
constexpr double kFarthest_m = 100;
constexpr double kThinnest_m = 0.0005;  // spread below which points lie on a plane or a line

constexpr std::array<std::pair<Method, const char*>, 4> kMethods{
    {{Method::kAdaptive, "adaptive"},
     {Method::kMultiscale, "multiscale"},
     {Method::kClassic, "classic"},
     {Method::kHierarchical, "hierarchical"}}};

template <typename... Args>
std::string Text(const char* format, Args... args) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

PointList FinitePoints(std::span<const Eigen::Vector3f> points) {
  PointList finite;
  finite.reserve(points.size());
  for (const auto& p : points) {
    if (p.allFinite() && p.cwiseAbs().maxCoeff() < 1e9f) finite.push_back(p.cast<double>());
  }
  return finite;
}

// Why points cannot be fitted; empty where they can.
std::string Unfit(const PrincipalBox& box, const FitConfig& config) {
  const double extent = 2 * box.half_extents.maxCoeff();
  if (extent > config.max_extent_m) {
    return Text(
        "the points span %.4g m, more than %.4g m: are they in millimetres, or of several objects?",
        extent, config.max_extent_m);
  }
  if (const double distance = box.middle.norm(); distance > kFarthest_m) {
    return Text("the points lie %.4g m away, more than %.4g m: are they in millimetres?", distance,
                kFarthest_m);
  }
  if (extent < config.min_extent_m) {
    return Text("the points span %.4g m, less than %.4g m", extent, config.min_extent_m);
  }
  if (box.spread[1] < kThinnest_m) return "the points lie on a line";
  if (box.spread[2] < kThinnest_m) return "the points lie on a plane";
  return "";
}

// Why the points cannot stand on the table that is told, or be seen from the viewpoint; empty where
// they can.
std::string Misplaced(const PointList& points, const FitInput& input, const FitConfig& config) {
  constexpr double kUnit = 1e-3;  // what a normal's length may be off
  if (!input.viewpoint_F.allFinite()) return "the viewpoint is not finite";
  if (!input.table_F) return "";
  const Plane& table = *input.table_F;
  const double length = table.normal.norm();
  if (!(std::abs(length - 1) <= kUnit)) {
    return Text("the table's plane is not one: its normal has length %.4g, not 1", length);
  }
  if (!std::isfinite(table.offset_m))
    return "the table's plane is not one: its offset is not finite";
  const auto below = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
    return table.Distance(p) < -config.below_table_m;
  });
  const double share = static_cast<double>(below) / static_cast<double>(points.size());
  if (share <= config.max_below_share) return "";
  return Text(
      "%.0f %% of the points lie more than %.4g m below the table's plane: is it this object's, "
      "and "
      "does its normal point up?",
      100 * share, config.below_table_m);
}

std::vector<RimPoint> FiniteRim(std::span<const RimPoint> rim) {
  std::vector<RimPoint> finite;
  for (const RimPoint& r : rim) {
    if (r.point.allFinite()) finite.push_back(r);
  }
  return finite;
}

// What is told of an object that cannot be fitted: its box as an ellipsoid.
Superquadric BoxOf(const PrincipalBox& box) {
  constexpr double kFar_m = 500;  // with the semi-axes, within what messages carry
  Superquadric shape;
  shape.semi_axes = box.half_extents.cwiseMax(0.001).cwiseMin(50);
  shape.X_FO.linear() = box.axes;
  shape.X_FO.translation() = box.middle * std::min(1.0, kFar_m / box.middle.norm());
  return shape;
}

// What the points alone tell of the parameters: the Gauss-Newton Hessian of their distances over
// the mean squared distance.
ParameterMatrix InformationOf(const Superquadric& shape, const PointList& points) {
  NormalEquations eq;
  double squares = 0;
  for (const auto& p : points) {
    const SurfaceDistance d = DistanceToSurface(shape, p);
    eq.Add(d.distance_m, d.jacobian);
    squares += d.distance_m * d.distance_m;
  }
  const double dof = std::max<double>(static_cast<double>(points.size()) - kTaper, 1);
  const double variance = std::max(squares / dof, 1e-12);
  return ParameterMatrix(eq.hessian.selfadjointView<Eigen::Lower>()) / variance;
}

// Covariance of position and rotation: the block of the inverse information on all parameters but
// taper. Directions without information get the variance of total ignorance through a weak prior.
Eigen::Matrix<double, 6, 6> PoseCovariance(const Superquadric& shape,
                                           const ParameterMatrix& parameter_information) {
  constexpr int kUsed = kTaper;
  Eigen::Matrix<double, kUsed, 1> prior;  // standard deviations of total ignorance
  prior << 1, 1, 1, 0.5, 0.5, Eigen::Vector3d::Constant(std::numbers::pi / std::sqrt(3.0)),
      Eigen::Vector3d::Constant(shape.semi_axes.maxCoeff());
  Eigen::Matrix<double, kUsed, kUsed> information =
      parameter_information.topLeftCorner<kUsed, kUsed>();
  information.diagonal() += prior.array().square().inverse().matrix();
  const Eigen::Matrix<double, kUsed, kUsed> covariance =
      information.ldlt().solve(Eigen::Matrix<double, kUsed, kUsed>::Identity());
  // Position first, then rotation.
  Eigen::Matrix<double, 6, 6> pose;
  pose.topLeftCorner<3, 3>() = covariance.block<3, 3>(kTranslation, kTranslation);
  pose.topRightCorner<3, 3>() = covariance.block<3, 3>(kTranslation, kRotation);
  pose.bottomLeftCorner<3, 3>() = covariance.block<3, 3>(kRotation, kTranslation);
  pose.bottomRightCorner<3, 3>() = covariance.block<3, 3>(kRotation, kRotation);
  return 0.5 * (pose + pose.transpose());
}

// Mean radial distance of `most` of the points, m.
double MeanRadialDistanceOf(const Superquadric& shape, const PointList& points, int most) {
  const PointList part = Thinned(points, most);
  if (!shape.taper.isZero(0)) return MeanRadialDistance(shape, part);
  double sum = 0;
  PointBlock block;
  const auto empty = [&] {
    block.Pad();
    sum += SumRadialDistances(shape, block);
    block.size = 0;
  };
  for (const auto& p : part) {
    block.Add(p, 1);
    if (block.full()) empty();
  }
  if (block.size > 0) empty();
  return sum / static_cast<double>(part.size());
}

// Where only one flat side is seen, how deep the object is behind it is not known, unless that side
// lies on top and the table tells: the direction of which nothing is known, or zero.
Eigen::Vector3d UnseenDepth(const PrincipalBox& box, const std::optional<Plane>& table_F) {
  constexpr double kFlat_m = 0.0025;  // spread of a flat side with a camera's noise
  constexpr double kLevel = 0.9;      // cosine
  const Eigen::Vector3d normal = box.axes.col(2);
  const bool on_top = table_F && std::abs(normal.dot(table_F->normal)) > kLevel;
  return box.spread[2] < kFlat_m && !on_top ? normal : Eigen::Vector3d::Zero();
}

MethodOutcome FitBy(const FitConfig& config, const PointList& points, const FitInput& input) {
  switch (config.method) {
    case Method::kMultiscale:
      return FitMultiscale(points, config.multiscale);
    case Method::kClassic:
      return FitClassic(points, config.classic);
    case Method::kHierarchical:
      return FitHierarchical(points, config.hierarchical);
    case Method::kAdaptive:
      break;
  }
  return FitAdaptive(points, input.table_F, input.viewpoint_F, input.rim_F, config.adaptive);
}

bool IsFinite(const Superquadric& s) {
  return s.semi_axes.allFinite() && s.semi_axes.minCoeff() > 0 && s.epsilon.allFinite() &&
         s.taper.allFinite() && s.X_FO.matrix().allFinite();
}

}  // namespace

Result<Method> ParseMethod(const std::string& name) {
  for (const auto& [method, known] : kMethods) {
    if (name == known) return method;
  }
  return Error{"there is no fitting method '" + name + "'; this build has: " + MethodNames()};
}

std::string MethodNames() {
  std::string names;
  for (const auto& [method, name] : kMethods) {
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

const char* Name(Method method) {
  for (const auto& [known, name] : kMethods) {
    if (method == known) return name;
  }
  return "";
}

FitResult Fit(const FitInput& input, const FitConfig& config) {
  FitResult result;
  const PointList points = FinitePoints(input.points_F);
  result.points_used = static_cast<int>(points.size());
  result.shape.semi_axes.setConstant(0.001);
  if (points.empty()) {
    result.reason = "no finite points";
    return result;
  }
  const PrincipalBox box = ComputePrincipalBox(points);
  result.shape = BoxOf(box);
  result.reason = points.size() < kFewestPoints
                      ? Text("%zu finite points, fewer than %zu", points.size(), kFewestPoints)
                      : Unfit(box, config);
  if (result.reason.empty()) result.reason = Misplaced(points, input, config);
  if (!result.reason.empty()) return result;

  const std::vector<RimPoint> rim_F = FiniteRim(input.rim_F);
  const FitInput sound{input.points_F, input.table_F, input.viewpoint_F, rim_F};
  const MethodOutcome outcome = FitBy(config, points, sound);
  result.iterations = outcome.iterations;
  if (!IsFinite(outcome.shape)) {
    result.reason = "the fit did not stay finite";
    return result;
  }
  result.shape = outcome.shape;
  result.ambiguous = outcome.ambiguous;
  result.alternatives = outcome.alternatives;
  result.mean_radial_distance_m = MeanRadialDistanceOf(result.shape, points, kJudges);
  result.covariance = PoseCovariance(
      result.shape, outcome.information ? *outcome.information
                                        : InformationOf(result.shape, Thinned(points, kWitnesses)));
  if (const Eigen::Vector3d unseen = UnseenDepth(box, input.table_F); !unseen.isZero(0)) {
    const double depth = box.half_extents.maxCoeff();
    result.covariance.topLeftCorner<3, 3>() += depth * depth * unseen * unseen.transpose();
    result.ambiguous = true;
  }
  if (!outcome.converged) {
    result.reason = "the fit was still improving when its iterations ran out";
  } else if (result.mean_radial_distance_m > config.max_radial_distance_m) {
    result.reason =
        Text("the points lie %.1f mm from the fitted surface on average, more than %.1f mm",
             1e3 * result.mean_radial_distance_m, 1e3 * config.max_radial_distance_m);
  }
  result.converged = result.reason.empty();
  if (config.method == Method::kAdaptive) {
    result.parts = FindParts(points, sound.table_F, sound.viewpoint_F, sound.rim_F, result.shape,
                             config.adaptive, config.parts);
  }
  return result;
}

}  // namespace beckon::pose
