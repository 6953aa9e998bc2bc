// Levenberg-Marquardt over the parameters of a superquadric, with bounds.
#include "services/pose/levenberg_marquardt.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace beckon::pose {
namespace {

constexpr double kFirstDamping = 1e-3;
constexpr double kMaxDamping = 1e8;
// A parameter that hardly changes the cost (the turn of a round shape) is damped as if it changed
// it by this part of the most effective one.
constexpr double kRelativeFloor = 1e-7;

// Whether a parameter stands at a bound and the gradient pushes it outward.
bool HeldBack(const Superquadric& s, const FitBounds& b, int i, double gradient) {
  constexpr double kSlack = 1e-9;
  double value, lo, hi;
  if (i < kEpsilon) {
    value = s.semi_axes[i], lo = b.min_axes[i], hi = b.max_axes[i];
  } else if (i < kRotation) {
    value = s.epsilon[i - kEpsilon], lo = b.min_epsilon, hi = b.max_epsilon;
  } else if (i >= kTaper) {
    value = s.taper[i - kTaper], lo = -b.max_taper, hi = b.max_taper;
  } else {
    return false;
  }
  return lo >= hi || (value <= lo + kSlack && gradient > 0) ||
         (value >= hi - kSlack && gradient < 0);
}

ParameterVector SolveDamped(const NormalEquations& eq, const Superquadric& shape,
                            const FitBounds& bounds, double damping) {
  ParameterMatrix A = eq.hessian;
  ParameterVector b = -eq.gradient;
  const double floor = kRelativeFloor * eq.hessian.diagonal().maxCoeff();
  for (int i = 0; i < kParameters; ++i) {
    if (HeldBack(shape, bounds, i, eq.gradient[i])) {
      A.row(i).setZero();
      A.col(i).setZero();
      A(i, i) = 1;
      b[i] = 0;
    } else {
      A(i, i) += damping * std::max(A(i, i), floor) + 1e-30;
    }
  }
  return A.selfadjointView<Eigen::Lower>().ldlt().solve(b);
}

Eigen::Matrix3d Exponential(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle < 1e-14) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

}  // namespace

Superquadric Move(const Superquadric& shape, const ParameterVector& step, const FitBounds& bounds) {
  Superquadric moved = shape;
  const Eigen::Vector3d log_step = step.segment<3>(kLogAxes).cwiseMax(-1).cwiseMin(1);
  moved.semi_axes = (shape.semi_axes.array() * log_step.array().exp())
                        .max(bounds.min_axes.array())
                        .min(bounds.max_axes.array());
  moved.epsilon = (shape.epsilon + step.segment<2>(kEpsilon))
                      .cwiseMax(bounds.min_epsilon)
                      .cwiseMin(bounds.max_epsilon);
  moved.taper = (shape.taper + step.segment<2>(kTaper))
                    .cwiseMax(-bounds.max_taper)
                    .cwiseMin(bounds.max_taper);
  moved.X_FO.linear() = Exponential(step.segment<3>(kRotation)) * shape.X_FO.linear();
  moved.X_FO.translation() += step.segment<3>(kTranslation);
  return moved;
}

LmResult Minimise(const FitProblem& problem, const Superquadric& start, const FitBounds& bounds,
                  const LmOptions& options) {
  LmResult result;
  result.shape = Move(start, ParameterVector::Zero(), bounds);
  result.at_minimum = problem.Linearise(result.shape);
  double damping = kFirstDamping, growth = 2;
  while (result.iterations < options.max_iterations) {
    ++result.iterations;
    const ParameterVector step = SolveDamped(result.at_minimum, result.shape, bounds, damping);
    const Superquadric moved = Move(result.shape, step, bounds);
    const NormalEquations at_moved = problem.Linearise(moved);
    const double gain = result.at_minimum.cost - at_moved.cost;
    if (step.allFinite() && gain > 0) {
      const double old_cost = std::abs(result.at_minimum.cost);
      result.shape = moved;
      result.at_minimum = at_moved;
      damping = std::max(damping * 0.1, 1e-9);
      growth = 2;
      if (gain <= options.relative_tolerance * old_cost) {
        result.converged = true;
        break;
      }
    } else {
      damping *= growth;
      growth *= 2;
      // No step helps any more: this is the minimum as far as the arithmetic can tell.
      if (damping > kMaxDamping || (gain <= 0 && step.norm() < 1e-10)) {
        result.converged = true;
        break;
      }
    }
  }
  result.shape.X_FO.linear() =
      Eigen::Quaterniond(result.shape.X_FO.linear()).normalized().toRotationMatrix();
  return result;
}

void FillJacobian(const Superquadric& shape, const Eigen::Vector3d& arm_F,
                  const GaugeDerivatives& d, double scale, double translation_scale,
                  ParameterVector& jacobian) {
  const Eigen::Vector3d gradient_F = shape.X_FO.linear() * d.point;
  jacobian.segment<3>(kLogAxes) = scale * d.log_semi_axes;
  jacobian.segment<2>(kEpsilon) = scale * d.epsilon;
  jacobian.segment<3>(kRotation) = scale * gradient_F.cross(arm_F);
  jacobian.segment<3>(kTranslation) = -translation_scale * gradient_F;
  jacobian.segment<2>(kTaper) = scale * d.taper;
}

}  // namespace beckon::pose
