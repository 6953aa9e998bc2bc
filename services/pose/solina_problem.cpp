// Solina & Bajcsy's objective, which the methods from the literature minimise.
#include "services/pose/solina_problem.h"

#include <cmath>

namespace beckon::pose {

NormalEquations SolinaProblem::Linearise(const Superquadric& shape) const {
  const double root_volume = std::sqrt(shape.semi_axes.prod());
  const double weight = 1.0 / static_cast<double>(points_F_.size());
  NormalEquations eq;
  ParameterVector jacobian;
  for (const auto& p : points_F_) {
    const Eigen::Vector3d arm_F = p - shape.X_FO.translation();
    const GaugeDerivatives d = DifferentiateGauge(shape, shape.X_FO.linear().transpose() * arm_F);
    const double g2 = std::exp(2 * d.log_g);
    const double residual = root_volume * (g2 - 1);
    const double scale = 2 * root_volume * g2;
    FillJacobian(shape, arm_F, d, scale, scale, jacobian);
    jacobian.segment<3>(kLogAxes).array() += 0.5 * residual;
    eq.Add(residual, jacobian, weight);
    eq.cost += weight * residual * residual;
  }
  return eq;
}

}  // namespace beckon::pose
