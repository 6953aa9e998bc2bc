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

/// Adds another mesh of the same frame.
void Append(const TriangleMesh& more, TriangleMesh& mesh);

/// The text of a PLY file (ascii 1.0), metres.
std::string MeshToPly(const TriangleMesh& mesh);

}  // namespace beckon::pose
