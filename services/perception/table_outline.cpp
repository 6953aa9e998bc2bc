// Convex hull and connected pieces on a plane.
#include "services/perception/table_outline.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

namespace beckon::perception {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

PlaneAxes::PlaneAxes(const Plane& plane) {
  const Eigen::Vector3d& n = plane.normal;
  const Eigen::Vector3d away =
      std::abs(n.x()) < 0.8 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  x = (away - n * n.dot(away)).normalized();
  y = n.cross(x);
}

std::vector<Eigen::Vector2d> ConvexHull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull;
  auto chain = [&hull](auto first, auto last) {
    const size_t base = hull.size();
    for (; first != last; ++first) {
      while (hull.size() >= base + 2 && Cross(hull[hull.size() - 2], hull.back(), *first) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*first);
    }
    hull.pop_back();  // the other chain starts with it
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

bool Contains(std::span<const Eigen::Vector2d> hull, const Eigen::Vector2d& p) {
  for (size_t i = 0; i < hull.size(); ++i) {
    if (Cross(hull[i], hull[(i + 1) % hull.size()], p) < 0) return false;
  }
  return hull.size() >= 3;
}

double DepthInside(std::span<const Eigen::Vector2d> hull, const Eigen::Vector2d& p) {
  double depth = std::numeric_limits<double>::max();
  for (size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d& next = hull[(i + 1) % hull.size()];
    depth = std::min(depth, Cross(hull[i], next, p) / (next - hull[i]).norm());
  }
  return depth;
}

std::vector<Eigen::Vector2d> LargestPiece(std::span<const Eigen::Vector2d> points, double gap) {
  struct Cell {
    std::vector<uint32_t> points;
    bool visited = false;
  };
  const double edge = gap / 2;  // neighbours up to two cells away
  using Key = std::pair<int, int>;
  auto key = [edge](const Eigen::Vector2d& p) {
    return Key(static_cast<int>(std::floor(p.x() / edge)),
               static_cast<int>(std::floor(p.y() / edge)));
  };
  std::map<Key, Cell> cells;
  for (uint32_t i = 0; i < points.size(); ++i) cells[key(points[i])].points.push_back(i);

  std::vector<uint32_t> best;
  for (auto& [start, start_cell] : cells) {
    if (start_cell.visited) continue;
    start_cell.visited = true;
    std::vector<Key> open{start};
    std::vector<uint32_t> piece;
    while (!open.empty()) {
      const auto [x, y] = open.back();
      open.pop_back();
      const auto& members = cells.at({x, y}).points;
      piece.insert(piece.end(), members.begin(), members.end());
      for (int dx = -2; dx <= 2; ++dx) {
        for (int dy = -2; dy <= 2; ++dy) {
          auto next = cells.find({x + dx, y + dy});
          if (next == cells.end() || next->second.visited) continue;
          next->second.visited = true;
          open.push_back(next->first);
        }
      }
    }
    if (piece.size() > best.size()) best = std::move(piece);
  }
  std::vector<Eigen::Vector2d> result;
  result.reserve(best.size());
  for (uint32_t i : best) result.push_back(points[i]);
  return result;
}

}  // namespace beckon::perception
