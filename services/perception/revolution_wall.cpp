// Least squares of a body of revolution.
#include "services/perception/revolution_wall.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace beckon::perception {
namespace {

constexpr size_t kFewestPatches = 5;
constexpr double kSteepest = 0.9;        // of the normal's height, for a wall
constexpr double kLeastArc = 1.0;        // rad of the circle that must be seen
constexpr double kMostOff_m = 0.0015;    // beside the noise
constexpr double kMostTurn = 0.2;        // rad
constexpr double kMostPatchTurn = 0.45;  // of a single patch
constexpr double kMinRadius_m = 0.015, kMaxRadius_m = 0.16;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A patch as seen from above.
struct WallPatch {
  Eigen::Vector2d place, outward;
  double height_m, weight, sigma_m;
};

std::vector<WallPatch> WallOf(const PatchScene& scene, const PlaneAxes& axes,
                              const std::vector<int>& members) {
  std::vector<WallPatch> wall;
  for (int i : members) {
    const Patch& patch = scene.patches.patches[i];
    const Eigen::Vector3d normal = patch.normal_C.cast<double>();
    if (std::abs(normal.dot(scene.table_C.normal)) > kSteepest) continue;
    const Eigen::Vector3d centre = patch.centre_C.cast<double>();
    const Eigen::Vector2d outward = axes(normal);
    wall.push_back({axes(centre), outward.normalized(), scene.table_C.Distance(centre),
                    static_cast<double>(patch.n_cells), scene.sensor.Sigma(centre.z())});
  }
  return wall;
}

/// The angle that the patches' directions span.
double Arc(const std::vector<WallPatch>& wall) {
  Eigen::Vector2d mean(0, 0);
  for (const auto& p : wall) mean += p.weight * p.outward;
  if (mean.norm() < 1e-9) return 0;
  mean.normalize();
  double low = 0, high = 0;
  for (const auto& p : wall) {
    const double angle =
        std::atan2(mean.x() * p.outward.y() - mean.y() * p.outward.x(), mean.dot(p.outward));
    low = std::min(low, angle), high = std::max(high, angle);
  }
  return high - low;
}

/// Least squares of a body of revolution: |p - c| = |r(h)|, r(h) = r0 + r1 h + r2 h^2.
class RevolutionFit {
 public:
  explicit RevolutionFit(const std::vector<WallPatch>& wall) : wall_(wall) {
    double weight = 0;
    for (const auto& p : wall) mean_height_ += p.weight * p.height_m, weight += p.weight;
    mean_height_ /= weight;
  }

  /// A start that is linear: p = c + r(h) n. Inside walls give negative radii.
  bool FromNormals() {
    Sums sums;
    for (const auto& p : wall_) {
      for (int axis = 0; axis < 2; ++axis) {
        Vector5 row = Profile(p.height_m) * p.outward[axis];
        row[axis] = 1;
        sums.Add(row, p.place[axis], p.weight);
      }
    }
    x_ = sums.Solve(1e-2);
    return x_.allFinite();
  }

  /// A step of Gauss-Newton on the distances; those more than twice the mean off count less.
  void Refine() {
    const double mean = MeanOff();
    const double side = Radius(mean_height_) < 0 ? -1 : 1;
    Sums sums;
    for (const auto& p : wall_) {
      const Eigen::Vector2d out = p.place - x_.head<2>();
      const double distance = out.norm(), off = Off(p);
      if (distance < 1e-6) continue;
      Vector5 row = Profile(p.height_m) * side;
      row.head<2>() = out / distance;
      const double ratio = off / (2 * mean + 1e-6);
      sums.Add(row, off, p.weight / (1 + ratio * ratio));
    }
    const Vector5 step = sums.Solve(1e-2);
    if (step.allFinite()) x_ += step;
  }

