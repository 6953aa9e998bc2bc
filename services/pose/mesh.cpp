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

std::string MeshToPly(const std::vector<MeshPiece>& pieces) {
  size_t vertices = 0, triangles = 0;
  for (const MeshPiece& piece : pieces) {
    vertices += piece.mesh.vertices_F.size();
    triangles += piece.mesh.triangles.size();
  }
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                     std::to_string(triangles) +
                     "\nproperty list uchar int vertex_indices\nproperty int object\n"
                     "property int part\nend_header\n";
  for (const MeshPiece& piece : pieces) {
    for (const auto& p : piece.mesh.vertices_F) {
      for (int i = 0; i < 3; ++i) {
        AppendNumber(p[i], text);
        text += i < 2 ? ' ' : '\n';
      }
    }
  }
  size_t first = 0;  // vertex of the piece
  for (const MeshPiece& piece : pieces) {
    const std::string end =
        ' ' + std::to_string(piece.object) + ' ' + std::to_string(piece.part) + '\n';
    for (const auto& triangle : piece.mesh.triangles) {
      text += '3';
      for (int corner : triangle) text += ' ' + std::to_string(first + static_cast<size_t>(corner));
      text += end;
    }
    first += piece.mesh.vertices_F.size();
  }
  return text;
}

}  // namespace beckon::pose
