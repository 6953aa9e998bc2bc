// Meshes of superquadrics: closed, outward, on the surface; and their files.
#include "services/pose/mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <sstream>
#include <utility>

#include "services/base/ply_file.h"
#include "services/pose/solid.h"
#include "tests/pose/views.h"

namespace beckon::pose {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// How often each edge is gone along in each direction.
std::map<std::pair<int, int>, int> Edges(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  return edges;
}

double EnclosedVolume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    Matrix3d corners;
    for (int i = 0; i < 3; ++i) {
      corners.col(i) = mesh.vertices_F[static_cast<size_t>(t[static_cast<size_t>(i)])];
    }
    volume += corners.determinant() / 6;
  }
  return volume;
}

TEST(Mesh, IsClosedAndOutwardAndOnTheSurface) {
  for (double e1 : {0.05, 1.0, 2.0}) {
    for (double e2 : {0.05, 1.0, 2.0}) {
      Superquadric s = MakeShape({0.03, 0.05, 0.12}, e1, e2, {0.2, -0.1, 0.9}, {0.5, 0.2, -1});
      for (const Vector2d& taper : {Vector2d(0, 0), Vector2d(0.5, -0.8)}) {
        s.taper = taper;
        const TriangleMesh mesh = MakeMesh(s, 64);
        const auto edges = Edges(mesh);
        for (const auto& [edge, times] : edges) {
          ASSERT_EQ(times, 1);
          ASSERT_TRUE(edges.contains({edge.second, edge.first}));
        }
        EXPECT_EQ(mesh.vertices_F.size() + mesh.triangles.size(), edges.size() / 2 + 2);  // Euler
        EXPECT_NEAR(EnclosedVolume(mesh) / Volume(s), 1, 0.01);
        for (const auto& p : mesh.vertices_F) {
          EXPECT_NEAR(Gauge(s, s.X_FO.inverse() * p), 1, 1e-6);
        }
      }
    }
  }
}

TEST(Mesh, HasTheEdgesOfABoxAndOfACylinder) {
  const Vector3d a(0.03, 0.05, 0.12);
  const Superquadric box = MakeShape(a, 0.02, 0.02), cylinder = MakeShape(a, 0.02, 1);
  EXPECT_NEAR(EnclosedVolume(MakeMesh(box, 8)), 8 * a.prod(), 0.05 * 8 * a.prod());
  EXPECT_NEAR(EnclosedVolume(MakeMesh(cylinder, 64)), Volume(cylinder), 0.005 * Volume(cylinder));
}

TEST(Mesh, RoundsItsSegmentsUp) {
  const Superquadric s;
  EXPECT_EQ(MakeMesh(s, 0).vertices_F.size(), 2u + 3 * 8);
  EXPECT_EQ(MakeMesh(s, 9).vertices_F.size(), 2u + 7 * 16);
}

TEST(Mesh, ReadsBackFromPly) {
  const std::vector<MeshPiece> pieces{
      {MakeMesh(MakeShape({0.03, 0.05, 0.12}, 0.1, 1, {0.1, 0, 0.5}), 16), 1, 0},
      {MakeMesh(MakeShape({1, 2, 3}, 0.1, 1), 8), 3, 2}};
  const TriangleMesh &one = pieces[0].mesh, &other = pieces[1].mesh;
  const std::string text = MeshToPly(pieces);
  const auto cloud = cloud::ParsePly(text);
  ASSERT_TRUE(cloud) << cloud.error().message;
  std::vector<Vector3d> vertices = one.vertices_F;
  vertices.insert(vertices.end(), other.vertices_F.begin(), other.vertices_F.end());
  ASSERT_EQ(cloud->points.size(), vertices.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    EXPECT_EQ(cloud->points[i], vertices[i].cast<float>());
  }
  // The faces: corners of the file, then object and part.
  std::istringstream faces(text.substr(text.find("end_header\n") + 11));
  std::string line;
  for (size_t i = 0; i < vertices.size(); ++i) std::getline(faces, line);
  for (const MeshPiece& piece : pieces) {
    const int first = &piece == pieces.data() ? 0 : static_cast<int>(one.vertices_F.size());
    for (const auto& t : piece.mesh.triangles) {
      std::array<int, 6> face;
      for (int& number : face) ASSERT_TRUE(faces >> number);
      EXPECT_EQ(face, (std::array<int, 6>{3, first + t[0], first + t[1], first + t[2], piece.object,
                                          piece.part}));
    }
  }
  EXPECT_FALSE(faces >> line);
}

}  // namespace
}  // namespace beckon::pose
