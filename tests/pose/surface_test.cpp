// Points of the surface: on it, spread by area, apart from each other.
#include "services/pose/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "services/pose/mesh.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const std::vector<double> kExponents{0.05, 0.3, 1.0, 1.5, 2.0};

double Area(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](int i) { return mesh.vertices_F[static_cast<size_t>(t[size_t(i)])]; };
    area += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return area;
}

// Distance from each point to its nearest neighbour.
std::vector<double> Gaps(const std::vector<Vector3d>& points) {
  std::vector<double> gaps;
  for (const auto& p : points) {
    double nearest = 1e300;
    for (const auto& q : points) {
      if (&p != &q) nearest = std::min(nearest, (p - q).norm());
    }
    gaps.push_back(nearest);
  }
  return gaps;
}

TEST(SampleSurface, LiesOnItWithAndWithoutTaper) {
  for (double e1 : kExponents) {
    for (double e2 : kExponents) {
      Superquadric s = MakeShape({0.02, 0.06, 0.11}, e1, e2, {1, 2, 3}, {0.3, 0.2, -0.9});
      for (const Vector2d& taper : {Vector2d(0, 0), Vector2d(0.3, -0.2), Vector2d(0.9, -0.95)}) {
        s.taper = taper;
        const auto points = SampleSurface(s, 200);
        ASSERT_EQ(points.size(), 200u);
        for (const auto& p : points) EXPECT_NEAR(Gauge(s, s.X_FO.inverse() * p), 1, 1e-6);
      }
    }
  }
}

TEST(SampleSurface, SpreadsOverASphereEvenly) {
  std::array<int, 10> slices{};
  std::array<int, 8> octants{};
  constexpr int kCount = 4000;
  for (const auto& p : SampleSurface(MakeShape(Vector3d::Ones(), 1, 1), kCount)) {
    ++slices[static_cast<size_t>(std::clamp(5 * (p.z() + 1), 0.0, 9.9))];  // of equal area
    ++octants[(p.x() > 0 ? 1u : 0u) + (p.y() > 0 ? 2u : 0u) + (p.z() > 0 ? 4u : 0u)];
  }
  for (int n : slices) EXPECT_NEAR(n, kCount / 10, 4);
  for (int n : octants) EXPECT_NEAR(n, kCount / 8, 10);
}

// Which pair of a box's faces a point is on: 0 those across x, ..
int FaceOf(const Superquadric& box, const Vector3d& p) {
  int face;
  p.cwiseQuotient(box.semi_axes).cwiseAbs().maxCoeff(&face);
  return face;
}

// The share of the area of each pair of faces, of a mesh fine enough for their rounded edges.
Vector3d AreaShares(const Superquadric& box) {
  const TriangleMesh mesh = MakeMesh(box, 256);
  Vector3d area = Vector3d::Zero();
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](size_t i) { return mesh.vertices_F[static_cast<size_t>(t[i])]; };
    area[FaceOf(box, corner(0) + corner(1) + corner(2))] +=
        (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return area / area.sum();
}

TEST(SampleSurface, GivesABoxsFacesPointsByTheirArea) {
  for (const Vector3d& a : {Vector3d(1, 1, 1), Vector3d(2, 2, 12), Vector3d(12, 2, 2),
                            Vector3d(2, 12, 2), Vector3d(12, 12, 1), Vector3d(1, 3, 5)}) {
    const Superquadric box = MakeShape(a, 0.05, 0.05);
    const Vector3d expected = AreaShares(box);
    for (int count : {150, 2000}) {
      Vector3d error = -expected;
      for (const auto& p : SampleSurface(box, count)) error[FaceOf(box, p)] += 1.0 / count;
      EXPECT_LT(error.cwiseAbs().maxCoeff(), count < 1000 ? 0.03 : 0.01)
          << a.transpose() << ", " << count << " points, off by " << error.transpose();
    }
  }
}

// Within a face too: the outermost tenth of its sides holds as much as its area says.
TEST(SampleSurface, DoesNotCrowdABoxsEdges) {
  const Superquadric box = MakeShape({2, 2, 12}, 0.05, 0.05);
  int on_side = 0, near_upright_edge = 0, near_end = 0;
  for (const auto& p : SampleSurface(box, 4000)) {
    const Vector3d u = p.cwiseQuotient(box.semi_axes).cwiseAbs();
    if (u.z() >= std::max(u.x(), u.y())) continue;
    ++on_side;
    near_upright_edge += std::min(u.x(), u.y()) > 0.85;
    near_end += u.z() > 0.9;
  }
  const double end = std::pow(2, -0.025);  // where the rounded edge is highest
  EXPECT_NEAR(near_upright_edge, (end - 0.85) / end * on_side, 0.02 * on_side);
  EXPECT_NEAR(near_end, (end - 0.9) / end * on_side, 0.01 * on_side);
}

