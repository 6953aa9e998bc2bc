// Extents, widths over height and roundness of slices.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/perception/cue_shape_measures.h"

namespace beckon::perception {
namespace {

constexpr int kBins = Revolution::kBins;

float Range(const Eigen::VectorXf& values, float low, float high) {
  const std::vector<float> v(values.data(), values.data() + values.size());
  return Quantile(v, high) - Quantile(v, low);
}

float Ratio(float a, float b) { return a / std::max(1e-3F, b); }

/// Length and width of the upright rectangle of least area around the points, seen from above.
Eigen::Vector2f FootprintSides(const CueView& view) {
  constexpr int kAngles = 18;
  Eigen::Vector2f best(1e3F, 1e3F);
  for (int i = 0; i < kAngles; ++i) {
    const float angle = std::numbers::pi_v<float> / 2 * static_cast<float>(i) / kAngles;
    const Eigen::RowVector3f along(std::cos(angle), std::sin(angle), 0);
    const Eigen::RowVector3f across(-std::sin(angle), std::cos(angle), 0);
    const Eigen::Vector2f sides(Range((along * view.points_T).transpose(), 0.02F, 0.98F),
                                Range((across * view.points_T).transpose(), 0.02F, 0.98F));
    if (sides.prod() < best.prod()) best = sides;
  }
  return {best.maxCoeff(), best.minCoeff()};
}

Eigen::Vector3f PrincipalExtents(const CueView& view) {
  const Eigen::Matrix3Xf centred = view.points_T.colwise() - view.points_T.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(centred * centred.transpose());
  Eigen::Vector3f out;
  for (int axis = 0; axis < 3; ++axis) {
    out[2 - axis] =
        Range((solver.eigenvectors().col(axis).transpose() * centred).transpose(), 0.02F, 0.98F);
  }
  return out;
}

struct SliceFit {
  float circle_residual = 0;  // RMS over the slice's extent
  float line_residual = 0;
  float bend = 0;  // extent / diameter of the circle
};

/// A circle (Kasa 1976) and a line through one slice.
SliceFit FitSlice(const std::vector<Eigen::Vector2f>& points) {
  SliceFit fit;
  if (points.size() < 6) return fit;
  Eigen::Vector2f mean = Eigen::Vector2f::Zero();
  for (const auto& p : points) mean += p;
  mean /= static_cast<float>(points.size());
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  Eigen::Matrix2f scatter = Eigen::Matrix2f::Zero();
  for (const auto& p : points) {
    const Eigen::Vector2f d = 10 * (p - mean);
    scatter += d * d.transpose();
    const Eigen::Vector3d row(d.x(), d.y(), 1);
    a += row * row.transpose();
    b += row * static_cast<double>(d.squaredNorm());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> lines(scatter);
  const float count = static_cast<float>(points.size());
  const float extent = std::sqrt(12 * lines.eigenvalues()[1] / count) + 1e-3F;
  fit.line_residual = std::sqrt(std::max(0.0F, lines.eigenvalues()[0]) / count) / extent;
  const Eigen::Vector3d solution = (a + 1e-9 * Eigen::Matrix3d::Identity()).inverse() * b;
  const Eigen::Vector2f centre = 0.5F * solution.head<2>().cast<float>();
  const float radius =
      std::sqrt(std::max(1e-8F, static_cast<float>(solution[2]) + centre.squaredNorm()));
  float squares = 0;
  for (const auto& p : points) {
    const float miss = (10 * (p - mean) - centre).norm() - radius;
    squares += miss * miss;
  }
  fit.circle_residual = std::sqrt(squares / count) / extent;
  fit.bend = extent / (2 * radius);
  return fit;
}

void MeasureSlices(const CueView& view, const Revolution& body, std::vector<float>& out) {
  constexpr int kSlices = 4;
  std::vector<Eigen::Vector2f> slices[kSlices];
  for (int i = 0; i < view.size(); ++i) {
    if (std::abs(view.normals_T(2, i)) > 0.7F) continue;
    slices[body.Bin(view.points_T(2, i)) * kSlices / kBins].push_back(
        view.points_T.col(i).head<2>());
  }
  for (const auto& slice : slices) {
    const SliceFit fit = FitSlice(slice);
    out.insert(out.end(), {fit.circle_residual, fit.line_residual, fit.bend});
  }
}

}  // namespace

void MeasureSizes(const CueView& view, std::vector<float>& out) {
  const float x = Range(view.points_T.row(0).transpose(), 0.02F, 0.98F);
  const float y = Range(view.points_T.row(1).transpose(), 0.02F, 0.98F);
  const float z = Range(view.points_T.row(2).transpose(), 0.02F, 0.98F);
  const Eigen::Vector2f sides = FootprintSides(view);
  const Eigen::Vector3f principal = PrincipalExtents(view);
  const float area = static_cast<float>(view.size()) * view.voxel_m * view.voxel_m;
  out.insert(out.end(), {x, y, z, sides[0], sides[1], principal[0], principal[1], principal[2]});
  out.insert(out.end(),
             {Ratio(z, x), Ratio(z, sides[0]), Ratio(z, sides[1]), Ratio(sides[1], sides[0]),
              Ratio(y, x), Ratio(principal[1], principal[0]), Ratio(principal[2], principal[0])});
  out.insert(out.end(), {area, Ratio(area, x * z), Ratio(area, sides[0] * sides[1]),
                         view.points_T.row(2).maxCoeff()});
}

void MeasureProfile(const CueView& view, const Revolution& body, std::vector<float>& out) {
  std::vector<float> lateral[kBins];
  std::vector<float> excess;
  int outside = 0;
  for (int i = 0; i < view.size(); ++i) {
    const int bin = body.Bin(view.points_T(2, i));
    lateral[bin].push_back(view.points_T(0, i));
    const float beyond = body.radii_m[static_cast<size_t>(i)] - body.profile_m[bin];
    excess.push_back(beyond);
    if (beyond > 0.2F * body.profile_m[bin] + 0.005F) ++outside;
  }
  float widths[kBins], widest = 1e-3F;
  for (int bin = 0; bin < kBins; ++bin) {
    widths[bin] = Quantile(lateral[bin], 0.96F) - Quantile(lateral[bin], 0.04F);
    widest = std::max(widest, widths[bin]);
  }
  for (int bin = 0; bin < kBins; ++bin) {
    out.insert(out.end(), {Ratio(body.profile_m[bin], body.max_radius_m),
                           Ratio(body.spread_m[bin], body.max_radius_m), body.share[bin],
                           widths[bin] / widest});
  }
  out.insert(out.end(), {body.max_radius_m, widest, body.profile_m[0], body.profile_m[kBins - 1],
                         Ratio(body.profile_m[kBins - 1], body.profile_m[1]),
                         Ratio(widths[kBins - 1] + widths[kBins - 2], widths[0] + widths[1]),
                         Ratio(body.height_m, body.max_radius_m), body.axis_residual_m,
                         Ratio(body.axis_residual_m, body.max_radius_m)});
  out.insert(out.end(), {static_cast<float>(outside) / static_cast<float>(view.size()),
                         Quantile(excess, 0.9F), Quantile(excess, 0.97F), Quantile(excess, 0.995F),
                         Ratio(Quantile(excess, 0.97F), body.max_radius_m), Quantile(excess, 0.1F),
                         Quantile(excess, 0.02F)});
  MeasureSlices(view, body, out);
}

}  // namespace beckon::perception