  /// Root mean square distance from the surface, of the nearer three quarters.
  double MeanOff() const {
    std::vector<double> off;
    for (const auto& p : wall_) off.push_back(std::abs(Off(p)));
    std::sort(off.begin(), off.end());
    const size_t n = std::max<size_t>(1, off.size() * 3 / 4);
    double sum = 0;
    for (size_t i = 0; i < n; ++i) sum += off[i] * off[i];
    return std::sqrt(sum / static_cast<double>(n));
  }
  /// Mean angle between the normals and the radii: large for the flat sides of a box.
  double MeanTurn() const {
    double sum = 0, weight = 0;
    for (const auto& p : wall_) {
      const Eigen::Vector2d radial = (p.place - x_.head<2>()).normalized();
      const double cosine = std::abs(radial.dot(p.outward));
      sum += p.weight * std::acos(std::min(1.0, cosine));
      weight += p.weight;
    }
    return sum / weight;
  }
  double MeanSigma() const {
    double sum = 0;
    for (const auto& p : wall_) sum += p.sigma_m;
    return sum / static_cast<double>(wall_.size());
  }
  /// The wall with foot and rim left open; radii are positive.
  Wall Found() const {
    const double side = Radius(mean_height_) < 0 ? -1 : 1, k = 1 / 0.05, m = mean_height_;
    const double a = x_[2], b = x_[3] * k, c = x_[4] * k * k;  // about the mean height
    Wall wall;
    wall.centre = x_.head<2>();
    wall.profile = side * Eigen::Vector3d(a - b * m + c * m * m, b - 2 * c * m, c);
    wall.is_inside = side < 0;
    return wall;
  }

 private:
  double Radius(double height_m) const { return Profile(height_m).dot(x_); }

  using Vector5 = Eigen::Matrix<double, 5, 1>;

  struct Sums {
    Eigen::Matrix<double, 5, 5> squares = Eigen::Matrix<double, 5, 5>::Zero();
    Vector5 products = Vector5::Zero();
    double weight = 0;
    void Add(const Vector5& row, double value, double w) {
      squares += w * row * row.transpose();
      products += w * value * row;
      weight += w;
    }
    /// A cylinder where nothing speaks against it: the profile's slopes are damped.
    Vector5 Solve(double damping) const {
      Eigen::Matrix<double, 5, 5> damped = squares;
      damped.diagonal().tail<2>().array() += damping * weight;
      return damped.ldlt().solve(products);
    }
  };

  Vector5 Profile(double height_m) const {
    const double h = (height_m - mean_height_) / 0.05;
    return (Vector5() << 0, 0, 1, h, h * h).finished();
  }
  double Off(const WallPatch& p) const {
    return (p.place - x_.head<2>()).norm() - std::abs(Radius(p.height_m));
  }

  const std::vector<WallPatch>& wall_;
  double mean_height_ = 0;
  Vector5 x_ = Vector5::Zero();  // centre, r0, r1, r2
};

}  // namespace

std::optional<Wall> FitWall(const PatchScene& scene, const PlaneAxes& axes,
                            const std::vector<int>& members) {
  if (members.size() < kFewestPatches) return std::nullopt;
  const auto patches = WallOf(scene, axes, members);
  if (patches.size() < kFewestPatches || Arc(patches) < kLeastArc) return std::nullopt;
  RevolutionFit fit(patches);
  if (!fit.FromNormals()) return std::nullopt;
  for (int i = 0; i < 4; ++i) fit.Refine();
  if (fit.MeanOff() > kMostOff_m + fit.MeanSigma()) return std::nullopt;
  if (fit.MeanTurn() > kMostTurn) return std::nullopt;
  Wall wall = fit.Found();
  wall.foot_height_m = kInfinity;
  for (const auto& p : patches) wall.foot_height_m = std::min(wall.foot_height_m, p.height_m);
  for (int i : members) {
    const Eigen::Vector3d p = scene.patches.patches[i].centre_C.cast<double>();
    wall.rim_height_m = std::max(wall.rim_height_m, scene.table_C.Distance(p));
  }
  const double radius_m = wall.Radius(wall.rim_height_m);
  if (!(radius_m > kMinRadius_m && radius_m < kMaxRadius_m)) return std::nullopt;
  return wall;
}

bool LiesOn(const PatchScene& scene, const PlaneAxes& axes, const Wall& wall,
            const std::vector<int>& members) {
  const auto patches = WallOf(scene, axes, members);
  const auto n_on = std::ranges::count_if(patches, [&](const WallPatch& p) {
    const Eigen::Vector2d radial = p.place - wall.centre;
    const double off_m = std::abs(radial.norm() - wall.Radius(p.height_m));
    const double turn = (wall.is_inside ? -1 : 1) * radial.normalized().dot(p.outward);
    return off_m < kMostOff_m + p.sigma_m && turn > std::cos(kMostPatchTurn);
  });
  return n_on * 10 >= static_cast<std::ptrdiff_t>(patches.size()) * 8;
}

}  // namespace beckon::perception
