// Flat faces: the directions that much of the surface faces.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "services/perception/cue_own_frame.h"
#include "services/perception/cue_shape_measures.h"

namespace beckon::perception {
namespace {

constexpr int kFaces = 3;
constexpr int kMeasuresPerFace = 7;
constexpr float kSameFace = 0.94F;  // cosine: 20 degrees
constexpr float kTaken = 0.8F;      // what faces within 37 degrees of a face is no other face
constexpr int kCandidates = 120;

/// The direction among the normals that most of the others face as well.
Eigen::Vector3f CommonestNormal(const CueView& view, const std::vector<int>& left) {
  Eigen::Vector3f best = Eigen::Vector3f::UnitZ();
  int most = -1;
  const size_t step = std::max<size_t>(1, left.size() / kCandidates);
  for (size_t i = 0; i < left.size(); i += step) {
    const Eigen::Vector3f n = view.normals_T.col(left[i]);
    int count = 0;
    for (const int j : left) count += n.dot(view.normals_T.col(j)) > kSameFace;
    if (count > most) best = n, most = count;
  }
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const int j : left) {
    if (best.dot(view.normals_T.col(j)) > kSameFace) mean += view.normals_T.col(j);
  }
  return mean.norm() > 0.5F ? mean.normalized() : best;
}

/// Length and width of the face's points along their own main directions, and how flat they are.
void MeasureFace(const CueView& view, const Eigen::Vector3f& normal, const std::vector<int>& face,
                 std::vector<float>& out) {
  Eigen::Matrix3Xf points(3, static_cast<int>(face.size()));
  for (size_t i = 0; i < face.size(); ++i) {
    points.col(static_cast<int>(i)) = view.points_T.col(face[i]);
  }
  const Eigen::Matrix3Xf centred = points.colwise() - points.rowwise().mean();
  Eigen::Matrix3f flat = centred * centred.transpose();
  const Eigen::Matrix3f onto = Eigen::Matrix3f::Identity() - normal * normal.transpose();
  flat = onto * flat * onto;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(flat);
  const auto extent = [&](const Eigen::Vector3f& along) {
    const Eigen::RowVectorXf at = along.transpose() * centred;
    const std::vector<float> values(at.data(), at.data() + at.size());
    return Quantile(values, 0.97F) - Quantile(values, 0.03F);
  };
  const float length = extent(solver.eigenvectors().col(2));
  const float width = extent(solver.eigenvectors().col(1));
  const float thickness = extent(normal);
  const float area = static_cast<float>(face.size()) * view.voxel_m * view.voxel_m;
  out.insert(out.end(),
             {static_cast<float>(face.size()) / static_cast<float>(view.size()), length, width,
              thickness, area / std::max(1e-4F, length * width), std::abs(normal.z())});
}

}  // namespace

void MeasureFaces(const CueView& view, std::vector<float>& out) {
  std::vector<int> left(static_cast<size_t>(view.size()));
  std::iota(left.begin(), left.end(), 0);
  std::vector<Eigen::Vector3f> normals;
  float taken = 0;
  for (int k = 0; k < kFaces; ++k) {
    if (left.size() < 12) {
      out.insert(out.end(), kMeasuresPerFace, 0.0F);
      normals.emplace_back(Eigen::Vector3f::Zero());
      continue;
    }
    const Eigen::Vector3f normal = CommonestNormal(view, left);
    std::vector<int> face, others;
    for (const int i : left) {
      const float cosine = normal.dot(view.normals_T.col(i));
      if (cosine > kSameFace) face.push_back(i);
      if (cosine < kTaken) others.push_back(i);
    }
    MeasureFace(view, normal, face, out);
    // How much of what faces nearly there faces exactly there: 1 for a box, less for a cylinder.
    out.push_back(static_cast<float>(face.size()) /
                  static_cast<float>(std::max<size_t>(1, left.size() - others.size())));
    taken += static_cast<float>(face.size());
    normals.push_back(normal);
    left = std::move(others);
  }
  out.insert(out.end(), {std::abs(normals[0].dot(normals[1])), std::abs(normals[0].dot(normals[2])),
                         taken / static_cast<float>(view.size())});
}

}  // namespace beckon::perception
