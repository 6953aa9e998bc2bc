// The local rules.
#include "services/perception/grouping_rules.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace beckon::perception {
namespace {

constexpr float kDegree = 3.14159265f / 180;
constexpr float kBent = 9 * kDegree;       // a smooth surface turns no more between patches
constexpr float kSure = 2;                 // standard deviations of the angle between two normals
constexpr float kRoundest = 28 * kDegree;  // between patches of the inside of something round
constexpr float kAlike = 0.25f;            // least part of the bend on either side
constexpr float kSmoothEvidence = 0.5f;
constexpr float kStepWeight = 0.15f;  // of a cell where one patch hides the other

}  // namespace

float CreaseAngle(const Patch& a, const Patch& b) {
  const float angle = std::acos(std::clamp(a.steady_normal_C.dot(b.steady_normal_C), -1.0f, 1.0f));
  const bool convex = (a.steady_normal_C - b.steady_normal_C).dot(a.centre_C - b.centre_C) >= 0;
  return convex ? angle : -angle;
}

bool MeetAtCorner(const Patch& a, const Patch& b) {
  const Eigen::Vector3f cut = a.normal_C.cross(b.normal_C);
  const float sine = cut.norm();
  if (sine < std::sin(15 * kDegree)) return false;
  const float along = std::abs(cut.dot((a.centre_C - b.centre_C).normalized())) / sine;
  return along > std::cos(25 * kDegree);
}

float ConvexityEvidence(const Patch& a, const Patch& b) {
  const float angle = CreaseAngle(a, b);
  if (angle >= 0) return 1;
  const float noise = std::hypot(a.normal_sigma, b.normal_sigma);
  const float allowed = std::hypot(kBent, kSure * noise);
  return std::clamp(1 + angle / allowed, -1.0f, 1.0f);
}

Neighbours FindNeighbours(const SurfacePatches& patches, const std::vector<PatchEdge>& edges) {
  Neighbours neighbours(patches.patches.size());
  for (const PatchEdge& edge : edges) {
    if (edge.n_touching < 2) continue;
    neighbours[edge.a].push_back(edge.b);
    neighbours[edge.b].push_back(edge.a);
  }
  return neighbours;
}

namespace {

/// The crease on the side of `a` that lies away from `b`; 0 where nothing is there.
std::optional<float> CreaseBehind(const SurfacePatches& patches, const Neighbours& neighbours,
                                  int a, int b) {
  const Patch& here = patches.patches[a];
  const Eigen::Vector3f away = (here.centre_C - patches.patches[b].centre_C).normalized();
  int best = -1;
  float straightest = 0.75f;
  for (int c : neighbours[a]) {
    const float cosine = away.dot((patches.patches[c].centre_C - here.centre_C).normalized());
    if (c != b && cosine > straightest) straightest = cosine, best = c;
  }
  if (best < 0) return std::nullopt;
  return CreaseAngle(here, patches.patches[best]);
}

}  // namespace

bool BendsThroughout(const SurfacePatches& patches, const Neighbours& neighbours, int a, int b) {
  const float angle = CreaseAngle(patches.patches[a], patches.patches[b]);
  if (angle >= 0 || angle < -kRoundest) return false;
  const auto behind_a = CreaseBehind(patches, neighbours, a, b);
  const auto behind_b = CreaseBehind(patches, neighbours, b, a);
  if (!behind_a && !behind_b) return false;
  auto bends = [angle](const std::optional<float>& crease) {
    return !crease || (*crease<kAlike * angle&& * crease> - kRoundest);
  };
  return bends(behind_a) && bends(behind_b);
}

namespace {

/// Adds what the cells say where one patch lies before the other: an object's own parts mostly
/// touch along their border.
SignedEdge WithSteps(SignedEdge signed_edge, const PatchEdge& edge) {
  const float steps = kStepWeight * static_cast<float>(edge.n_a_before + edge.n_b_before);
  if (steps == 0) return signed_edge;
  const float length = signed_edge.length + steps;
  signed_edge.evidence = (signed_edge.evidence * signed_edge.length - steps) / length;
  signed_edge.length = length;
  return signed_edge;
}

}  // namespace

SignedEdge LocalEvidence(const SurfacePatches& patches, const Neighbours& neighbours,
                         const PatchEdge& edge) {
  const Patch &a = patches.patches[edge.a], &b = patches.patches[edge.b];
  SignedEdge result{edge.a, edge.b, 0, static_cast<float>(edge.n_touching)};
  if (MeetAtCorner(a, b)) {
    result.length = 0;
  } else if (BendsThroughout(patches, neighbours, edge.a, edge.b)) {
    result.evidence = kSmoothEvidence;
  } else {
    result.evidence = ConvexityEvidence(a, b);
  }
  return WithSteps(result, edge);
}

}  // namespace beckon::perception
