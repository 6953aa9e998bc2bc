// RANSAC over flat blocks.
#include "services/perception/table_planes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "services/perception/table_outline.h"

namespace beckon::perception {
namespace {

constexpr int kBlock = 6;           // cells along a block's edge
constexpr float kFewestCells = 20;  // with depth, of a block
constexpr int kHypotheses = 250;
constexpr size_t kCounted = 400;    // about so many blocks judge a hypothesis
constexpr float kFlat = 3;          // standard deviations that a flat block's cells may be off
constexpr float kParallel = 0.96f;  // cosine between normals on one plane (16 degrees)
constexpr double kHigherShare = 0.05;

/// A block whose cells lie on a plane: w = slope · (x, y, 1) with (x, y, 1) the ray.
struct Block {
  float x, y, w;                   // its centre
  float left, top, right, bottom;  // in ray coordinates
  Eigen::Vector3f normal;          // towards the camera
  float noise_m;                   // twice the standard deviation of the depth
};

/// A plane as n·p + d = 0 with the normal towards the camera, d > 0.
struct Hypothesis {
  Eigen::Vector3f normal;
  float offset_m;
  float Height(const Block& b) const {
    return (normal.x() * b.x + normal.y() * b.y + normal.z()) / b.w + offset_m;
  }
};

/// Running sums of a least-squares fit of w = slope · (x, y, 1).
struct RayFit {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();

  void Add(double x, double y, double w, double weight = 1) {
    const Eigen::Vector3d ray(x, y, 1);
    squares.noalias() += weight * ray * ray.transpose();
    products += weight * w * ray;
  }
  std::optional<Hypothesis> Solve() const {
    const Eigen::LDLT<Eigen::Matrix3d> solver(squares);
    const Eigen::Vector3d slope = solver.solve(products);
    const double norm = slope.norm();
    if (!(norm > 1e-6) || !std::isfinite(norm)) return std::nullopt;
    return Hypothesis{(-slope / norm).cast<float>(), static_cast<float>(1 / norm)};
  }
};

/// Sums over the cells of a block that have depth; u and v count from its middle.
struct BlockSums {
  float n = 0, u = 0, v = 0, w = 0, uu = 0, uv = 0, vv = 0, uw = 0, vw = 0, ww = 0;
};

BlockSums SumBlock(const DepthGrid& grid, int left, int top) {
  BlockSums s;
  for (int y = 0; y < kBlock; ++y) {
    const float* row = &grid.inverse_depth[grid.Index(left, top + y)];
    const float v = static_cast<float>(y) - (kBlock - 1) / 2.0f;
    for (int x = 0; x < kBlock; ++x) {
      const float w = row[x], one = w > 0 ? 1.0f : 0.0f;
      const float u = static_cast<float>(x) - (kBlock - 1) / 2.0f;
      s.n += one, s.w += w, s.u += one * u, s.v += one * v;
      s.uu += one * u * u, s.uv += one * u * v, s.vv += one * v * v;
      s.uw += u * w, s.vw += v * w, s.ww += w * w;
    }
  }
  return s;
}

std::optional<Block> FitBlock(const DepthGrid& grid, int left, int top,
                              const InverseDepthNoise& noise) {
  const BlockSums s = SumBlock(grid, left, top);
  if (s.n < kFewestCells) return std::nullopt;
  const float u = s.u / s.n, v = s.v / s.n, w = s.w / s.n;
  const float uu = s.uu / s.n - u * u, uv = s.uv / s.n - u * v, vv = s.vv / s.n - v * v;
  const float uw = s.uw / s.n - u * w, vw = s.vw / s.n - v * w;
  const float det = uu * vv - uv * uv;
  if (det < 1) return std::nullopt;  // all on a line
  const float a = (uw * vv - vw * uv) / det, b = (vw * uu - uw * uv) / det;
  const float limit = kFlat * noise(w);
  float residual = 0;
  for (int y = 0; y < kBlock; ++y) {
    const float* row = &grid.inverse_depth[grid.Index(left, top + y)];
    const float from_v = static_cast<float>(y) - (kBlock - 1) / 2.0f - v;
    for (int x = 0; x < kBlock; ++x) {
      const float from_u = static_cast<float>(x) - (kBlock - 1) / 2.0f - u;
      const float off = row[x] > 0 ? row[x] - w - a * from_u - b * from_v : 0;
      residual += off * off;
    }
  }
  if (residual > s.n * limit * limit) return std::nullopt;
  const float half = (kBlock - 1) / 2.0f;
  const Eigen::Vector3f low = grid.Ray(static_cast<float>(left), static_cast<float>(top));
  const Eigen::Vector3f centre =
      grid.Ray(static_cast<float>(left) + half + u, static_cast<float>(top) + half + v);
  const Eigen::Vector3f slope(a * grid.fx, b * grid.fy,
                              w - a * grid.fx * centre.x() - b * grid.fy * centre.y());
  return Block{centre.x(),
               centre.y(),
               w,
               low.x(),
               low.y(),
               low.x() + (kBlock - 1) / grid.fx,
               low.y() + (kBlock - 1) / grid.fy,
               -slope.normalized(),
               2 * noise(w) / (w * w)};
}

std::vector<Block> FlatBlocks(const DepthGrid& grid, const InverseDepthNoise& noise) {
  std::vector<Block> blocks;
  for (int v = 0; v + kBlock <= grid.height; v += kBlock) {
    for (int u = 0; u + kBlock <= grid.width; u += kBlock) {
      if (auto block = FitBlock(grid, u, v, noise)) blocks.push_back(*block);
    }
  }
  return blocks;
}

/// Which planes are sought.
struct PlaneQuery {
  Eigen::Vector3f towards{0, -1, 0};  // the normal leans from here
  float least_cosine = -1;            // no more than this
};

class PlaneSearch {
 public:
  PlaneSearch(const std::vector<Block>& blocks, const SegmentationConfig& config)
      : blocks_(blocks), distance_m_(static_cast<float>(config.plane_distance_m)) {}

