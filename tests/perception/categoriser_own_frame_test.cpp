// The cue of the object's own frame counts the same however an object rests; up is found from the
// table around an object.
#include "services/perception/cue_own_frame.h"

#include <gtest/gtest.h>

#include "services/perception/cue_up.h"
#include "tests/perception/categoriser_shapes.h"

namespace beckon::perception {
namespace {

// Places in what MeasureOwnAxis appends: after 10 radii, 10 spreads and 9 steps.
constexpr size_t kUpright = 29, kLength = 30, kRadius = 31, kResidual = 34;
// In what MeasureFaces appends: 7 numbers a face.
constexpr size_t kShare = 0, kFaceLength = 1, kFaceWidth = 2, kExact = 6;

Shape LyingCan(double radius, double length, double turn) {
  return [=](const Eigen::Vector3d& p) {
    const double along = std::cos(turn) * p.x() + std::sin(turn) * p.y();
    const double across = -std::sin(turn) * p.x() + std::cos(turn) * p.y();
    return std::max(std::hypot(across, p.z() - radius) - radius, std::abs(along) - length / 2);
  };
}

std::vector<float> Axis(const Shape& shape) {
  std::mt19937 random(1);
  const ShapeView seen = RenderShape(shape, random);
  const ObjectView view = seen.view();
  std::vector<float> out;
  MeasureOwnAxis(MakeCueView(view), out);
  return out;
}

std::vector<float> Faces(const Shape& shape) {
  std::mt19937 random(1);
  const ShapeView seen = RenderShape(shape, random);
  const ObjectView view = seen.view();
  std::vector<float> out;
  MeasureFaces(MakeCueView(view), out);
  return out;
}

TEST(OwnFrame, ACanIsTheSameStandingAndLying) {
  const auto standing = Axis(CanShape(0.033, 0.12));
  for (const double turn : {0.0, 0.6, -0.4}) {
    const auto lying = Axis(LyingCan(0.033, 0.12, turn));
    EXPECT_GT(standing[kUpright], 0.97);
    EXPECT_LT(lying[kUpright], 0.2) << turn;
    EXPECT_NEAR(standing[kLength], lying[kLength], 0.02) << turn;
    EXPECT_NEAR(standing[kRadius], lying[kRadius], 0.012) << turn;
    EXPECT_LT(lying[kResidual], 0.2) << turn;
  }
}

TEST(OwnFrame, ABoxHasFlatFacesOfItsSizeAndACanHasNot) {
  const auto box = Faces(BoxShape(0.14, 0.06, 0.11, 0.1));
  EXPECT_GT(box[kShare], 0.4);
  EXPECT_NEAR(box[kFaceLength], 0.14, 0.02);
  EXPECT_NEAR(box[kFaceWidth], 0.11, 0.02);
  EXPECT_GT(box[kExact], 0.85);
  const auto can = Faces(CanShape(0.04, 0.12));
  EXPECT_LT(can[kExact], box[kExact]);
  EXPECT_LT(can[kShare], box[kShare]);
}

TEST(OwnFrame, IsFiniteOnWhatIsHardlyAnything) {
  std::mt19937 random(2);
  ShapeView seen = RenderShape(CanShape(0.03, 0.1), random);
  seen.pixels.resize(21);
  const ObjectView view = seen.view();
  const Descriptors values = OwnFrameCue().Describe(MakeCueView(view));
  EXPECT_EQ(values.cols(), OwnFrameCue().dimension());
  EXPECT_TRUE(values.allFinite());
}

/// The shape on a table; the mask is the shape's alone.
ShapeView OnATable(const Shape& shape) {
  std::mt19937 random(3);
  ShapeView alone = RenderShape(shape, random);
  ShapeView out = RenderShape(
      [&](const Eigen::Vector3d& p) { return std::min(shape(p), p.z() + 1e-3); }, random);
  out.pixels = alone.pixels;
  return out;
}

TEST(EstimateUp, FindsTheTableAroundAnObject) {
  for (const Shape& shape :
       {CanShape(0.033, 0.12), BoxShape(0.1, 0.05, 0.08, 0.4), BowlShape(0.06)}) {
    const ShapeView seen = OnATable(shape);
    const auto up = EstimateUp({seen.image, seen.pixels});
    ASSERT_TRUE(up);
    EXPECT_GT(up->dot(seen.table_C.normal.cast<float>()), std::cos(0.02));
  }
}

TEST(EstimateUp, SaysNothingWhereNoTableIsSeen) {
  std::mt19937 random(4);
  const ShapeView alone = RenderShape(CanShape(0.033, 0.12), random);
  EXPECT_FALSE(EstimateUp({alone.image, alone.pixels}));
  // All that is seen around it is a wall behind it.
  ShapeView wall = alone;
  for (float& z : wall.image.depth_m) z = z > 0 ? z : 0.95F;
  EXPECT_FALSE(EstimateUp({wall.image, wall.pixels}));
  ShapeView nothing = alone;
  nothing.pixels.clear();
  EXPECT_FALSE(EstimateUp({nothing.image, nothing.pixels}));
}

}  // namespace
}  // namespace beckon::perception
