// Hypotheses of one surface behind an occluder, and their checks.
#include "services/perception/occlusion_rule.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "services/perception/surface_faces.h"

namespace beckon::perception {
namespace {

constexpr float kCoplanar = 0.985f;    // cosine of 10 degrees
constexpr float kOnSurface = 1.5f;     // standard deviations of a reading, root mean square
constexpr float kNearer = 4;           // standard deviations that an occluder is in front
constexpr float kLargest_m = 0.36f;    // an object
constexpr float kLeastOverlap = 0.5f;  // of the smaller part, across the gap
constexpr int kLeastHidden = 2;        // cells along which an occluder borders what it hides
constexpr size_t kFewestRound = 3;     // patches of a part of a cylinder
constexpr int kLines = 5;              // of sight across the gap
constexpr float kLeastFilled = 0.7f;   // of the gap by the occluder, where there is depth

/// The two patches, one of each set, that are nearest in the image.
std::pair<int, int> Nearest(const std::vector<Patch>& patches, const std::vector<int>& a,
                            const std::vector<int>& b) {
  std::pair<int, int> best{a.front(), b.front()};
  float least = std::numeric_limits<float>::max();
  for (int i : a) {
    for (int j : b) {
      const float d = std::hypot(patches[i].u - patches[j].u, patches[i].v - patches[j].v);
      if (d < least) least = d, best = {i, j};
    }
  }
  return best;
}

class GapCheck {
 public:
  GapCheck(const PatchScene& scene, const PatchGroups& groups)
      : scene_(scene), groups_(groups), noise_(scene.sensor) {}

  /// Whether something nearer fills the image between two sets of patches of two groups.
  bool Filled(const std::vector<int>& a, const std::vector<int>& b) const {
    const auto& patches = scene_.patches.patches;
    // Lines from the patches of the smaller set nearest to the other.
    const auto& small = a.size() < b.size() ? a : b;
    const auto& large = a.size() < b.size() ? b : a;
    std::vector<std::pair<float, std::pair<int, int>>> lines;
    for (int i : small) {
      const int j = Nearest(patches, {i}, large).second;
      lines.push_back(
          {std::hypot(patches[i].u - patches[j].u, patches[i].v - patches[j].v), {i, j}});
    }
    std::sort(lines.begin(), lines.end());
    const int n = std::min<int>(kLines, static_cast<int>(lines.size()));
    int filled = 0;
    for (int k = 0; k < n; ++k) {
      filled += LineFilled(patches[lines[k].second.first], patches[lines[k].second.second]);
    }
    return 3 * filled >= 2 * n;
  }

 private:
  bool LineFilled(const Patch& from, const Patch& to) const {
    const float length = std::hypot(to.u - from.u, to.v - from.v);
    const int steps = std::max(1, static_cast<int>(length));
    const int own_a = GroupAt(from.u, from.v), own_b = GroupAt(to.u, to.v);
    int nearer = 0, open = 0;
    for (int k = 1; k < steps; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(steps);
      const float u = from.u + t * (to.u - from.u), v = from.v + t * (to.v - from.v);
      const size_t i = scene_.grid.Index(static_cast<int>(u + 0.5f), static_cast<int>(v + 0.5f));
      const float w = scene_.cells.inverse_depth[i];
      if (w <= 0) continue;  // a shadow
      const int group = GroupAt(u, v);
      if (group >= 0 && (group == own_a || group == own_b)) continue;
      const float surface = (1 - t) / from.centre_C.z() + t / to.centre_C.z();
      (w > surface + kNearer * noise_(w) ? nearer : open) += 1;
    }
    return nearer >= 2 &&
           static_cast<float>(nearer) >= kLeastFilled * static_cast<float>(nearer + open);
  }

  int GroupAt(float u, float v) const {
    const size_t i = scene_.grid.Index(static_cast<int>(u + 0.5f), static_cast<int>(v + 0.5f));
    const int patch = scene_.patches.patch_of_cell[i];
    return patch < 0 ? -1 : groups_.Of(patch);
  }

