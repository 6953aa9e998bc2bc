// Little ray-cast objects for the categoriser's tests: a box, a can and a bowl on a table, with
// noise.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "services/perception/object_view.h"

namespace beckon::perception {

struct ShapeView {
  RgbdImage image;
  std::vector<uint32_t> pixels;
  Plane table_C;
  ObjectView view() const { return {image, pixels, table_C}; }
};

/// Signed distance in the table's frame: z up, the object standing at the origin.
using Shape = std::function<double(const Eigen::Vector3d&)>;

inline Shape BoxShape(double width, double depth, double height, double turn) {
  return [=](const Eigen::Vector3d& p) {
    const Eigen::Vector3d q(std::cos(turn) * p.x() + std::sin(turn) * p.y(),
                            -std::sin(turn) * p.x() + std::cos(turn) * p.y(), p.z() - height / 2);
    const Eigen::Vector3d d = q.cwiseAbs() - Eigen::Vector3d(width, depth, height) / 2;
    return d.cwiseMax(0).norm() + std::min(d.maxCoeff(), 0.0);
  };
}

inline Shape CanShape(double radius, double height) {
  return [=](const Eigen::Vector3d& p) {
    return std::max(p.head<2>().norm() - radius, std::abs(p.z() - height / 2) - height / 2);
  };
}

/// The lower half of a shell.
inline Shape BowlShape(double radius) {
  return [=](const Eigen::Vector3d& p) {
    const double shell = std::abs((p - Eigen::Vector3d(0, 0, radius)).norm() - radius) - 0.003;
    return std::max(shell, p.z() - radius);
  };
}

/// Seen by a camera pitched 38 degrees down, 0.8 m away; depth noise of 1 mm.
inline ShapeView RenderShape(const Shape& shape, std::mt19937& random) {
  constexpr int kWidth = 200, kHeight = 200;
  ShapeView out;
  out.image.width = kWidth, out.image.height = kHeight;
  out.image.intrinsics = {525, 525, 99.5, 99.5};
  const double pitch = 38.0 / 180 * 3.14159265358979;
  Eigen::Matrix3d R_CT;  // columns: right, away, up, in C
  R_CT << 1, 0, 0, 0, std::sin(pitch), -std::cos(pitch), 0, std::cos(pitch), std::sin(pitch);
  R_CT.col(2) = Eigen::Vector3d(0, -std::cos(pitch), -std::sin(pitch));
  R_CT.col(1) = Eigen::Vector3d(0, -std::sin(pitch), std::cos(pitch));
  const Eigen::Vector3d object_C(0, 0.03, 0.8);
  out.table_C = {R_CT.col(2), -R_CT.col(2).dot(object_C)};
  const auto noise = [&random] {  // about normal, the same with every library
    double sum = -2;
    for (int i = 0; i < 4; ++i) sum += static_cast<double>(random()) / 4294967296.0;
    return sum * 0.0017;
  };
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const Eigen::Vector3d ray = out.image.intrinsics.Unproject(u, v, 1).normalized();
      double along = 0.5, left = 1;
      for (int step = 0; step < 60 && along < 1.2; ++step) {
        left = shape(R_CT.transpose() * (ray * along - object_C));
        if (left < 1e-4) break;
        along += left;
      }
      const bool hit = left < 1e-3;
      if (hit) out.pixels.push_back(static_cast<uint32_t>(out.image.depth_m.size()));
      out.image.depth_m.push_back(hit ? static_cast<float>(along * ray.z() + noise()) : 0);
      const auto grey = static_cast<uint8_t>(hit ? 90 + random() % 60 : 20);
      out.image.colour.push_back({grey, grey, static_cast<uint8_t>(grey / 2)});
    }
  }
  return out;
}

/// Any object of the category "Bowl", "Box" or "Can".
inline ShapeView RenderCategory(const std::string& category, std::mt19937& random) {
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  if (category == "Bowl") return RenderShape(BowlShape(between(0.05, 0.07)), random);
  if (category == "Can") {
    const double radius = between(0.03, 0.04);
    return RenderShape(CanShape(radius, between(0.09, 0.13)), random);
  }
  const double width = between(0.06, 0.14), depth = between(0.04, 0.08);
  const double height = between(0.06, 0.14);
  return RenderShape(BoxShape(width, depth, height, between(0, 1.5)), random);
}

}  // namespace beckon::perception
