// Solina & Bajcsy's objective, which the methods from the literature minimise.
#pragma once

#include "services/pose/fit_stage.h"
#include "services/pose/levenberg_marquardt.h"

namespace beckon::pose {

/// The mean over points of [sqrt(a1 a2 a3) (F^e1 - 1)]^2 (Solina & Bajcsy 1990, "Recovery of
/// parametric models from range images: the case for superquadrics with global deformations", IEEE
/// PAMI 12(2), eq. 17). F^e1 is g^2, g being the gauge: the exponent takes out that F grows faster
/// for sharp shapes, the volume's root that one side of a cloud is fitted by ever larger shapes.
class SolinaProblem : public FitProblem {
 public:
  /// `points_F` must outlive the problem.
  explicit SolinaProblem(const PointList& points_F) : points_F_(points_F) {}

  NormalEquations Linearise(const Superquadric& shape) const override;

 private:
  const PointList& points_F_;
};

}  // namespace beckon::pose
