// Points of a superquadric's surface: the spherical product of two superellipses.
#include "services/pose/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beckon::pose {
namespace {

constexpr double kPi = std::numbers::pi;

// Where a ray leaves the superellipse |u|^(2/e) + |v|^(2/e) = 1.
Eigen::Vector2d OnSuperellipse(const Eigen::Vector2d& ray, double e) {
  const Eigen::Vector2d size = ray.cwiseAbs();
  const double larger = size.maxCoeff(), ratio = size.minCoeff() / larger;
  return ray / (larger * std::pow(1 + std::pow(ratio, 2 / e), 0.5 * e));
}

Eigen::Vector2d OnSuperellipse(double angle, double e) {
  return OnSuperellipse(Eigen::Vector2d(std::cos(angle), std::sin(angle)), e);
}

// The point in O. `profile` is (distance from the axis, height), `section` the direction around it.
Eigen::Vector3d Product(const Superquadric& shape, const Eigen::Vector2d& profile,
                        const Eigen::Vector2d& section) {
  const Eigen::Vector2d width = (shape.taper * profile.y()).array() + 1;
  const Eigen::Vector3d unit(profile.x() * section.x() * width.x(),
                             profile.x() * section.y() * width.y(), profile.y());
  return unit.cwiseProduct(shape.semi_axes);
}

double Area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

// How a surface's area spreads over latitude and longitude: cells from the lower pole to the upper
// one, over the quarter x, y >= 0 that the other three mirror.
class AreaGrid {
 public:
  /// `rows` is a multiple of 8, so that the edges of boxes and cylinders are lines of the grid.
  AreaGrid(const Superquadric& shape, int rows) : shape_(shape), columns_(rows / 4) {
    for (int j = 0; j <= columns_; ++j) {
      section_.push_back(OnSuperellipse(0.5 * kPi * j / columns_, shape.epsilon[1]));
    }
    std::vector<Eigen::Vector3d> below, ring;
    for (int i = 0; i <= rows; ++i) {
      profile_.push_back(
          OnSuperellipse(kPi * (static_cast<double>(i) / rows - 0.5), shape.epsilon[0]));
      ring.clear();
      for (const auto& section : section_) ring.push_back(Product(shape, profile_.back(), section));
      double length = 0;
      for (size_t j = 1; j < ring.size(); ++j) length += (ring[j] - ring[j - 1]).norm();
      ring_length_.push_back(length);
      if (i > 0) AddRow(below, ring);
      below.swap(ring);
    }
  }

  /// The point in O with the share `up` of the area below it, and `around` of its row behind it.
  /// Walks up: `row` is where the search begins and then the point's row.
  Eigen::Vector3d At(double up, double around, int& row) const {
    const double area = up * row_end_.back();
    while (row + 1 < static_cast<int>(row_end_.size()) && area > row_end_[Index(row)]) ++row;
    const double begin = row == 0 ? 0 : row_end_[Index(row) - 1];
    const double height = AlongTrapezoid((area - begin) / (row_end_[Index(row)] - begin),
                                         ring_length_[Index(row)], ring_length_[Index(row) + 1]);
    const int quarter = std::min(static_cast<int>(4 * around), 3);
    const double within = 4 * around - quarter;
    Eigen::Vector2d section = Around(quarter % 2 == 0 ? within : 1 - within, row);
    if (quarter == 1 || quarter == 2) section.x() = -section.x();
    if (quarter >= 2) section.y() = -section.y();
    return Product(shape_, Between(profile_, Index(row), height, shape_.epsilon[0]), section);
  }

 private:
  static size_t Index(int i) { return static_cast<size_t>(i); }

  void AddRow(const std::vector<Eigen::Vector3d>& below, const std::vector<Eigen::Vector3d>& ring) {
    double area = 0;
    for (size_t j = 1; j < ring.size(); ++j) {
      area += Area(below[j - 1], below[j], ring[j]) + Area(below[j - 1], ring[j], ring[j - 1]);
      cell_end_.push_back(area);
    }
    row_end_.push_back(area + (row_end_.empty() ? 0 : row_end_.back()));
  }

  // The height up to which a share of a trapezoid's area lies; both of 0 .. 1.
  static double AlongTrapezoid(double share, double bottom, double top) {
    const double root = std::sqrt(bottom * bottom + share * (top * top - bottom * bottom));
    return root + bottom > 0 ? share * (bottom + top) / (bottom + root) : share;
  }

  // The superellipse's point above the chord between two of its points.
  static Eigen::Vector2d Between(const std::vector<Eigen::Vector2d>& points, size_t i, double part,
                                 double e) {
    return OnSuperellipse(points[i] + part * (points[i + 1] - points[i]), e);
  }

  // The section where the share `within` of the quarter's area of a row ends.
  Eigen::Vector2d Around(double within, int row) const {
    const auto first = cell_end_.begin() + row * columns_, last = first + columns_;
    const double area = within * *(last - 1);
    const auto cell = std::min(std::upper_bound(first, last, area), last - 1);
    const double begin = cell == first ? 0 : *(cell - 1);
    const double part = *cell > begin ? (area - begin) / (*cell - begin) : 0.5;
    return Between(section_, Index(static_cast<int>(cell - first)), part, shape_.epsilon[1]);
  }

  const Superquadric& shape_;
  int columns_;
  std::vector<Eigen::Vector2d> profile_, section_;
  std::vector<double> ring_length_;  // a quarter of the way around at each profile point
  std::vector<double> row_end_;      // area of the quarter up to the end of each row
  std::vector<double> cell_end_;     // within its row
};

}  // namespace

Eigen::Vector3d SurfacePoint(const Superquadric& shape, double latitude, double longitude) {
  return shape.X_FO * Product(shape, OnSuperellipse(latitude, shape.epsilon[0]),
                              OnSuperellipse(longitude, shape.epsilon[1]));
}

std::vector<Eigen::Vector3d> SampleSurface(const Superquadric& shape, int count) {
  constexpr int kMinRows = 16, kMaxRows = 192;
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<size_t>(std::max(count, 0)));
  // Cells about half as long as the distance between points.
  const int rows = 8 * static_cast<int>(std::lround(std::sqrt(std::max(count, 1)) / 4));
  const AreaGrid grid(shape, std::clamp(rows, kMinRows, kMaxRows));
  // The golden ratio is what fractions approximate worst: no two points of this lattice are near
  // each other however the square that it fills is stretched.
  const double golden = std::numbers::phi - 1;
  int row = 0;
  for (int i = 0; i < count; ++i) {
    const double around = golden * i;
    points.push_back(shape.X_FO * grid.At((i + 0.5) / count, around - std::floor(around), row));
  }
  return points;
}

double ShapeDifference(const Superquadric& a, const Superquadric& b) {
  constexpr int kSamples = 64;
  return 0.5 * (MeanRadialDistance(a, SampleSurface(b, kSamples)) +
                MeanRadialDistance(b, SampleSurface(a, kSamples)));
}

}  // namespace beckon::pose
