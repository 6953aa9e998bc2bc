// What the adaptive fit minimises.
#include "services/pose/adaptive_problem.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace beckon::pose {
namespace {

// s^2 log(1 + (r/s)^2) and its weight (Cauchy; Zhang 1997, table 1).
struct Robust {
  double cost, weight;
};
Robust Cauchy(double residual, double scale) {
  const double x = residual * residual / (scale * scale);
  return {scale * scale * std::log(1 + x), 1 / (1 + x)};
}

// max of n·p over the shape, with its derivatives by the parameters.
double Reach(const Superquadric& shape, const Eigen::Vector3d& n_F, ParameterVector& jacobian) {
  const Eigen::Matrix3d& R = shape.X_FO.linear();
  const SupportDerivatives d = DifferentiateSupport(shape, R.transpose() * n_F);
  jacobian.setZero();
  jacobian.segment<3>(kLogAxes) = d.log_semi_axes;
  jacobian.segment<2>(kEpsilon) = d.epsilon;
  jacobian.segment<3>(kRotation) = (R * d.point).cross(n_F);
  jacobian.segment<3>(kTranslation) = n_F;
  return n_F.dot(shape.X_FO.translation()) + d.h;
}

double AddKernel(const DistanceSum& sum, double weight, NormalEquations& eq) {
  eq.gradient.head<kKernelParameters>() += weight * sum.gradient;
  eq.hessian.topLeftCorner<kKernelParameters, kKernelParameters>() += weight * sum.hessian;
  return weight * sum.cost;
}

}  // namespace

NormalEquations AdaptiveProblem::Linearise(const Superquadric& shape) const {
  NormalEquations eq;
  eq.cost = Add(shape, eq).total();
  return eq;
}

AdaptiveCost AdaptiveProblem::CostOf(const Superquadric& shape) const {
  NormalEquations unused;
  return Add(shape, unused);
}

AdaptiveCost AdaptiveProblem::Add(const Superquadric& shape, NormalEquations& eq) const {
  AdaptiveCost cost;
  cost.points = AddKernel(SumDistances(shape, points_, {config_.noise_m, config_.noise_m}), 1, eq);
  if (rays_.size > 0) {
    PointBlock deepest;
    FindDeepest(shape, scene_.viewpoint, rays_, search_steps_, deepest);
    cost.outline = AddKernel(
        SumDistances(shape, deepest, {config_.outline_noise_m, config_.outline_outside_m}),
        outline_share_ * config_.outline_weight, eq);
  }
  if (scene_.table) {
    cost.support = AddSupport(shape, eq);
    cost.tilt = AddTilt(shape, eq);
    if (!TopIsCut()) cost.top = AddTop(shape, eq);
  }
  cost.proportion = AddProportion(shape, eq);
  for (const Cut& cut : cuts_) cost.cut += AddCut(shape, cut, eq);
  if (!cuts_.empty()) return cost;
  cost.volume = config_.volume_prior_m2 * (shape.semi_axes.array().log().sum() - scene_.log_axes);
  eq.gradient.segment<3>(kLogAxes).array() += 0.5 * config_.volume_prior_m2;
  return cost;
}

// The lowest point lies on the table: max over the shape of -n·p equals the plane's offset.
double AdaptiveProblem::AddSupport(const Superquadric& shape, NormalEquations& eq) const {
  ParameterVector jacobian;
  const double below = Reach(shape, -scene_.table->normal, jacobian) - scene_.table->offset_m;
  const Robust robust = Cauchy(below, config_.support_noise_m);
  eq.Add(below, jacobian, config_.support_weight * robust.weight);
  return config_.support_weight * robust.cost;
}

// Whether something may hide the highest point of the object.
bool AdaptiveProblem::TopIsCut() const {
  constexpr double kUpward = 0.3;
  return std::any_of(cuts_.begin(), cuts_.end(), [&](const Cut& cut) {
    return cut.normal_F.dot(scene_.table->normal) > kUpward;
  });
}

// The shape does not rise above what is seen of it.
double AdaptiveProblem::AddTop(const Superquadric& shape, NormalEquations& eq) const {
  ParameterVector jacobian;
  const double above = Reach(shape, scene_.table->normal, jacobian) + scene_.table->offset_m -
                       scene_.top_m - config_.top_slack_m;
  if (above <= 0) return 0;
  eq.Add(above, jacobian, config_.top_weight);
  return config_.top_weight * above * above;
}

// The shape reaches about as far beyond the cut as is expected.
double AdaptiveProblem::AddCut(const Superquadric& shape, const Cut& cut,
                               NormalEquations& eq) const {
  ParameterVector jacobian;
  const double reach = Reach(shape, cut.normal_F, jacobian) - cut.normal_F.dot(scene_.viewpoint);
  const double weight = config_.cut_pull_m2 / (cut.sigma_m * cut.sigma_m);
  const double surprise = reach - cut.beyond_m;
  eq.Add(surprise, jacobian, weight);
  return weight * surprise * surprise;
}

// The semi-axes are of like lengths.
double AdaptiveProblem::AddProportion(const Superquadric& shape, NormalEquations& eq) const {
  const Eigen::Array3d logs = shape.semi_axes.array().log();
  double cost = 0;
  for (int i = 0; i < 3; ++i) {
    ParameterVector jacobian = ParameterVector::Zero();
    jacobian.segment<3>(kLogAxes).setConstant(-1.0 / 3);
    jacobian[kLogAxes + i] += 1;
    const double longer = logs[i] - logs.mean();
    eq.Add(longer, jacobian, config_.proportion_prior_m2);
    cost += config_.proportion_prior_m2 * longer * longer;
  }
  return cost;
}

// The upright axis has no horizontal components.
double AdaptiveProblem::AddTilt(const Superquadric& shape, NormalEquations& eq) const {
  const Eigen::Vector3d axis = shape.X_FO.linear().col(upright_);
  const Eigen::Vector3d right = scene_.table->normal.unitOrthogonal();
  double cost = 0;
  for (const Eigen::Vector3d& h : {right, Eigen::Vector3d(scene_.table->normal.cross(right))}) {
    ParameterVector jacobian = ParameterVector::Zero();
    jacobian.segment<3>(kRotation) = axis.cross(h);
    const double lean = h.dot(axis);
    eq.Add(lean, jacobian, config_.tilt_weight);
    cost += config_.tilt_weight * lean * lean;
  }
  return cost;
}

int UprightAxis(const Superquadric& shape, const std::optional<Plane>& table) {
  int axis = 2;
  if (table) (shape.X_FO.linear().transpose() * table->normal).cwiseAbs().maxCoeff(&axis);
  return axis;
}

}  // namespace beckon::pose
