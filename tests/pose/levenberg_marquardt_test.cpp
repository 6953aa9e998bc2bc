// The minimiser finds a known shape from perturbed starts and keeps its bounds.
#include "services/pose/levenberg_marquardt.h"

#include <gtest/gtest.h>

#include "services/pose/fit_stage.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

class DistanceProblem : public FitProblem {
 public:
  explicit DistanceProblem(PointList points) : points_(std::move(points)) {}
  NormalEquations Linearise(const Superquadric& shape) const override {
    NormalEquations eq;
    for (const auto& p : points_) {
      const SurfaceDistance d = DistanceToSurface(shape, p);
      eq.Add(d.distance_m, d.jacobian);
      eq.cost += d.distance_m * d.distance_m;
    }
    return eq;
  }

 private:
  PointList points_;
};

const Superquadric kTruth =
    MakeShape({0.03, 0.05, 0.08}, 0.4, 0.7, {0.1, -0.2, 0.9}, {0.3, 0.4, 0.5});

TEST(Minimise, FindsTheShapeFromPerturbedStarts) {
  const DistanceProblem problem(SampleSurface(kTruth, 400));
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    ParameterVector step;
    for (int i = 0; i < kParameters; ++i) step[i] = 0.2 * unit(engine);
    step.segment<3>(kTranslation) *= 0.1;
    const LmResult result = Minimise(problem, Move(kTruth, step, {}), {}, {100, 1e-9});
    EXPECT_TRUE(result.converged);
    EXPECT_LT(ShapeDifference(result.shape, kTruth), 1e-5) << "trial " << trial;
    EXPECT_NEAR(result.shape.epsilon[0], 0.4, 1e-3);
    EXPECT_NEAR(result.shape.epsilon[1], 0.7, 1e-3);
  }
}

TEST(Minimise, FindsTaperWhereItIsAllowed) {
  Superquadric truth = kTruth;
  truth.taper = {0.15, -0.1};
  FitBounds bounds;
  bounds.max_taper = 0.25;
  const LmResult result =
      Minimise(DistanceProblem(SampleSurface(truth, 400)), kTruth, bounds, {100, 1e-9});
  EXPECT_NEAR(result.shape.taper[0], 0.15, 1e-3);
  EXPECT_NEAR(result.shape.taper[1], -0.1, 1e-3);
}

TEST(Minimise, KeepsItsBounds) {
  FitBounds bounds;
  bounds.max_axes = {0.03, 0.04, 0.08};
  bounds.min_epsilon = 0.6;
  const LmResult result =
      Minimise(DistanceProblem(SampleSurface(kTruth, 400)), kTruth, bounds, {100, 1e-9});
  EXPECT_LE(result.shape.semi_axes[1], 0.04 + 1e-12);
  EXPECT_GE(result.shape.epsilon[0], 0.6);
  EXPECT_EQ(result.shape.taper, Eigen::Vector2d::Zero());
}

TEST(Minimise, StopsWhereItsIterationsRunOut) {
  Superquadric start = kTruth;
  start.semi_axes *= 1.5;
  const LmResult result =
      Minimise(DistanceProblem(SampleSurface(kTruth, 400)), start, {}, {2, 1e-12});
  EXPECT_EQ(result.iterations, 2);
  EXPECT_FALSE(result.converged);
}

}  // namespace
}  // namespace beckon::pose
