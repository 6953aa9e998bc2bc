// Fitting a superquadric to what one camera sees of an object: what every method takes and gives.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/base/geometry.h"
#include "services/base/result.h"
#include "services/base/rim.h"
#include "services/pose/fit_adaptive.h"
#include "services/pose/fit_classic.h"
#include "services/pose/fit_hierarchical.h"
#include "services/pose/fit_multiscale.h"
#include "services/pose/parts.h"
#include "services/pose/superquadric.h"

namespace beckon::pose {

enum class Method { kAdaptive, kMultiscale, kClassic, kHierarchical };

/// The method of that name; fails, naming those that exist, where there is none.
Result<Method> ParseMethod(const std::string& name);
const char* Name(Method method);
/// All methods' names: "adaptive, multiscale, ..".
std::string MethodNames();

struct FitConfig {
  Method method = Method::kAdaptive;
  AdaptiveConfig adaptive;
  MultiscaleConfig multiscale;
  ClassicConfig classic;
  HierarchicalConfig hierarchical;
  PartsConfig parts;            // of the adaptive method
  double max_extent_m = 3.0;    // a cloud larger than this is not an object in metres
  double min_extent_m = 0.005;  // one smaller than this shows nothing
  double max_radial_distance_m =
      0.01;  // a fit whose points are farther from it on average did not converge
  // Where more than this part of the points lies deeper than this below the table, the plane is not
  // what they stand on.
  double max_below_share = 0.3;
  double below_table_m = 0.02;
};

/// Points of one object in a frame F.
struct FitInput {
  std::span<const Eigen::Vector3f> points_F;  // m; NaN and infinite points are left out
  std::optional<Plane> table_F;               // normal up, unit; the object stands on it
  Eigen::Vector3d viewpoint_F = Eigen::Vector3d::Zero();  // where the camera was
  // What the image shows around the object; empty where the points are all that is known. Points
  // that are not finite are left out.
  std::span<const RimPoint> rim_F;
};

struct FitResult {
  Superquadric shape;  // always finite; where nothing was fitted, the points' box as an ellipsoid
  bool converged = false;
  std::string reason;      // why not; empty otherwise
  // A clearly different shape explains the points about as well, or a part of the shape is a guess: behind what
  // may cut it off, behind the one flat side that is seen, or below a foot that is not.
  bool ambiguous = false;
  std::vector<Superquadric> alternatives;  // those shapes, likeliest first; may be empty
  std::vector<Superquadric> parts;         // where one superquadric does not do: two or more
  double mean_radial_distance_m = 0;
  // Of position (m) and rotation vector (rad) in F, from the Gauss-Newton Hessian scaled by the
  // mean squared residual; directions that the points do not determine (the turn of a can) have the
  // variance of total ignorance. Zeros where nothing was fitted.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<int> iterations;  // per level or stage
  int points_used = 0;          // finite points
};

/// Fits by the configured method; does not where the points show no shape, or the table or the
/// viewpoint cannot be theirs, and says so. Deterministic.
FitResult Fit(const FitInput& input, const FitConfig& config);

}  // namespace beckon::pose