  bool On(const Hypothesis& plane, const Block& b) const {
    const float limit_m = std::max(distance_m_, b.noise_m * std::abs(plane.normal.z()));
    return std::abs(plane.Height(b)) < limit_m && plane.normal.dot(b.normal) > kParallel;
  }

  /// The best plane among some blocks; refined.
  std::optional<Hypothesis> Find(const std::vector<int>& among, const PlaneQuery& query) const {
    std::vector<int> candidates;
    for (int i : among) {
      if (blocks_[i].normal.dot(query.towards) > query.least_cosine - 0.15f)
        candidates.push_back(i);
    }
    if (candidates.size() < 3) return std::nullopt;
    const size_t stride = 1 + candidates.size() / kCounted;
    std::mt19937 engine(1);
    auto draw = [&] { return candidates[engine() % candidates.size()]; };
    std::optional<Hypothesis> best;
    int most = 2;
    for (int h = 0; h < kHypotheses; ++h) {
      const auto plane = Through(draw(), draw(), draw());
      if (!plane || plane->normal.dot(query.towards) < query.least_cosine) continue;
      const int n = Count(*plane, candidates, stride);
      if (n > most) most = n, best = plane;
    }
    if (!best) return best;
    for (int i = 0; i < 3; ++i) best = Refined(*best, candidates);
    return best->normal.dot(query.towards) < query.least_cosine ? std::nullopt : best;
  }

 private:
  std::optional<Hypothesis> Through(int i, int j, int k) const {
    const Block *a = &blocks_[i], *b = &blocks_[j], *c = &blocks_[k];
    if (a->normal.dot(b->normal) < 0.9f || a->normal.dot(c->normal) < 0.9f) return std::nullopt;
    RayFit fit;
    for (const Block* block : {a, b, c}) fit.Add(block->x, block->y, block->w);
    auto plane = fit.Solve();
    if (!plane || !On(*plane, *a) || !On(*plane, *b) || !On(*plane, *c)) return std::nullopt;
    return plane;
  }

  int Count(const Hypothesis& plane, const std::vector<int>& among, size_t stride) const {
    int n = 0;
    for (size_t k = 0; k < among.size(); k += stride) n += On(plane, blocks_[among[k]]);
    return n;
  }

