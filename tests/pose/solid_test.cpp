// Volume and moments against closed forms, and against integrals over a mesh.
#include "services/pose/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "services/pose/mesh.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
const Vector3d kAxes(0.02, 0.03, 0.05);

// Moments of the polyhedron that a closed mesh bounds: the sum over tetrahedra from the origin.
SolidMoments Integrate(const TriangleMesh& mesh) {
  double volume = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  for (const auto& t : mesh.triangles) {
    Matrix3d corners;
    for (int i = 0; i < 3; ++i) {
      corners.col(i) = mesh.vertices_F[static_cast<size_t>(t[static_cast<size_t>(i)])];
    }
    const double v = corners.determinant() / 6;
    const Vector3d sum = corners.rowwise().sum();
    volume += v;
    first += v / 4 * sum;
    second += v / 20 * (corners * corners.transpose() + sum * sum.transpose());
  }
  const Vector3d centroid = first / volume;
  return {volume, centroid, second / volume - centroid * centroid.transpose()};
}

void ExpectVariance(const Superquadric& s, const Vector3d& per_squared_axis, double tolerance) {
  const Matrix3d expected =
      s.semi_axes.cwiseAbs2().cwiseProduct(per_squared_axis).asDiagonal().toDenseMatrix();
  const SolidMoments solid = ComputeSolidMoments(s);
  EXPECT_LT((solid.covariance_F - expected).norm(), tolerance * expected.norm())
      << solid.covariance_F;
  EXPECT_EQ(solid.centroid_F, Vector3d::Zero());
}

TEST(Volume, HasItsKnownAnswers) {
  EXPECT_NEAR(Volume(MakeShape(kAxes, 1, 1)), 4.0 / 3 * kPi * kAxes.prod(), 1e-12);
  EXPECT_NEAR(Volume(MakeShape(kAxes, 0.02, 0.02)), 8 * kAxes.prod(), 0.001 * kAxes.prod() * 8);
  EXPECT_NEAR(Volume(MakeShape(kAxes, 0.02, 1)), 2 * kPi * kAxes.prod(), 0.001 * kAxes.prod() * 8);
  EXPECT_NEAR(Volume(MakeShape(kAxes, 2, 2)), 4.0 / 3 * kAxes.prod(), 1e-12);  // octahedron
}

TEST(Volume, OfATaperedShapeAgreesWithCounting) {
  Superquadric s = MakeShape({1, 1, 1}, 0.5, 0.8);
  s.taper = {0.5, 0.4};
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> unit(-1.5, 1.5);
  int inside = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const Vector3d p(unit(engine), unit(engine), unit(engine));
    inside += std::abs(p.z()) < 1 && Gauge(s, p) < 1;
  }
  EXPECT_NEAR(Volume(s), 27.0 * inside / kCount, 0.05);
}

TEST(SolidMoments, AreThoseOfEllipsoidBoxCylinderAndOctahedron) {
  ExpectVariance(MakeShape(kAxes, 1, 1), Vector3d::Constant(1.0 / 5), 1e-12);
  ExpectVariance(MakeShape(kAxes, 0.02, 0.02), Vector3d::Constant(1.0 / 3), 0.002);
  ExpectVariance(MakeShape(kAxes, 0.02, 1), Vector3d(1.0 / 4, 1.0 / 4, 1.0 / 3), 0.002);
  ExpectVariance(MakeShape(kAxes, 2, 2), Vector3d::Constant(1.0 / 10), 1e-12);
}

TEST(SolidMoments, OfATaperedBoxAreThoseOfAFrustum) {
  Superquadric s = MakeShape({1, 1, 1}, 0.02, 0.02);
  s.taper = {-0.5, -0.5};  // half-widths 1.5 below, 0.5 above
  const SolidMoments solid = ComputeSolidMoments(s);
  const double lower = 9, upper = 1, middle = 3;  // areas of its ends, and their geometric mean
  EXPECT_NEAR(solid.volume_m3, 2.0 / 3 * (lower + middle + upper), 0.02);
  const double height = 2.0 / 4 * (lower + 2 * middle + 3 * upper) / (lower + middle + upper);
  EXPECT_NEAR(solid.centroid_F.z(), height - 1, 0.002);
}

TEST(SolidMoments, AgreeWithAMesh) {
  for (double e1 : {0.1, 0.5, 1.0, 2.0}) {
    for (double e2 : {0.1, 0.5, 1.0, 2.0}) {
      Superquadric s = MakeShape(kAxes, e1, e2, {0.1, -0.2, 0.8}, {0.4, 0.9, -0.3});
      for (const Vector2d& taper : {Vector2d(0, 0), Vector2d(0.8, -0.4), Vector2d(-0.5, -0.9)}) {
        s.taper = taper;
        const SolidMoments solid = ComputeSolidMoments(s), mesh = Integrate(MakeMesh(s, 384));
        EXPECT_NEAR(solid.volume_m3 / mesh.volume_m3, 1, 1e-3) << e1 << ' ' << e2;
        EXPECT_LT((solid.centroid_F - mesh.centroid_F).norm(), 1e-5) << e1 << ' ' << e2;
        EXPECT_LT((solid.covariance_F - mesh.covariance_F).norm(), 2e-3 * mesh.covariance_F.norm())
            << e1 << ' ' << e2;
      }
    }
  }
}

TEST(Inertia, IsThatOfABallAndOfATurnedRod) {
  const SolidMoments ball = ComputeSolidMoments(MakeShape(Vector3d::Constant(0.1), 1, 1));
  EXPECT_LT((Inertia(ball, 3) - 0.4 * 3 * 0.01 * Matrix3d::Identity()).norm(), 1e-12);
  // A thin rod along y resists turning about x and z: m (2 a)^2 / 12.
  const SolidMoments rod =
      ComputeSolidMoments(MakeShape({1e-5, 1e-5, 0.3}, 0.02, 1, {1, 2, 3}, {kPi / 2, 0, 0}));
  const Matrix3d inertia = Inertia(rod, 2);
  const double expected = 2 * 0.36 / 12;
  EXPECT_NEAR(inertia(0, 0), expected, 0.002 * expected);
  EXPECT_NEAR(inertia(2, 2), expected, 0.002 * expected);
  EXPECT_NEAR(inertia(1, 1), 0, 1e-9);
}

}  // namespace
}  // namespace beckon::pose
