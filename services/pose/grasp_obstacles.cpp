// What a gripper must not touch: a scene's other objects as points, those seen and those of their
// hidden sides.
#include "services/pose/grasp_obstacles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "services/pose/surface.h"

namespace beckon::pose {
namespace {

constexpr double kFinestVoxel_m = 0.001;
constexpr int kFewestSamples = 64, kMostSamples = 768;
constexpr float kFarthest_m = 1000;  // points beyond are not of this table

// The first point of every voxel, in their order.
std::vector<Eigen::Vector3f> Thin(std::span<const Eigen::Vector3f> points, float voxel_m) {
  std::vector<Eigen::Vector3f> kept;
  std::vector<uint64_t> seen(std::bit_ceil(2 * points.size() + 16), 0);  // open addressing; 0: free
  const uint64_t mask = seen.size() - 1;
  const float per_m = 1 / voxel_m;
  const auto cell = [&](float v) {
    return static_cast<uint64_t>(static_cast<int64_t>(std::floor(v * per_m)) + (1 << 20)) &
           0x1fffff;
  };
  for (const Eigen::Vector3f& p : points) {
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kFarthest_m) continue;
    const uint64_t key = 1 + (cell(p.x()) | cell(p.y()) << 21 | cell(p.z()) << 42);
    uint64_t slot = (key * 0x9e3779b97f4a7c15u) >> 20 & mask;
    while (seen[slot] != 0 && seen[slot] != key) slot = (slot + 1) & mask;
    if (seen[slot] == key) continue;
    seen[slot] = key;
    kept.push_back(p);
  }
  return kept;
}

// About the area of the shape's surface: that of its box.
double BoxArea(const Eigen::Vector3d& a) {
  return 8 * (a.x() * a.y() + a.y() * a.z() + a.z() * a.x());
}

using Block = Eigen::Array<float, Obstacle::kBlock, 1>;

// The hand in single precision and in the frame of the points.
struct Hand {
  Eigen::Matrix3f R_GF;
  Eigen::Vector3f tips_F;
  struct Box {
    float half_x, half_y, middle_z, half_z;
  } box[2];
};

Hand PlaceHand(const std::array<HandBox, 2>& hand, const Pose& X_FG) {
  Hand placed{X_FG.linear().transpose().cast<float>(), X_FG.translation().cast<float>(), {}};
  for (size_t i = 0; i < hand.size(); ++i) {
    placed.box[i] = {static_cast<float>(hand[i].half_x_m), static_cast<float>(hand[i].half_y_m),
                     static_cast<float>(0.5 * (hand[i].z_min_m + hand[i].z_max_m)),
                     static_cast<float>(0.5 * (hand[i].z_max_m - hand[i].z_min_m))};
  }
  return placed;
}

// Distances of a block of points from the nearer box, along the axes of G.
Block DistanceOf(const Hand& hand, const Obstacle& obstacle, Eigen::Index first) {
  const auto column = [&](int axis) -> Block {
    return obstacle.points_F.col(axis).segment<Obstacle::kBlock>(first) - hand.tips_F[axis];
  };
  const Block dx = column(0), dy = column(1), dz = column(2);
  const auto along = [&](int axis) -> Block {
    return hand.R_GF(axis, 0) * dx + hand.R_GF(axis, 1) * dy + hand.R_GF(axis, 2) * dz;
  };
  const Block x = along(0).abs(), y = along(1).abs(), z = along(2);
  const auto from = [&](const Hand::Box& box) -> Block {
    return (x - box.half_x).max(y - box.half_y).max((z - box.middle_z).abs() - box.half_z);
  };
  return from(hand.box[0]).min(from(hand.box[1]));
}

// The same of a whole sphere, at least.
float DistanceOfSphere(const Hand& hand, const Obstacle& obstacle) {
  const Eigen::Vector3f c = hand.R_GF * (obstacle.centre_F - hand.tips_F);
  float nearest = std::numeric_limits<float>::max();
  for (const Hand::Box& box : hand.box) {
    nearest =
        std::min(nearest, std::max({std::abs(c.x()) - box.half_x, std::abs(c.y()) - box.half_y,
                                    std::abs(c.z() - box.middle_z) - box.half_z}));
  }
  return nearest - obstacle.radius_m;
}

}  // namespace

Obstacle MakeObstacle(std::span<const Eigen::Vector3f> points_F, const FitResult& fit,
                      double clearance_m) {
  const double voxel_m = std::max(clearance_m / std::sqrt(3.0), kFinestVoxel_m);
  std::vector<Eigen::Vector3f> kept = Thin(points_F, static_cast<float>(voxel_m));
  if (fit.converged) {
    const double spacing_m = std::max(clearance_m, 2 * kFinestVoxel_m);
    const double wanted = BoxArea(fit.shape.semi_axes) / (spacing_m * spacing_m);
    const int count = static_cast<int>(std::clamp<double>(wanted, kFewestSamples, kMostSamples));
    for (const auto& p : SampleSurface(fit.shape, count)) kept.push_back(p.cast<float>());
  }
  Obstacle obstacle;
  if (kept.empty()) return obstacle;
  Eigen::Vector3f low = kept.front(), high = kept.front();
  for (const auto& p : kept) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  obstacle.centre_F = 0.5f * (low + high);
  while (kept.size() % Obstacle::kBlock != 0) kept.push_back(kept.back());
  obstacle.points_F.resize(static_cast<Eigen::Index>(kept.size()), 3);
  for (size_t i = 0; i < kept.size(); ++i) {
    obstacle.points_F.row(static_cast<Eigen::Index>(i)) = kept[i].transpose().array();
    obstacle.radius_m = std::max(obstacle.radius_m, (kept[i] - obstacle.centre_F).norm());
  }
  return obstacle;
}

double DistanceToObstacles(const Obstacles& obstacles, const std::array<HandBox, 2>& hand,
                           const Pose& X_FG, double too_near_m, double enough_m) {
  const Hand placed = PlaceHand(hand, X_FG);
  const float too_near = static_cast<float>(too_near_m);
  float nearest = static_cast<float>(enough_m);
  for (size_t i = 0; i < obstacles.scene.size(); ++i) {
    const Obstacle& obstacle = obstacles.scene[i];
    if (i == obstacles.except || DistanceOfSphere(placed, obstacle) >= nearest) continue;
    for (Eigen::Index first = 0; first < obstacle.points_F.rows(); first += Obstacle::kBlock) {
      nearest = std::min(nearest, DistanceOf(placed, obstacle, first).minCoeff());
      if (nearest < too_near) return nearest;
    }
  }
  return nearest;
}

}  // namespace beckon::pose
