// Procedural objects: sizes of their kind, poses that rest on the table.
#include "services/capture/embedded_model.h"

#include <gtest/gtest.h>

#include "services/capture/embedded_stage.h"

namespace beckon::capture {
namespace {

Eigen::Vector3f Extent(const Model& model) {
  Eigen::AlignedBox3f box;
  for (const auto& p : model.mesh.positions) box.extend(p);
  return box.sizes();
}

TEST(EmbeddedModelTest, EveryCategoryIsSoundAndOfItsSize) {
  for (size_t c = 0; c < kCategories.size(); ++c) {
    for (uint64_t seed = 0; seed < 40; ++seed) {
      Random random(seed);
      const Model model = MakeModel(c, random);
      EXPECT_EQ(model.category, kCategories[c]);
      const Mesh& mesh = model.mesh;
      ASSERT_EQ(mesh.uv.size(), mesh.positions.size());
      for (const auto& p : mesh.positions) ASSERT_TRUE(p.allFinite()) << model.category << seed;
      for (const auto& t : mesh.triangles) {
        ASSERT_LT(t.material, model.materials.size());
        for (uint32_t corner : t.corners) ASSERT_LT(corner, mesh.positions.size());
      }
      const Eigen::Vector3f extent = Extent(model);
      EXPECT_GT(extent.minCoeff(), 0.015) << model.category << seed;
      EXPECT_LT(extent.maxCoeff(), 0.33) << model.category << seed;
    }
  }
}

TEST(EmbeddedModelTest, KeepsTheProportionsOfItsKind) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const Eigen::Vector3f bottle = Extent(MakeModel(0, random));
    EXPECT_GT(bottle.z(), 1.2f * bottle.y());
    const Eigen::Vector3f bowl = Extent(MakeModel(1, random));
    EXPECT_LT(bowl.z(), 0.61f * bowl.x());
    const Eigen::Vector3f mug = Extent(MakeModel(6, random));
    EXPECT_GT(mug.x(), mug.y() + 0.015f) << "a mug has a handle";
    const Eigen::Vector3f tube = Extent(MakeModel(9, random));
    EXPECT_GT(tube.z(), 2.0f * tube.y());
  }
}

TEST(EmbeddedModelTest, ThingsOfNoCategoryAreSoundAndOfATablesSize) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const Model model = MakeUnknownModel(random);
    EXPECT_EQ(model.category, kUnknown);
    ASSERT_EQ(model.mesh.uv.size(), model.mesh.positions.size());
    for (const auto& p : model.mesh.positions) ASSERT_TRUE(p.allFinite()) << seed;
    for (const auto& t : model.mesh.triangles) ASSERT_LT(t.material, model.materials.size());
    EXPECT_GT(Extent(model).maxCoeff(), 0.04) << seed;
    EXPECT_LT(Extent(model).maxCoeff(), 0.6) << seed;
  }
}

TEST(EmbeddedModelTest, RestsOnTheTable) {
  for (uint64_t seed = 0; seed < 120; ++seed) {
    Random random(seed);
    const Model model = MakeModel(seed % kCategories.size(), random);
    const Pose pose = RestingPose(model, random);
    double lowest = 1e9;
    for (const auto& p : model.mesh.positions)
      lowest = std::min(lowest, (pose * p.cast<double>()).z());
    EXPECT_NEAR(lowest, 0, 1e-9);
    EXPECT_NEAR(pose.linear().determinant(), 1, 1e-9);
    EXPECT_EQ(pose.translation().head<2>().norm(), 0);
  }
}

TEST(EmbeddedModelTest, SeedsDecideEverything) {
  Random a(5), b(5), c(6);
  const Model x = MakeModel(0, a), y = MakeModel(0, b), z = MakeModel(0, c);
  EXPECT_TRUE(x.mesh.positions == y.mesh.positions);
  EXPECT_EQ(x.materials[0].texture.pixels, y.materials[0].texture.pixels);
  EXPECT_FALSE(x.mesh.positions == z.mesh.positions);
}

TEST(FootprintTest, GapsOfConvexOutlines) {
  const std::vector<Eigen::Vector2d> square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::vector<Eigen::Vector2d> other = square;
  for (auto& p : other) p.x() += 1.25;
  EXPECT_NEAR(Gap(square, other), 0.25, 1e-12);
  for (auto& p : other) p.x() -= 0.5;
  EXPECT_NEAR(Gap(square, other), -0.25, 1e-12);
  EXPECT_LT(Gap(square, square), 0);
}

TEST(TextureTest, SamplesRepeatAcrossAndEndUpwards) {
  const Texture texture{2, 2, {{0, 0, 0}, {100, 0, 0}, {0, 100, 0}, {0, 0, 100}}};
  EXPECT_TRUE(texture.Sample(0.25f, 1.0f).isApprox(Eigen::Vector3f(0, 0, 0)));
  EXPECT_TRUE(texture.Sample(1.75f, 1.0f).isApprox(Eigen::Vector3f(100, 0, 0)));
  EXPECT_TRUE(texture.Sample(-0.25f, 0.0f).isApprox(Eigen::Vector3f(0, 0, 100)));
  EXPECT_TRUE(texture.Sample(0.5f, 2.0f).isApprox(Eigen::Vector3f(50, 0, 0)));
}

}  // namespace
}  // namespace beckon::capture