TEST(SampleSurface, KeepsPointsApartAndLeavesNoHoles) {
  constexpr int kCount = 400;
  for (double e1 : kExponents) {
    for (double e2 : kExponents) {
      for (const Vector3d& a : {Vector3d(2, 2, 2), Vector3d(2, 2, 12), Vector3d(12, 3, 2)}) {
        Superquadric s = MakeShape(a, e1, e2);
        for (const Vector2d& taper : {Vector2d(0, 0), Vector2d(0.5, -0.3)}) {
          s.taper = taper;
          const double spacing = std::sqrt(Area(MakeMesh(s, 64)) / kCount);
          auto gaps = Gaps(SampleSurface(s, kCount));
          std::sort(gaps.begin(), gaps.end());
          const std::string what = "e " + std::to_string(e1) + ' ' + std::to_string(e2) + " a " +
                                   std::to_string(a.x()) + " taper " + std::to_string(taper.x());
          EXPECT_GT(gaps[kCount / 50], 0.2 * spacing) << what;
          EXPECT_GT(gaps[kCount / 2], 0.55 * spacing) << what;
          EXPECT_LT(gaps[kCount - kCount / 50], 1.6 * spacing) << what;
          EXPECT_LT(gaps.back(), 2.5 * spacing) << what;  // in the tips of a thin diamond
        }
      }
    }
  }
}

TEST(SampleSurface, FollowsTheAreaOfATaperedBox) {
  Superquadric s = MakeShape({1, 1, 2}, 0.05, 0.05);
  s.taper = {0.6, 0.6};
  int lower = 0, upper = 0, side = 0;
  for (const auto& p : SampleSurface(s, 4000)) {
    lower += p.z() < -1.97;
    upper += p.z() > 1.97;
    side += std::abs(p.z()) < 1.97 && p.z() > 0;
  }
  // Ends of half-widths 0.4 and 1.6, four sides between them, which slope by 0.3.
  const double half_side = 4 * 0.5 * (2 + 3.2) * 2 * std::hypot(1, 0.3);
  const double lower_side = 4 * 0.5 * (2 + 0.8) * 2 * std::hypot(1, 0.3);
  const double total = 0.64 + 10.24 + half_side + lower_side;
  EXPECT_NEAR(lower / 4000.0, 0.64 / total, 0.01);
  EXPECT_NEAR(upper / 4000.0, 10.24 / total, 0.02);
  EXPECT_NEAR(side / 4000.0, half_side / total, 0.02);
}

TEST(SampleSurface, TakesAnyNumber) {
  const Superquadric s = MakeShape({0.02, 0.03, 0.05}, 0.1, 1);
  EXPECT_TRUE(SampleSurface(s, 0).empty());
  EXPECT_TRUE(SampleSurface(s, -1).empty());
  for (int count : {1, 2, 7}) {
    const auto points = SampleSurface(s, count);
    ASSERT_EQ(points.size(), static_cast<size_t>(count));
    for (const auto& p : points) EXPECT_NEAR(Gauge(s, p), 1, 1e-9);
  }
}

TEST(SurfacePoint, GoesAroundLevelAndFromPoleToPole) {
  const Superquadric box = MakeShape({0.02, 0.03, 0.05}, 0.05, 0.05);
  constexpr double kPi = std::numbers::pi;
  EXPECT_LT((SurfacePoint(box, kPi / 2, 0.3) - Vector3d(0, 0, 0.05)).norm(), 1e-12);
  EXPECT_LT((SurfacePoint(box, 0, kPi / 2) - Vector3d(0, 0.03, 0)).norm(), 1e-12);
  for (double longitude : {0.1, 0.9, 2.0, 4.0}) {
    EXPECT_NEAR(SurfacePoint(box, 0.4, longitude).z(), SurfacePoint(box, 0.4, 0).z(), 1e-15);
    EXPECT_NEAR(Gauge(box, SurfacePoint(box, 0.4, longitude)), 1, 1e-12);
  }
}

TEST(ShapeDifference, SeesShapesNotParameters) {
  const Superquadric box = MakeShape({0.03, 0.05, 0.08}, 0.1, 0.1);
  const Superquadric same =
      MakeShape({0.05, 0.03, 0.08}, 0.1, 0.1, Vector3d::Zero(), {0, 0, std::numbers::pi / 2});
  EXPECT_LT(ShapeDifference(box, same), 1e-6);
  EXPECT_GT(ShapeDifference(box, MakeShape({0.03, 0.05, 0.05}, 0.1, 0.1)), 0.003);
}

TEST(ShapeDifference, OfASquarePrismAndItsTurnedDualIsSmall) {
  const double a = 0.04;
  const Superquadric box = MakeShape({a, a, 0.08}, 0.1, 0.02);
  const double wide = a * std::numbers::sqrt2;
  const Superquadric dual =
      MakeShape({wide, wide, 0.08}, 0.1, 2, Vector3d::Zero(), {0, 0, std::numbers::pi / 4});
  EXPECT_LT(ShapeDifference(box, dual), 0.001);
}

}  // namespace
}  // namespace beckon::pose
