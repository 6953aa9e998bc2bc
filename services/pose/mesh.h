// A superquadric's surface as triangles.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "services/pose/superquadric.h"

namespace beckon::pose {

/// Triangles in a frame F; seen from outside their corners go counter-clockwise.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices_F;    // m
  std::vector<std::array<int, 3>> triangles;  // indices of vertices
};

/// The closed surface, its vertices on the superquadric: `segments` around, half as many from pole
/// to pole. At least 8; rounded up to a multiple of 8, so that the edges of boxes and cylinders are
/// edges of the mesh.
TriangleMesh MakeMesh(const Superquadric& shape, int segments);

/// A mesh of a file and what it is of.
struct MeshPiece {
  TriangleMesh mesh;
  int object = 1;
  int part = 0;  // 0 = the object as one shape, k = the k-th of its parts
};

/// The text of a PLY file (ascii 1.0) of meshes in the same frame, metres. Each face tells its
/// piece's `object` and `part`.
std::string MeshToPly(const std::vector<MeshPiece>& pieces);

}  // namespace beckon::pose