  Hypothesis Refined(const Hypothesis& plane, const std::vector<int>& among) const {
    RayFit fit;
    for (int i : among) {
      const Block& b = blocks_[i];
      if (On(plane, b)) fit.Add(b.x, b.y, b.w);
    }
    return fit.Solve().value_or(plane);
  }

  const std::vector<Block>& blocks_;
  float distance_m_;
};

/// A plane more than max_height_m above `floor`, parallel to it and large enough: the table over
/// it.
std::optional<Hypothesis> FindHigher(const PlaneSearch& search, const Hypothesis& floor,
                                     const std::vector<Block>& blocks,
                                     const SegmentationConfig& config) {
  std::vector<int> high;
  for (size_t i = 0; i < blocks.size(); ++i) {
    if (floor.Height(blocks[i]) > config.max_height_m) high.push_back(static_cast<int>(i));
  }
  const auto plane = search.Find(high, {floor.normal, 0.985f});
  if (!plane) return plane;
  int n = 0;
  for (int i : high) n += search.On(*plane, blocks[i]);
  return n >= kHigherShare * static_cast<double>(blocks.size()) ? plane : std::nullopt;
}

std::vector<Eigen::Vector2d> Outline(const PlaneSearch& search, const Hypothesis& table,
                                     const Plane& table_C, const std::vector<Block>& blocks,
                                     double gap_m, int& n_blocks) {
  const PlaneAxes axes(table_C);
  std::vector<Eigen::Vector2d> corners;  // two of each block are enough
  for (const Block& b : blocks) {
    if (!search.On(table, b)) continue;
    ++n_blocks;
    for (const auto& [x, y] : {std::pair(b.left, b.top), std::pair(b.right, b.bottom)}) {
      const Eigen::Vector3d ray(x, y, 1);
      const double depth_m = -table_C.offset_m / table_C.normal.dot(ray);
      if (depth_m > 0 && depth_m < 2 / b.w) corners.push_back(axes(ray * depth_m));
    }
  }
  return ConvexHull(LargestPiece(corners, gap_m));
}

double TiltDeg(const Eigen::Vector3f& normal) {
  return std::acos(std::clamp(-normal.y(), -1.0f, 1.0f)) * 180 / std::numbers::pi;
}

std::string WhyNone(const PlaneSearch& search, const std::vector<Block>& blocks,
                    const std::vector<int>& all, const SegmentationConfig& config, int least) {
  std::ostringstream text;
  const auto any = search.Find(all, {});
  int n = 0;
  if (any) {
    for (int i : all) n += search.On(*any, blocks[i]);
  }
  if (n < least) {
    text << "no plane with at least " << config.plane_min_points << " pixels";
  } else {
    text << "the largest plane can be no table: it is tilted " << std::lround(TiltDeg(any->normal))
         << " degrees from up in the image, at most " << config.table_max_tilt_deg
         << " are allowed";
  }
  return text.str();
}

}  // namespace

TablePlane FindTablePlane(const DepthGrid& grid, const SegmentationConfig& config) {
  TablePlane result;
  const std::vector<Block> blocks = FlatBlocks(grid, InverseDepthNoise(config.sensor));
  const PlaneSearch search(blocks, config);
  std::vector<int> all(blocks.size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  const int block_px = kBlock * grid.pixels;
  const int least = std::max(3, config.plane_min_points / (block_px * block_px));

  const double tilt = config.table_max_tilt_deg * std::numbers::pi / 180;
  auto table = search.Find(all, {{0, -1, 0}, static_cast<float>(std::cos(tilt))});
  if (table) {
    if (auto higher = FindHigher(search, *table, blocks, config)) table = higher;
    const Plane table_C{table->normal.cast<double>().normalized(), table->offset_m};
    int n_blocks = 0;
    result.outline = Outline(search, *table, table_C, blocks, config.table_gap_m, n_blocks);
    result.n_pixels = n_blocks * block_px * block_px;
    if (n_blocks >= least && result.outline.size() >= 3) {
      result.table_C = table_C;
      return result;
    }
  }
  result.outline.clear();
  result.reason = WhyNone(search, blocks, all, config, least);
  return result;
}

}  // namespace beckon::perception
