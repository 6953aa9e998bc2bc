// Fitting a body of revolution to what is seen of an object.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "services/perception/cue_shape_measures.h"

namespace beckon::perception {
namespace {

/// The point nearest to all horizontal lines along the side's normals. The pull towards a point
/// behind the visible middle decides where the normals do not (a box's face).
void FitAxis(const CueView& view, Revolution& body) {
  std::vector<float> x;
  for (int i = 0; i < view.size(); ++i) x.push_back(view.points_T(0, i));
  const float width = Quantile(x, 0.98F) - Quantile(x, 0.02F);
  const Eigen::Vector2f expected(0.5F * (Quantile(x, 0.98F) + Quantile(x, 0.02F)), 0.2F * width);

  Eigen::Matrix2f a = Eigen::Matrix2f::Zero();
  Eigen::Vector2f b = Eigen::Vector2f::Zero();
  int count = 0;
  for (int i = 0; i < view.size(); ++i) {
    const Eigen::Vector2f n = view.normals_T.col(i).head<2>();
    if (n.norm() < 0.6F) continue;
    const Eigen::Matrix2f across =
        Eigen::Matrix2f::Identity() - n * n.transpose() / n.squaredNorm();
    a += across;
    b += across * view.points_T.col(i).head<2>();
    ++count;
  }
  const float pull = 0.03F * static_cast<float>(count) + 1;
  a += pull * Eigen::Matrix2f::Identity();
  b += pull * expected;
  body.axis_T = a.inverse() * b;

  float squares = 0;
  for (int i = 0; i < view.size(); ++i) {
    const Eigen::Vector2f n = view.normals_T.col(i).head<2>();
    if (n.norm() < 0.6F) continue;
    const Eigen::Vector2f d = view.points_T.col(i).head<2>() - body.axis_T;
    const float miss = (d.x() * n.y() - d.y() * n.x()) / n.norm();
    squares += miss * miss;
  }
  body.axis_residual_m = count > 0 ? std::sqrt(squares / static_cast<float>(count)) : 0;
}

void FillEmptyBins(Revolution& body) {
  for (int bin = 0; bin < Revolution::kBins; ++bin) {
    if (body.share[bin] > 0) continue;
    int below = bin, above = bin;
    while (below >= 0 && body.share[below] == 0) --below;
    while (above < Revolution::kBins && body.share[above] == 0) ++above;
    if (below < 0 && above >= Revolution::kBins) return;
    if (below < 0) {
      body.profile_m[bin] = body.profile_m[above];
    } else if (above >= Revolution::kBins) {
      body.profile_m[bin] = body.profile_m[below];
    } else {
      const float t = static_cast<float>(bin - below) / static_cast<float>(above - below);
      body.profile_m[bin] = (1 - t) * body.profile_m[below] + t * body.profile_m[above];
    }
  }
}

}  // namespace

float Quantile(std::vector<float> values, float quantile) {
  if (values.empty()) return 0;
  const auto at = static_cast<int64_t>(quantile * static_cast<float>(values.size() - 1) + 0.5F);
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<size_t>(at)];
}

int Revolution::Bin(float z) const {
  return std::clamp(static_cast<int>(z / std::max(1e-4F, height_m) * kBins), 0, kBins - 1);
}

Revolution FitRevolution(const CueView& view) {
  Revolution body;
  std::vector<float> z;
  for (int i = 0; i < view.size(); ++i) z.push_back(view.points_T(2, i));
  body.height_m = Quantile(z, 0.98F);
  FitAxis(view, body);
  std::vector<float> binned[Revolution::kBins];
  for (int i = 0; i < view.size(); ++i) {
    const float radius = (view.points_T.col(i).head<2>() - body.axis_T).norm();
    body.radii_m.push_back(radius);
    binned[body.Bin(view.points_T(2, i))].push_back(radius);
  }
  for (int bin = 0; bin < Revolution::kBins; ++bin) {
    body.share[bin] = static_cast<float>(binned[bin].size()) / static_cast<float>(view.size());
    body.spread_m[bin] = Quantile(binned[bin], 0.75F) - Quantile(binned[bin], 0.25F);
    body.profile_m[bin] = Quantile(std::move(binned[bin]), 0.6F);
  }
  FillEmptyBins(body);
  body.max_radius_m = *std::max_element(body.profile_m, body.profile_m + Revolution::kBins);
  return body;
}

}  // namespace beckon::perception
