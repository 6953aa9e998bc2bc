#include "services/base/geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace beckon {
namespace {

TEST(Geometry, ProjectionUndoesUnprojection) {
  const Intrinsics k{.fx = 525, .fy = 520, .cx = 319.5, .cy = 239.5};
  const Eigen::Vector2d pixel = k.Project(k.Unproject(100, 40, 0.8));
  EXPECT_NEAR(pixel.x(), 100, 1e-9);
  EXPECT_NEAR(pixel.y(), 40, 1e-9);
}

TEST(Geometry, QuaternionRoundTripKeepsTheRotation) {
  const auto pose = MakePose({1, 2, 3}, {std::sqrt(0.5), 0, std::sqrt(0.5), 0});
  ASSERT_TRUE(pose.ok());
  const auto back = MakePose({1, 2, 3}, QuaternionWxyz(*pose));
  ASSERT_TRUE(back.ok());
  EXPECT_TRUE(back->isApprox(*pose, 1e-12));
}

TEST(Geometry, RefusesQuaternionsOfOtherNorms) {
  EXPECT_FALSE(MakePose({0, 0, 0}, {0, 0, 0, 0}).ok());
  EXPECT_FALSE(MakePose({0, 0, 0}, {2, 0, 0, 0}).ok());
  EXPECT_FALSE(MakePose({0, 0, 0}, {NAN, 0, 0, 1}).ok());
  EXPECT_FALSE(MakePose({INFINITY, 0, 0}, {1, 0, 0, 0}).ok());
}

TEST(Geometry, TablePutsTheWorldUnderTheCamera) {
  // A camera 0.8 m above the table, pitched 40 degrees down.
  const double pitch = 40 * M_PI / 180;
  const Plane table_C{.normal = {0, -std::cos(pitch), -std::sin(pitch)}, .offset_m = 0.8};
  const Pose X_WC = WorldFromTable(table_C);
  EXPECT_TRUE((X_WC.linear() * X_WC.linear().transpose()).isIdentity(1e-12));
  EXPECT_NEAR(X_WC.linear().determinant(), 1, 1e-12);
  EXPECT_TRUE((X_WC * Eigen::Vector3d::Zero()).isApprox(Eigen::Vector3d(0, 0, 0.8)));
  // What the camera looks at lies on the table, straight ahead.
  const Eigen::Vector3d p_C(0, 0, 0.8 / std::sin(pitch));
  EXPECT_TRUE((X_WC * p_C).isApprox(Eigen::Vector3d(0, 0.8 / std::tan(pitch), 0), 1e-9));
  // The image's right is the world's right.
  EXPECT_NEAR((X_WC.linear() * Eigen::Vector3d::UnitX()).x(), 1, 1e-12);
}

TEST(Geometry, ACameraLookingStraightDownHasAWorldToo) {
  const Pose X_WC = WorldFromTable({.normal = {0, 0, -1}, .offset_m = 1});
  EXPECT_TRUE(X_WC.matrix().allFinite());
  EXPECT_NEAR(X_WC.linear().determinant(), 1, 1e-12);
}

TEST(Geometry, RefusesImpossibleIntrinsics) {
  EXPECT_TRUE(Validate(Intrinsics{}).ok());
  EXPECT_FALSE(Validate(Intrinsics{.fx = 0}).ok());
  EXPECT_FALSE(Validate(Intrinsics{.fy = std::numeric_limits<double>::quiet_NaN()}).ok());
  EXPECT_FALSE(Validate(Intrinsics{.cx = INFINITY}).ok());
}

}  // namespace
}  // namespace beckon
