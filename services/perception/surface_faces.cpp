// Faces grow from patch to patch.
#include "services/perception/surface_faces.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace beckon::perception {
namespace {

constexpr float kSameFace = 0.978f;  // cosine of 12 degrees
constexpr size_t kFewestPatches = 3;
constexpr float kFlat = 1.5f;  // standard deviations that patches may be off

}  // namespace

Face FitFace(const PatchScene& scene, int group, std::vector<int> members) {
  Face face;
  face.group = group;
  face.patches = std::move(members);
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  const InverseDepthNoise noise(scene.sensor);
  float weight = 0;
  for (int i : face.patches) {
    const Patch& patch = scene.patches.patches[i];
    // A patch counts by points on its plane around its centre, so that it has a say in the tilt.
    const float reach = 0.3f * std::sqrt(static_cast<float>(patch.n_cells));
    for (const auto& [du, dv] :
         {std::pair(-1, -1), std::pair(1, -1), std::pair(-1, 1), std::pair(1, 1)}) {
      const Eigen::Vector3f ray = scene.grid.Ray(patch.u + reach * static_cast<float>(du),
                                                 patch.v + reach * static_cast<float>(dv));
      const Eigen::Vector3d r = ray.cast<double>();
      squares += patch.n_cells * r * r.transpose();
      products += patch.n_cells * patch.InverseDepth(ray) * r;
    }
    weight += static_cast<float>(patch.n_cells);
    face.centre_C += patch.centre_C * static_cast<float>(patch.n_cells);
    face.area_m2 += patch.area_m2;
  }
  face.centre_C /= std::max(1.0f, weight);
  face.slope = squares.ldlt().solve(products).cast<float>();
  face.normal_C = -face.slope.normalized();
  for (int i : face.patches) {
    const Patch& patch = scene.patches.patches[i];
    const float w = 1 / patch.centre_C.z();
    const float off = (face.InverseDepth(patch.centre_C * w) - w) / noise(w);
    face.off += off * off * static_cast<float>(patch.n_cells);
  }
  face.off = std::sqrt(face.off / std::max(1.0f, weight));
  return face;
}

std::vector<Face> FindFaces(const PatchScene& scene, const PatchGroups& groups) {
  const auto& patches = scene.patches.patches;
  std::vector<std::vector<int>> neighbours(patches.size());
  for (const PatchEdge& edge : scene.edges) {
    if (edge.n_touching < 2 || groups.Of(edge.a) != groups.Of(edge.b)) continue;
    neighbours[edge.a].push_back(edge.b);
    neighbours[edge.b].push_back(edge.a);
  }
  std::vector<int> order(patches.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return neighbours[a].size() > neighbours[b].size(); });
  std::vector<uint8_t> taken(patches.size(), 0);
  std::vector<Face> faces;
  for (int seed : order) {
    if (taken[seed]) continue;
    taken[seed] = 1;
    std::vector<int> members{seed};
    Eigen::Vector3f sum = patches[seed].steady_normal_C;
    for (size_t k = 0; k < members.size(); ++k) {
      for (int next : neighbours[members[k]]) {
        const Eigen::Vector3f& normal = patches[next].steady_normal_C;
        if (taken[next] || normal.dot(patches[members[k]].steady_normal_C) < kSameFace ||
            normal.dot(sum) < kSameFace * sum.norm()) {
          continue;
        }
        taken[next] = 1;
        members.push_back(next);
        sum += normal;
      }
    }
    if (members.size() < kFewestPatches) continue;
    Face face = FitFace(scene, groups.Of(seed), std::move(members));
    if (face.off < kFlat) faces.push_back(std::move(face));
  }
  return faces;
}

}  // namespace beckon::perception
