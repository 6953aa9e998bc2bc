// RANSAC over flat blocks.
#include "services/perception/table_planes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "services/perception/flat_blocks.h"
#include "services/perception/table_outline.h"

namespace beckon::perception {
namespace {

constexpr int kHypotheses = 250;
constexpr size_t kCounted = 400;    // about so many blocks judge a hypothesis
constexpr float kParallel = 0.96f;  // cosine between normals on one plane (16 degrees)
constexpr int kMostSteps = 20;      // between neighbouring blocks
constexpr double kHigherShare = 0.05;
constexpr double kUpsideDownDeg = 135;            // a table tilted more is seen upside down
constexpr float kUpsideDownCosine = 0.70710678f;  // of 180 degrees less these

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

/// How many blocks lie on `plane`.
int CountOn(const PlaneSearch& search, const Hypothesis& plane, const std::vector<Block>& blocks) {
  return static_cast<int>(std::count_if(blocks.begin(), blocks.end(),
                                        [&](const Block& b) { return search.On(plane, b); }));
}

/// Whether something is seen from below, and far larger than the table: a camera that is upside
/// down takes the side of a box for a table, and sees the table so.
bool IsUpsideDown(const PlaneSearch& search, const std::vector<int>& all,
                  const std::vector<Block>& blocks, const Hypothesis& table) {
  constexpr int kFarLarger = 4;
  const auto from_below = search.Find(all, {{0, 1, 0}, kUpsideDownCosine});
  return from_below &&
         CountOn(search, *from_below, blocks) > kFarLarger * CountOn(search, table, blocks);
}

/// Adds points between a and b where these are further apart than `step`. `b` may be of `points`.
void AddBetween(const Eigen::Vector2d& a, Eigen::Vector2d b, double step,
                std::vector<Eigen::Vector2d>& points) {
  const int n = std::min(static_cast<int>((b - a).norm() / step) + 1, kMostSteps);
  for (int i = 1; i < n; ++i) points.push_back(a + (b - a) * i / n);
}

/// Blocks on the table that are neighbours in the image belong together however far apart they are.
std::vector<Eigen::Vector2d> Outline(const PlaneSearch& search, const Hypothesis& table,
                                     const Plane& table_C, const std::vector<Block>& blocks,
                                     double gap_m, int& n_blocks) {
  const PlaneAxes axes(table_C);
  auto project = [&](float x, float y) {
    const Eigen::Vector3d ray(x, y, 1);
    return axes(ray * (-table_C.offset_m / table_C.normal.dot(ray)));
  };
  int n_columns = 0;
  for (const Block& b : blocks) n_columns = std::max(n_columns, b.column + 1);
  const size_t n_places =
      blocks.empty() ? 0 : static_cast<size_t>(blocks.back().row + 1) * n_columns;
  std::vector<int> at(n_places, -1);  // index of the upper left corner of the block there
  std::vector<Eigen::Vector2d> points;
  for (const Block& b : blocks) {
    if (!search.On(table, b)) continue;
    ++n_blocks;
    const size_t place = static_cast<size_t>(b.row) * n_columns + b.column;
    const Eigen::Vector2d corner = project(b.left, b.top), opposite = project(b.right, b.bottom);
    at[place] = static_cast<int>(points.size());
    points.push_back(corner);
    points.push_back(opposite);
    AddBetween(corner, opposite, gap_m / 2, points);
    for (const int other :
         {b.column > 0 ? at[place - 1] : -1, b.row > 0 ? at[place - n_columns] : -1}) {
      if (other >= 0) AddBetween(corner, points[other], gap_m / 2, points);
    }
  }
  return ConvexHull(LargestPiece(points, gap_m));
}

double TiltDeg(const Eigen::Vector3f& normal) {
  return std::acos(std::clamp(-normal.y(), -1.0f, 1.0f)) * 180 / std::numbers::pi;
}

constexpr double kStraightDownDeg = 90, kOffDeg = 5;

/// What a camera may be doing that sees a plane so, and what to set then.
std::string Advice(double tilt_deg) {
  if (tilt_deg > kUpsideDownDeg) return "; the camera may be upside down";
  if (std::abs(tilt_deg - kStraightDownDeg) > 2 * kOffDeg) return "";
  std::ostringstream text;
  text << "; if this is no wall but the camera looks straight down on the table, set "
       << "table_max_tilt_deg = " << kStraightDownDeg + kOffDeg;
  return text.str();
}

std::string WhyNone(const PlaneSearch& search, const std::vector<Block>& blocks,
                    const std::vector<int>& all, const SegmentationConfig& config, int least) {
  std::ostringstream text;
  const auto any = search.Find(all, {});
  if (!any || CountOn(search, *any, blocks) < least) {
    text << "no plane with at least " << config.plane_min_points << " pixels";
  } else {
    const double tilt_deg = TiltDeg(any->normal);
    text << "the largest plane can be no table: it is tilted " << std::lround(tilt_deg)
         << " degrees from up in the image, at most " << config.table_max_tilt_deg << " are allowed"
         << Advice(tilt_deg);
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
  const int block_px = kBlockCells * grid.pixels;
  const int least = std::max(3, config.plane_min_points / (block_px * block_px));

  const double tilt = config.table_max_tilt_deg * std::numbers::pi / 180;
  auto table = search.Find(all, {{0, -1, 0}, static_cast<float>(std::cos(tilt))});
  if (table && config.table_max_tilt_deg < kUpsideDownDeg &&
      IsUpsideDown(search, all, blocks, *table)) {
    table.reset();
  }
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
