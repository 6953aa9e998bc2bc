#include "services/capture/embedded_mesh.h"

#include <cmath>
#include <numbers>

namespace beckon::capture {

uint32_t Mesh::AddVertex(const Eigen::Vector3d& position, double u, double v) {
  positions.push_back(position.cast<float>());
  uv.emplace_back(static_cast<float>(u), static_cast<float>(v));
  return static_cast<uint32_t>(positions.size() - 1);
}

void Mesh::Append(const Mesh& other) {
  const auto base = static_cast<uint32_t>(positions.size());
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  uv.insert(uv.end(), other.uv.begin(), other.uv.end());
  for (Triangle triangle : other.triangles) {
    for (uint32_t& corner : triangle.corners) corner += base;
    triangles.push_back(triangle);
  }
}

void Mesh::Transform(const Pose& pose) {
  for (auto& p : positions) p = (pose * p.cast<double>()).cast<float>();
}

Mesh Loft(const std::vector<Ring>& rings, int segments) {
  Mesh mesh;
  for (const Ring& ring : rings) {
    for (int s = 0; s <= segments; ++s) {
      const double angle = 2 * std::numbers::pi * s / segments;
      const double c = std::cos(angle), sn = std::sin(angle);
      const double power = 2.0 / ring.exponent;
      const double x = std::copysign(std::pow(std::abs(c), power), c) * ring.rx;
      const double y = std::copysign(std::pow(std::abs(sn), power), sn) * ring.ry;
      mesh.AddVertex({x, y, ring.z}, static_cast<double>(s) / segments, ring.v);
    }
  }
  const auto row = static_cast<uint32_t>(segments + 1);
  for (uint32_t r = 0; r + 1 < rings.size(); ++r) {
    const uint32_t material = rings[r].material;
    for (uint32_t s = 0; s < static_cast<uint32_t>(segments); ++s) {
      const uint32_t a = r * row + s, b = a + 1, c = b + row, d = a + row;
      if (rings[r].rx > 0) mesh.triangles.push_back({{a, b, c}, material});
      if (rings[r + 1].rx > 0) mesh.triangles.push_back({{a, c, d}, material});
    }
  }
  return mesh;
}

void AddQuad(Mesh& mesh, const std::array<Eigen::Vector3d, 4>& corners, uint32_t material,
             const Eigen::Vector2d& uv_min, const Eigen::Vector2d& uv_max) {
  const uint32_t a = mesh.AddVertex(corners[0], uv_min.x(), uv_min.y());
  const uint32_t b = mesh.AddVertex(corners[1], uv_max.x(), uv_min.y());
  const uint32_t c = mesh.AddVertex(corners[2], uv_max.x(), uv_max.y());
  const uint32_t d = mesh.AddVertex(corners[3], uv_min.x(), uv_max.y());
  mesh.triangles.push_back({{a, b, c}, material});
  mesh.triangles.push_back({{a, c, d}, material});
}

Mesh BoxMesh(const Eigen::Vector3d& size, const std::array<uint32_t, 6>& materials) {
  const double x = size.x() / 2, y = size.y() / 2, z = size.z();
  Mesh mesh;
  AddQuad(mesh, {{{-x, -y, 0}, {x, -y, 0}, {x, -y, z}, {-x, -y, z}}}, materials[0]);
  AddQuad(mesh, {{{x, y, 0}, {-x, y, 0}, {-x, y, z}, {x, y, z}}}, materials[1]);
  AddQuad(mesh, {{{-x, y, 0}, {-x, -y, 0}, {-x, -y, z}, {-x, y, z}}}, materials[2]);
  AddQuad(mesh, {{{x, -y, 0}, {x, y, 0}, {x, y, z}, {x, -y, z}}}, materials[3]);
  AddQuad(mesh, {{{-x, y, 0}, {x, y, 0}, {x, -y, 0}, {-x, -y, 0}}}, materials[4]);
  AddQuad(mesh, {{{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}}}, materials[5]);
  return mesh;
}

Mesh Sweep(const std::vector<Eigen::Vector3d>& path, const Eigen::Vector3d& side, double half_width,
           double half_thickness, uint32_t material, int segments) {
  Mesh mesh;
  const size_t n = path.size();
  for (size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d along =
        (path[std::min(i + 1, n - 1)] - path[i == 0 ? 0 : i - 1]).normalized();
    const Eigen::Vector3d across = along.cross(side).normalized();
    for (int s = 0; s <= segments; ++s) {
      const double angle = 2 * std::numbers::pi * s / segments;
      mesh.AddVertex(path[i] + side * (half_width * std::cos(angle)) +
                         across * (half_thickness * std::sin(angle)),
                     static_cast<double>(s) / segments, static_cast<double>(i) / (n - 1));
    }
  }
  const auto row = static_cast<uint32_t>(segments + 1);
  for (uint32_t r = 0; r + 1 < n; ++r) {
    for (uint32_t s = 0; s < static_cast<uint32_t>(segments); ++s) {
      const uint32_t a = r * row + s, b = a + 1, c = b + row, d = a + row;
      mesh.triangles.push_back({{a, b, c}, material});
      mesh.triangles.push_back({{a, c, d}, material});
    }
  }
  return mesh;
}

}  // namespace beckon::capture