  const PatchScene& scene_;
  const PatchGroups& groups_;
  InverseDepthNoise noise_;
};

/// The extent of patches along a direction, m.
struct Interval {
  float low = std::numeric_limits<float>::max(), high = -std::numeric_limits<float>::max();
  float length() const { return high - low; }
};

Interval Extent(const std::vector<Patch>& patches, const std::vector<int>& members,
                const Eigen::Vector3f& direction) {
  Interval interval;
  for (int i : members) {
    const float at = direction.dot(patches[i].centre_C);
    const float reach = 0.5f * std::sqrt(patches[i].area_m2);
    interval.low = std::min(interval.low, at - reach);
    interval.high = std::max(interval.high, at + reach);
  }
  return interval;
}

Eigen::Vector3f Centre(const std::vector<Patch>& patches, const std::vector<int>& members) {
  Eigen::Vector3f sum(0, 0, 0);
  for (int i : members) sum += patches[i].centre_C;
  return sum / static_cast<float>(members.size());
}

/// Whether two parts on a surface with this normal lie beside each other, and are together no
/// larger than an object.
bool SideBySide(const std::vector<Patch>& patches, const std::vector<int>& a,
                const std::vector<int>& b, const Eigen::Vector3f& normal) {
  Eigen::Vector3f along = Centre(patches, b) - Centre(patches, a);
  along -= normal * normal.dot(along);
  if (along.norm() < 1e-3f) return false;
  along.normalize();
  const Eigen::Vector3f across = normal.cross(along);
  const Interval x = Extent(patches, a, across), y = Extent(patches, b, across);
  const float common = std::min(x.high, y.high) - std::max(x.low, y.low);
  const Interval u = Extent(patches, a, along), v = Extent(patches, b, along);
  return common > kLeastOverlap * std::min(x.length(), y.length()) &&
         std::max(u.high, v.high) - std::min(u.low, v.low) < kLargest_m;
}

bool OnePlane(const PatchScene& scene, const Face& a, const Face& b) {
  if (a.normal_C.dot(b.normal_C) < kCoplanar) return false;
  std::vector<int> both = a.patches;
  both.insert(both.end(), b.patches.begin(), b.patches.end());
  const Face joint = FitFace(scene, a.group, std::move(both));
  return joint.off < kOnSurface && joint.normal_C.dot(a.normal_C) > kCoplanar &&
         joint.normal_C.dot(b.normal_C) > kCoplanar &&
         SideBySide(scene.patches.patches, a.patches, b.patches, joint.normal_C);
}

/// Whether one cylinder with its axis from one part to the other fits both.
bool OneCylinder(const PatchScene& scene, const std::vector<int>& a, const std::vector<int>& b) {
  const auto& patches = scene.patches.patches;
  const Eigen::Vector3f between = (Centre(patches, b) - Centre(patches, a)).normalized();
  Eigen::Matrix3f normals = Eigen::Matrix3f::Zero();
  std::vector<int> sides[2];
  for (int part = 0; part < 2; ++part) {
    for (int i : part == 0 ? a : b) {
      const Eigen::Vector3f& n = patches[i].normal_C;
      if (std::abs(n.dot(between)) > 0.45f) continue;
      sides[part].push_back(i);
      normals += n * n.transpose();
    }
    if (sides[part].size() < 3) return false;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(normals);
  const Eigen::Vector3f axis = solver.eigenvectors().col(0);
  const float n_sides = static_cast<float>(sides[0].size() + sides[1].size());
  if (std::abs(axis.dot(between)) < 0.94f || solver.eigenvalues()[1] < 0.03f * n_sides)
    return false;
  // p - R n = c, across the axis: least squares of the centre and the radius.
  Eigen::Vector3f mean_p(0, 0, 0), mean_n(0, 0, 0);
  for (const auto& side : sides) {
    for (int i : side) mean_p += patches[i].centre_C, mean_n += patches[i].normal_C;
  }
  mean_p /= n_sides, mean_n /= n_sides;
  float pn = 0, nn = 0;
  auto across = [&axis](const Eigen::Vector3f& x) { return (x - axis * axis.dot(x)).eval(); };
  for (const auto& side : sides) {
    for (int i : side) {
      const Eigen::Vector3f n = across(patches[i].normal_C - mean_n);
      pn += n.dot(across(patches[i].centre_C - mean_p));
      nn += n.dot(n);
    }
  }
  const float radius = pn / nn;
  if (!(radius > 0.01f && radius < 0.15f)) return false;
  const Eigen::Vector3f centre = mean_p - radius * mean_n;
  for (const auto& side : sides) {
    float off = 0;
    for (int i : side) {
      const float sigma = static_cast<float>(scene.sensor.Sigma(patches[i].centre_C.z()));
      const float e = (across(patches[i].centre_C - centre).norm() - radius) / sigma;
      off += e * e;
    }
    if (std::sqrt(off / static_cast<float>(side.size())) > 2 * kOnSurface) return false;
  }
  const Interval u = Extent(patches, a, axis), v = Extent(patches, b, axis);
  return std::max(u.high, v.high) - std::min(u.low, v.low) < kLargest_m;
}

/// Pairs of groups that are both partly hidden by the same third one, ordered.
std::set<std::pair<int, int>> PairsBehindOneOccluder(const PatchScene& scene,
                                                     const PatchGroups& groups) {
  std::map<std::pair<int, int>, int> border;  // occluder and hidden, cells
  for (const PatchEdge& edge : scene.edges) {
    const int a = groups.Of(edge.a), b = groups.Of(edge.b);
    if (a == b) continue;
    if (edge.n_a_before > 0) border[{a, b}] += edge.n_a_before;
    if (edge.n_b_before > 0) border[{b, a}] += edge.n_b_before;
  }
  std::set<std::pair<int, int>> pairs;
  for (auto first = border.begin(); first != border.end(); ++first) {
    if (first->second < kLeastHidden) continue;
    for (auto second = std::next(first);
         second != border.end() && second->first.first == first->first.first; ++second) {
      if (second->second < kLeastHidden) continue;
      pairs.insert({first->first.second, second->first.second});
    }
  }
  return pairs;
}

}  // namespace

void JoinAcrossOccluders(const PatchScene& scene, PatchGroups& groups) {
  const GapCheck gap(scene, groups);
  std::vector<std::vector<Face>> faces(groups.Count());
  for (Face& face : FindFaces(scene, groups)) faces[face.group].push_back(std::move(face));
  // The groups as they were: joining must not make new hypotheses on the way.
  std::vector<std::vector<int>> members;
  for (int g = 0; g < groups.Count(); ++g) members.push_back(groups.Members(g));
  for (const auto& pair : PairsBehindOneOccluder(scene, groups)) {
    const int a = pair.first, b = pair.second;
    const int now_a = groups.Of(members[a].front()), now_b = groups.Of(members[b].front());
    if (now_a == now_b) continue;
    bool one = std::any_of(faces[a].begin(), faces[a].end(), [&](const Face& f) {
      return std::any_of(faces[b].begin(), faces[b].end(), [&](const Face& g) {
        return OnePlane(scene, f, g) && gap.Filled(f.patches, g.patches);
      });
    });
    one = one || (members[a].size() >= kFewestRound && members[b].size() >= kFewestRound &&
                  OneCylinder(scene, members[a], members[b]) && gap.Filled(members[a], members[b]));
    if (one) groups.Join(now_a, now_b);
  }
}

}  // namespace beckon::perception
