// A lab's own meshes: what is read, what is refused.
#include "services/capture/mesh_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "services/capture/image_files.h"
#include "services/capture/object_set_writer.h"

namespace beckon::capture {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A cuboid of 6 x 4 x `height` cm, as OBJ with a picture that is red on all of it.
std::string Cuboid(double height_m) {
  std::string obj = "mtllib red.mtl\nusemtl m\n";
  for (const double z : {0.0, height_m}) {
    for (const char* xy : {"-0.03 -0.02 ", "0.03 -0.02 ", "0.03 0.02 ", "-0.03 0.02 "}) {
      obj += std::string("v ") + xy + std::to_string(z) + "\n";
    }
  }
  obj += "vt 0 0\nvt 1 0\nvt 1 1\n";
  for (const char* face : {"1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"}) {
    std::istringstream corners(face);
    obj += "f";
    for (int corner = 0; corners >> corner;) obj += " " + std::to_string(corner) + "/1";
    obj += "\n";
  }
  return obj;
}

class MeshFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("meshes_" + std::to_string(getpid()));
    fs::create_directories(folder_ / "Box");
    ASSERT_TRUE(WriteText(Path("Box/red.mtl"), "newmtl m\nKd 1 1 1\nmap_Kd red.png\n").ok());
    ASSERT_TRUE(WriteColourPng(Path("Box/red.png"), 2, 2, std::vector<Rgb>(4, {200, 10, 10})).ok());
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  std::string ErrorOf(const std::string& name, const std::string& text) {
    EXPECT_TRUE(WriteText(Path(name), text).ok());
    Random random(1);
    const auto model = ReadMesh({Path(name), "Box", "x"}, random);
    return model ? "" : model.error().message;
  }

  fs::path folder_;
};

TEST_F(MeshFilesTest, ReadsAMeshWithItsPictureAndItsCategorysHabits) {
  ASSERT_TRUE(WriteText(Path("Box/soap.obj"), Cuboid(0.1)).ok());
  const auto listed = ListMeshes(folder_.string());
  ASSERT_TRUE(listed.ok());
  ASSERT_EQ(listed->size(), 1u);
  EXPECT_EQ(listed->front().instance, "soap");
  Random random(1);
  const auto model = ReadMesh(listed->front(), random);
  ASSERT_TRUE(model.ok()) << model.error().message;
  EXPECT_EQ(model->category, "Box");
  EXPECT_TRUE(model->any_face);
  EXPECT_EQ(model->mesh.triangles.size(), 12u);
  Eigen::AlignedBox3f box;
  for (const auto& p : model->mesh.positions) box.extend(p);
  EXPECT_TRUE(box.center().isZero(1e-6f));
  EXPECT_TRUE(box.sizes().isApprox(Eigen::Vector3f(0.06f, 0.04f, 0.1f), 1e-4f));
  const Material& paint = model->materials.at(model->mesh.triangles.front().material);
  EXPECT_NEAR(paint.texture.Sample(0.5f, 0.5f).x(), 200, 1);
}

TEST_F(MeshFilesTest, SaysWhatIsWrongWithAMesh) {
  EXPECT_THAT(ErrorOf("Box/text.obj", "hello\n"), HasSubstr("text.obj"));
  EXPECT_THAT(ErrorOf("Box/empty.ply", ""), HasSubstr("empty.ply"));
  EXPECT_THAT(ErrorOf("Box/mm.obj", Cuboid(100)), HasSubstr("meshes are in metres"));
  EXPECT_THAT(ErrorOf("Box/far.obj", Cuboid(0.1) + "v 1e30 0 0\nf 1 2 9\n"), HasSubstr("far.obj"));
  EXPECT_THAT(ListMeshes(Path("nowhere")).error().message, HasSubstr("nowhere"));
  fs::create_directories(folder_ / "none");
  EXPECT_THAT(ListMeshes(Path("none")).error().message, HasSubstr("found none"));
}

TEST_F(MeshFilesTest, ADamagedMeshIsRefusedOrSound) {
  const std::string whole = Cuboid(0.1);
  for (const char* ending : {".obj", ".ply", ".stl"}) {
    const std::string name = std::string("Box/damaged") + ending;
    for (uint32_t round = 0; round < 150; ++round) {
      std::mt19937 engine(round);
      std::string damaged = whole;
      for (uint32_t i = engine() % 12; i > 0; --i) {
        damaged[engine() % damaged.size()] = static_cast<char>(engine());
      }
      if (round % 3 == 0) damaged.resize(engine() % damaged.size());
      ASSERT_TRUE(WriteText(Path(name), damaged).ok());
      Random random(round);
      const auto model = ReadMesh({Path(name), "Box", "x"}, random);
      if (!model) {
        EXPECT_THAT(model.error().message, HasSubstr("damaged")) << round;
        continue;
      }
      const Mesh& mesh = model->mesh;
      ASSERT_EQ(mesh.uv.size(), mesh.positions.size());
      for (const auto& p : mesh.positions) ASSERT_TRUE(p.allFinite()) << round;
      for (const auto& triangle : mesh.triangles) {
        ASSERT_LT(triangle.material, model->materials.size()) << round;
        for (const uint32_t corner : triangle.corners) ASSERT_LT(corner, mesh.positions.size());
      }
    }
  }
}

TEST_F(MeshFilesTest, RendersThemBesideTheFreshObjects) {
  ASSERT_TRUE(WriteText(Path("Box/soap.obj"), Cuboid(0.1)).ok());
  ObjectSetPlan plan;
  plan.per_category = 0;
  plan.views = 3;
  plan.meshes = folder_.string();
  size_t told = 0;
  ASSERT_TRUE(WriteObjectSet(Path("out"), plan, [&](size_t done, size_t all) {
                told = done;
                EXPECT_EQ(all, 1u);
              }).ok());
  EXPECT_EQ(told, 1u);
  EXPECT_TRUE(fs::exists(Path("out/Box/soap_view2_depth.png")));
  // So small that no camera sees enough of it.
  std::string needle = Cuboid(0.012);
  for (const char* wide : {"0.03", "0.02"}) {
    for (size_t at = needle.find(wide); at != std::string::npos; at = needle.find(wide)) {
      needle.replace(at, 4, "0.0005");
    }
  }
  ASSERT_TRUE(WriteText(Path("Box/needle.obj"), needle).ok());
  const auto refused = WriteObjectSet(Path("needles"), plan);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("Box/needle: fits no view"));
  fs::remove(Path("Box/needle.obj"));
  ASSERT_TRUE(WriteText(Path("Box/bad.obj"), "nothing\n").ok());
  const auto status = WriteObjectSet(Path("more"), plan);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("bad.obj"));
}

}  // namespace
}  // namespace beckon::capture
