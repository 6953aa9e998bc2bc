// What the adaptive fit minimises.
#pragma once

#include <limits>
#include <optional>
#include <span>

#include "services/base/geometry.h"
#include "services/pose/distance_kernel.h"
#include "services/pose/fit_adaptive.h"
#include "services/pose/levenberg_marquardt.h"

namespace beckon::pose {

/// What does not change between the stages of one fit.
struct TableTopScene {
  std::optional<Plane> table;  // normal up
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();
  double log_axes =
      0;  // sum of the log semi-axes of what is seen: the prior on the volume is 0 there
  // Height above the table of the highest point that is seen; infinite where that says nothing.
  double top_m = std::numeric_limits<double>::infinity();
};

/// A side on which the object goes on behind a plane through the viewpoint, nobody knows how far.
struct Cut {
  Eigen::Vector3d normal_F;  // unit, outward
  double beyond_m = 0;       // how far it is expected to go on
  double sigma_m = 1;        // how little that is known
};

/// The terms of the cost, m^2; each is there to be looked at.
struct AdaptiveCost {
  double points = 0, outline = 0, support = 0, tilt = 0, top = 0, volume = 0, cut = 0,
         proportion = 0;
  double total() const {
    return points + outline + support + tilt + top + volume + cut + proportion;
  }
};

/// The cost of AdaptiveConfig about one set of points, rays and cuts, which must outlive it.
class AdaptiveProblem : public FitProblem {
 public:
  /// `upright`: the axis of the shape that is to be vertical.
  AdaptiveProblem(const PointBlock& points, const PointBlock& rays, const TableTopScene& scene,
                  int upright, const AdaptiveConfig& config, std::span<const Cut> cuts = {})
      : points_(points),
        rays_(rays),
        scene_(scene),
        upright_(upright),
        config_(config),
        cuts_(cuts) {}

  NormalEquations Linearise(const Superquadric& shape) const override;
  AdaptiveCost CostOf(const Superquadric& shape) const;
  /// Multiplies the outline's weight.
  void set_outline_share(double share) { outline_share_ = share; }
  /// How closely the point of a ray is found that is deepest in the shape.
  void set_search_steps(int steps) { search_steps_ = steps; }

 private:
  AdaptiveCost Add(const Superquadric& shape, NormalEquations& eq) const;
  double AddSupport(const Superquadric& shape, NormalEquations& eq) const;
  bool TopIsCut() const;
  double AddTop(const Superquadric& shape, NormalEquations& eq) const;
  double AddCut(const Superquadric& shape, const Cut& cut, NormalEquations& eq) const;
  double AddProportion(const Superquadric& shape, NormalEquations& eq) const;
  double AddTilt(const Superquadric& shape, NormalEquations& eq) const;

  const PointBlock& points_;
  const PointBlock& rays_;
  const TableTopScene& scene_;
  const int upright_;
  const AdaptiveConfig& config_;
  const std::span<const Cut> cuts_;
  double outline_share_ = 1;
  int search_steps_ = 14;
};

/// The axis of the shape nearest to the table's normal; 2 where there is no table.
int UprightAxis(const Superquadric& shape, const std::optional<Plane>& table);

}  // namespace beckon::pose
