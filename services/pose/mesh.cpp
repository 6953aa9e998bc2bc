// A superquadric's surface as triangles.
#include "services/pose/mesh.h"

#include <algorithm>
#include <charconv>
#include <numbers>

#include "services/pose/surface.h"

namespace beckon::pose {
namespace {

// Single precision in as few digits as it needs, whatever the locale.
void AppendNumber(double value, std::string& text) {
  std::array<char, 32> digits;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(value)).ptr;
  text.append(digits.data(), end);
}

}  // namespace

TriangleMesh MakeMesh(const Superquadric& shape, int segments) {
  constexpr double kPi = std::numbers::pi;
  const int columns = 8 * ((std::max(segments, 8) + 7) / 8), rows = columns / 2;
  TriangleMesh mesh;
  // The lower pole, the rings from below, the upper pole.
  mesh.vertices_F.push_back(SurfacePoint(shape, -kPi / 2, 0));
  for (int i = 1; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      mesh.vertices_F.push_back(
          SurfacePoint(shape, kPi * (static_cast<double>(i) / rows - 0.5), 2 * kPi * j / columns));
    }
  }
  const int top = static_cast<int>(mesh.vertices_F.size());
  mesh.vertices_F.push_back(SurfacePoint(shape, kPi / 2, 0));
  for (int j = 0; j < columns; ++j) {
    const int next = (j + 1) % columns;
    mesh.triangles.push_back({0, 1 + next, 1 + j});
    for (int begin = 1; begin + columns < top; begin += columns) {
      const int above = begin + columns;
      mesh.triangles.push_back({begin + j, begin + next, above + next});
      mesh.triangles.push_back({begin + j, above + next, above + j});
    }
    mesh.triangles.push_back({top - columns + j, top - columns + next, top});
  }
  return mesh;
}

void Append(const TriangleMesh& more, TriangleMesh& mesh) {
  const int first = static_cast<int>(mesh.vertices_F.size());
  mesh.vertices_F.insert(mesh.vertices_F.end(), more.vertices_F.begin(), more.vertices_F.end());
  for (const auto& [a, b, c] : more.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
}

std::string MeshToPly(const TriangleMesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " +
                     std::to_string(mesh.vertices_F.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                     std::to_string(mesh.triangles.size()) +
                     "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& p : mesh.vertices_F) {
    for (int i = 0; i < 3; ++i) {
      AppendNumber(p[i], text);
      text += i < 2 ? ' ' : '\n';
    }
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += "3 " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  }
  return text;
}

}  // namespace beckon::pose
