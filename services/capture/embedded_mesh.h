// Triangle meshes of the embedded scene and the few ways to build them: lofts, boxes, swept tubes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "services/base/geometry.h"

namespace beckon::capture {

/// Positions in metres, z up. Texture coordinates are 0 .. 1, v upwards.
struct Mesh {
  struct Triangle {
    std::array<uint32_t, 3> corners;
    uint32_t material = 0;  // index into the model's materials
  };
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector2f> uv;  // one a position
  std::vector<Triangle> triangles;

  uint32_t AddVertex(const Eigen::Vector3d& position, double u, double v);
  void Append(const Mesh& other);
  void Transform(const Pose& pose);
};

/// One cross-section of a loft: the superellipse |x/rx|^n + |y/ry|^n = 1 around the z axis.
struct Ring {
  double z = 0;
  double rx = 0;
  double ry = 0;
  double exponent = 2;    // 2 = ellipse, larger = a rectangle with rounded corners
  double v = 0;           // texture coordinate
  uint32_t material = 0;  // of the surface from here to the next ring
};

/// Joins rings in order with `segments` quads each; a ring of radius 0 closes an end. The surface
/// may turn back inwards (a bowl's inside). Triangles are seen from both sides.
Mesh Loft(const std::vector<Ring>& rings, int segments = 56);

/// A box from (-size/2, -size/2, 0) to (size/2, size/2, size). Faces in order -y +y -x +x -z +z
/// take the materials given; each face spans the whole texture, upright on the four sides.
Mesh BoxMesh(const Eigen::Vector3d& size, const std::array<uint32_t, 6>& materials);

/// A tube of elliptic cross-section (`half_width` along `side`, `half_thickness` across it) along a
/// path.
Mesh Sweep(const std::vector<Eigen::Vector3d>& path, const Eigen::Vector3d& side, double half_width,
           double half_thickness, uint32_t material, int segments = 12);

/// Convex polygons of four corners (a b c d in order around it) as two triangles each.
void AddQuad(Mesh& mesh, const std::array<Eigen::Vector3d, 4>& corners, uint32_t material,
             const Eigen::Vector2d& uv_min = {0, 0}, const Eigen::Vector2d& uv_max = {1, 1});

}  // namespace beckon::capture
