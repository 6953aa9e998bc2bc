// Levenberg-Marquardt over the parameters of a superquadric, with bounds.
#pragma once

#include <Eigen/Core>

#include "services/pose/superquadric.h"

namespace beckon::pose {

/// Order of the parameters: log a1 a2 a3, e1 e2, rotation vector, translation, kx ky. The rotation
/// vector turns the shape in F about its centre: R' = Exp(w) R.
inline constexpr int kLogAxes = 0, kEpsilon = 3, kRotation = 5, kTranslation = 8, kTaper = 11;
inline constexpr int kParameters = 13;
using ParameterVector = Eigen::Matrix<double, kParameters, 1>;
using ParameterMatrix = Eigen::Matrix<double, kParameters, kParameters>;

/// A sum of squares about one shape, to second order: cost + 2 gradient·d + d·hessian·d.
struct NormalEquations {
  double cost = 0;
  ParameterVector gradient = ParameterVector::Zero();  // J^T r
  ParameterMatrix hessian = ParameterMatrix::Zero();   // J^T J, lower triangle

  void Add(double residual, const ParameterVector& jacobian, double weight = 1) {
    gradient += weight * residual * jacobian;
    hessian.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, weight);
  }
};

/// What is minimised.
class FitProblem {
 public:
  virtual ~FitProblem() = default;
  virtual NormalEquations Linearise(const Superquadric& shape) const = 0;
};

/// Limits of what has some; log axes and exponents are clamped, the pose is free. Equal limits fix
/// a parameter.
struct FitBounds {
  Eigen::Vector3d min_axes = Eigen::Vector3d::Constant(0.005);  // m
  Eigen::Vector3d max_axes = Eigen::Vector3d::Constant(1.0);    // m
  double min_epsilon = 0.1, max_epsilon = 1.0;
  double max_taper = 0;  // taper in +- this; 0 = straight
};

struct LmOptions {
  int max_iterations = 20;
  double relative_tolerance =
      1e-6;  // stop where a step lowers the cost by less than this part of it
};

struct LmResult {
  Superquadric shape;
  NormalEquations at_minimum;
  int iterations = 0;
  bool converged = false;  // stopped by the tolerance, not by the iterations
};

/// The shape moved by a step of the parameters, within bounds.
Superquadric Move(const Superquadric& shape, const ParameterVector& step, const FitBounds& bounds);

/// Minimises by Marquardt's method (Marquardt 1963; the damping of Nielsen 1999). Parameters that a
/// bound holds back are fixed for the step (projected Newton, Bertsekas 1982).
LmResult Minimise(const FitProblem& problem, const Superquadric& start, const FitBounds& bounds,
                  const LmOptions& options);

/// The derivatives by all parameters of a function of log g, from those of log g at a point:
/// `arm_F` is the point from the shape's centre. `scale` multiplies the derivatives,
/// `translation_scale` those by the translation.
void FillJacobian(const Superquadric& shape, const Eigen::Vector3d& arm_F,
                  const GaugeDerivatives& d, double scale, double translation_scale,
                  ParameterVector& jacobian);

}  // namespace beckon::pose
