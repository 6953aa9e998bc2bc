// The axis about which a surface turns: for every point of a body of revolution the normal's line
// meets the axis (Pottmann and Randrup 1998 find it from this; here the few likely directions are
// tried).
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "services/perception/cue_own_frame.h"
#include "services/perception/cue_shape_measures.h"

namespace beckon::perception {
namespace {

constexpr int kBins = 10;

/// An axis and how well the surface turns about it.
struct Axis {
  Eigen::Vector3f direction = Eigen::Vector3f::UnitZ();
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  float residual_m = 1e3F;  // RMS by which the normals' lines miss it
  float radius_m = 0;       // 90 % of the points lie nearer
  float cost = 1e3F;
};

/// Two unit vectors across a direction.
Eigen::Matrix<float, 3, 2> Across(const Eigen::Vector3f& direction) {
  Eigen::Matrix<float, 3, 2> out;
  out.col(0) = direction.unitOrthogonal();
  out.col(1) = direction.cross(out.col(0));
  return out;
}

/// The axis of that direction that the normals' lines miss least; a pull to behind the visible
/// middle decides where they do not.
Axis FitAlong(const CueView& view, const Eigen::Vector3f& direction, float size_m) {
  const Eigen::Matrix<float, 3, 2> across = Across(direction);
  const Eigen::Vector3f mean_T = view.points_T.rowwise().mean();
  const Eigen::Vector3f camera_T = -view.R_TC * view.origin_C;
  const Eigen::Vector3f behind_T = mean_T - 0.1F * size_m * (camera_T - mean_T).normalized();
  Eigen::Matrix2f a = Eigen::Matrix2f::Zero();
  Eigen::Vector2f b = Eigen::Vector2f::Zero();
  int sides = 0;
  for (int i = 0; i < view.size(); ++i) {
    const Eigen::Vector2f n = across.transpose() * view.normals_T.col(i);
    if (n.squaredNorm() < 0.36F) continue;
    const Eigen::Matrix2f miss = Eigen::Matrix2f::Identity() - n * n.transpose() / n.squaredNorm();
    a += miss;
    b += miss * (across.transpose() * view.points_T.col(i));
    ++sides;
  }
  const float pull = 0.03F * static_cast<float>(sides) + 1;
  a += pull * Eigen::Matrix2f::Identity();
  b += pull * (across.transpose() * behind_T);
  const Eigen::Vector2f at = a.inverse() * b;

  Axis axis;
  axis.direction = direction;
  axis.point = across * at;
  float squares = 0;
  std::vector<float> radii;
  for (int i = 0; i < view.size(); ++i) {
    const Eigen::Vector2f d = across.transpose() * view.points_T.col(i) - at;
    radii.push_back(d.norm());
    const Eigen::Vector2f n = across.transpose() * view.normals_T.col(i);
    if (n.squaredNorm() < 0.36F) continue;
    const float miss = (d.x() * n.y() - d.y() * n.x()) / n.norm();
    squares += miss * miss;
  }
  axis.residual_m = std::sqrt(squares / static_cast<float>(std::max(1, sides)));
  axis.radius_m = Quantile(std::move(radii), 0.9F);
  // A direction that most of the surface faces explains nothing.
  const float share = static_cast<float>(sides) / static_cast<float>(view.size());
  axis.cost = (axis.residual_m + 0.002F) / (axis.radius_m + 0.01F) + 0.15F * (1 - share);
  return axis;
}

Axis FindAxis(const CueView& view) {
  const Eigen::Matrix3Xf centred = view.points_T.colwise() - view.points_T.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> spread(centred * centred.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> facing(view.normals_T *
                                                              view.normals_T.transpose());
  const float size_m = std::sqrt(12 * std::max(0.0F, spread.eigenvalues()[2]) /
                                 static_cast<float>(std::max(1, view.size())));
  Axis best;
  for (const Eigen::Vector3f& direction :
       {Eigen::Vector3f(Eigen::Vector3f::UnitZ()), Eigen::Vector3f(spread.eigenvectors().col(2)),
        Eigen::Vector3f(facing.eigenvectors().col(0))}) {
    const Axis axis = FitAlong(view, direction, size_m);
    if (axis.cost < best.cost) best = axis;
  }
  return best;
}

/// Where each point lies along and away from the axis.
struct Turned {
  std::vector<float> along_m, radii_m, facing;  // facing: normal along the axis
  float low_m = 0, length_m = 0;

  int Bin(size_t i) const {
    return std::clamp(static_cast<int>((along_m[i] - low_m) / std::max(1e-4F, length_m) * kBins), 0,
                      kBins - 1);
  }
};

Turned Turn(const CueView& view, const Axis& axis) {
  Turned out;
  for (int i = 0; i < view.size(); ++i) {
    const Eigen::Vector3f d = view.points_T.col(i) - axis.point;
    const float along = axis.direction.dot(d);
    out.along_m.push_back(along);
    out.radii_m.push_back((d - along * axis.direction).norm());
    out.facing.push_back(axis.direction.dot(view.normals_T.col(i)));
  }
  out.low_m = Quantile(out.along_m, 0.01F);
  out.length_m = Quantile(out.along_m, 0.99F) - out.low_m;
  return out;
}

}  // namespace

void MeasureOwnAxis(const CueView& view, std::vector<float>& out) {
  const Axis axis = FindAxis(view);
  const Turned turned = Turn(view, axis);
  std::vector<float> binned[kBins];
  float low_end = 0, high_end = 0;
  for (size_t i = 0; i < turned.radii_m.size(); ++i) {
    const int bin = turned.Bin(i);
    binned[bin].push_back(turned.radii_m[i]);
    if (turned.facing[i] < -0.85F) ++low_end;
    if (turned.facing[i] > 0.85F) ++high_end;
  }
  float profile[kBins], spread[kBins], widest = 1e-3F;
  for (int bin = 0; bin < kBins; ++bin) {
    spread[bin] = Quantile(binned[bin], 0.8F) - Quantile(binned[bin], 0.2F);
    const bool empty = binned[bin].size() < 3;
    profile[bin] = empty && bin > 0 ? profile[bin - 1] : Quantile(binned[bin], 0.7F);
    widest = std::max(widest, profile[bin]);
  }
  // The wider half first: which end of an axis is which is not known.
  float low_half = 0, high_half = 0;
  for (int bin = 0; bin < kBins / 2; ++bin) {
    low_half += profile[bin], high_half += profile[kBins - 1 - bin];
  }
  if (high_half > low_half) {
    std::reverse(profile, profile + kBins);
    std::reverse(spread, spread + kBins);
    std::swap(low_end, high_end);
  }
  for (int bin = 0; bin < kBins; ++bin) out.push_back(profile[bin] / widest);
  for (int bin = 0; bin < kBins; ++bin) out.push_back(spread[bin] / widest);
  for (int bin = 1; bin < kBins; ++bin) out.push_back((profile[bin] - profile[bin - 1]) / widest);
  const auto n = static_cast<float>(view.size());
  out.insert(out.end(),
             {std::abs(axis.direction.z()), turned.length_m, widest, turned.length_m / widest,
              axis.residual_m, axis.residual_m / widest, low_end / n, high_end / n});
}

}  // namespace beckon::perception
