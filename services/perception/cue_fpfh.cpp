// FPFH over the neighbourhoods that the view has found already.
#include "services/perception/cue_fpfh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beckon::perception {
namespace {

constexpr int kBins = FpfhCue::kBins;

int Bin(float value, float low, float high) {
  const int bin = static_cast<int>((value - low) / (high - low) * kBins);
  return std::clamp(bin, 0, kBins - 1);
}

/// Adds the three angles of a pair (Rusu 2009, eq. 1-3) to a histogram.
void AddPair(const Eigen::Vector3f& p, const Eigen::Vector3f& n, const Eigen::Vector3f& q,
             const Eigen::Vector3f& m, float distance, Eigen::Ref<Eigen::RowVectorXf> histogram) {
  Eigen::Vector3f d = (q - p) / distance;
  Eigen::Vector3f u = n, other = m;
  float cosine = n.dot(d);
  const float other_cosine = m.dot(d);
  if (std::abs(cosine) <
      std::abs(other_cosine)) {  // the source is where normal and line agree more
    u = m, other = n;
    d = -d;
    cosine = -other_cosine;
  }
  Eigen::Vector3f v = d.cross(u);
  const float length = v.norm();
  if (length < 1e-6F) return;
  v /= length;
  const Eigen::Vector3f w = u.cross(v);
  const float theta = std::atan2(w.dot(other), u.dot(other));
  constexpr float kPi = std::numbers::pi_v<float>;
  histogram[Bin(theta, -kPi, kPi)] += 1;
  histogram[kBins + Bin(v.dot(other), -1, 1)] += 1;
  histogram[2 * kBins + Bin(cosine, -1, 1)] += 1;
}

/// Scales each angle's histogram to sum 1.
void Normalise(Eigen::Ref<Eigen::RowVectorXf> histogram) {
  for (int angle = 0; angle < 3; ++angle) {
    auto part = histogram.segment(angle * kBins, kBins);
    const float sum = part.sum();
    if (sum > 0) part /= sum;
  }
}

Descriptors SimplifiedHistograms(const CueView& view) {
  Descriptors out = Descriptors::Zero(view.size(), 3 * kBins);
  for (int i = 0; i < view.size(); ++i) {
    Eigen::RowVectorXf histogram = Eigen::RowVectorXf::Zero(3 * kBins);
    for (uint32_t k = view.first[i]; k < view.first[i + 1]; ++k) {
      const uint32_t j = view.neighbours[k];
      AddPair(view.points_T.col(i), view.normals_T.col(i), view.points_T.col(j),
              view.normals_T.col(j), std::sqrt(std::max(1e-10F, view.squared_distances_m2[k])),
              histogram);
    }
    Normalise(histogram);
    out.row(i) = histogram;
  }
  return out;
}

}  // namespace

Descriptors FpfhCue::Describe(const CueView& view) const {
  const Descriptors simplified = SimplifiedHistograms(view);
  Descriptors out(view.size(), dimension());
  for (int i = 0; i < view.size(); ++i) {
    // eq. 4: own histogram plus the neighbours', weighted by 1 / distance
    Eigen::RowVectorXf sum = Eigen::RowVectorXf::Zero(dimension());
    float weights = 0;
    for (uint32_t k = view.first[i]; k < view.first[i + 1]; ++k) {
      const float weight = 1 / std::sqrt(std::max(1e-6F, view.squared_distances_m2[k]));
      sum += weight * simplified.row(view.neighbours[k]);
      weights += weight;
    }
    if (weights > 0) sum /= weights;
    sum += simplified.row(i);
    Normalise(sum);
    out.row(i) = sum;
  }
  return out;
}

}  // namespace beckon::perception
