// Whether the adaptive fit is as sure as it may be.
#include <gtest/gtest.h>

#include <random>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "services/pose/fit.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// Squared distance of the true position in standard deviations.
double Surprise(const FitResult& result, const Superquadric& truth) {
  const Vector3d off = truth.X_FO.translation() - result.shape.X_FO.translation();
  const Eigen::Matrix3d covariance = result.covariance.topLeftCorner<3, 3>();
  return off.dot(covariance.ldlt().solve(off));
}

Superquadric RandomOnTable(std::mt19937& engine) {
  const auto draw = [&](double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine);
  };
  const int kind = static_cast<int>(draw(0, 3));
  Vector3d axes(draw(0.025, 0.05), draw(0.025, 0.06), draw(0.04, 0.1));
  if (kind == 1) axes.y() = axes.x();
  const double e1 = kind == 2 ? 1 : 0.1, e2 = kind == 0 ? 0.1 : 1;
  return MakeShape(axes, e1, e2, {draw(-0.1, 0.1), draw(-0.1, 0.1), axes.z()}, {0, 0, draw(0, 3)});
}

TEST(AdaptiveCovariance, HoldsTheTruePositionAsOftenAsItSays) {
  constexpr int kViews = 40;
  constexpr double k90 = 6.251;  // of chi squared with three degrees of freedom
  std::mt19937 engine(11);
  int held = 0;
  for (int i = 0; i < kViews; ++i) {
    const TableView view =
        PixelViewOnTable(RandomOnTable(engine), 0.0015, static_cast<unsigned>(i));
    const FitResult result = Fit({view.points_C, view.table_C}, {});
    EXPECT_TRUE(result.converged) << result.reason;
    const Eigen::Matrix<double, 6, 6>& covariance = result.covariance;
    EXPECT_GT((covariance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff()), 0);
    held += Surprise(result, view.shape_C) < k90 ? 1 : 0;
  }
  // Of 40 the standard deviation is 5 %: 75 % is three of them below.
  EXPECT_GE(held, 0.75 * kViews);
}

TEST(AdaptiveCovariance, OfAHandfulOfPointsIsNeverConfidentAndWrong) {
  const TableView view =
      PixelViewOnTable(MakeShape({0.04, 0.06, 0.09}, 0.1, 0.1, {0, 0, 0.09}, {0, 0, 0.5}), 0.0015);
  std::mt19937 engine(3);
  int sure = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Vector3f> points = view.points_C;
    std::shuffle(points.begin(), points.end(), engine);
    points.resize(static_cast<size_t>(20 + trial % 21));
    const FitResult result = Fit({points, view.table_C}, {});
    if (!result.converged || result.ambiguous) continue;
    ++sure;
    EXPECT_LT(Surprise(result, view.shape_C), 16)
        << "of " << points.size() << " points, off by "
        << (view.shape_C.X_FO.translation() - result.shape.X_FO.translation()).norm();
  }
  EXPECT_GT(sure, 10);  // nor does it always doubt
}

TEST(FitAmbiguity, SaysThatNobodyKnowsHowDeepABoxIsThatIsSeenFaceOn) {
  const Superquadric box = MakeShape({0.04, 0.05, 0.1}, 0.1, 0.1, {0, 0, 0.8});
  std::mt19937 engine(1);
  std::normal_distribution<double> noise(0, 0.0015);
  std::vector<Eigen::Vector3f> face;
  for (const auto& p : SampleSurface(box, 8000)) {
    if (p.z() < 0.702) face.push_back((p * (1 + noise(engine) / p.z())).cast<float>());
  }
  const FitResult result = Fit({face, {}}, {});
  const Eigen::Vector3d error = result.shape.X_FO.translation() - box.X_FO.translation();
  const Eigen::Matrix3d covariance = result.covariance.topLeftCorner<3, 3>();
  EXPECT_TRUE(!result.converged || result.ambiguous);
  EXPECT_LT(error.dot(covariance.ldlt().solve(error)), 16);
}

}  // namespace
}  // namespace beckon::pose
