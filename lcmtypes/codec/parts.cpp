#include "lcmtypes/codec/parts.h"

#include <algorithm>
#include <cctype>
#include <span>
#include <utility>
#include <vector>

namespace beckon::codec {

bool IsUserName(const std::string& name) {
  return std::ranges::all_of(name, [](unsigned char c) {
    return (c < 0x80 && std::isalnum(c) != 0) || c == '_' || c == '.' || c == '-';
  });
}

Rules& Rules::Text(const std::string& text, const char* field, size_t max) {
  Require(text.size() <= max, std::string(field) + " has " + std::to_string(text.size()) +
                                  " characters, at most " + std::to_string(max) + " may be");
  return Require(std::none_of(text.begin(), text.end(),
                              [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; }),
                 std::string(field) + " contains control characters");
}

Rules& Rules::Name(const std::string& name, const char* field, size_t max) {
  return Require(!name.empty(), std::string(field) + " is empty").Text(name, field, max);
}

Rules& Rules::Count(size_t n, const char* field, size_t max, size_t min) {
  return Require(n >= min && n <= max, std::string(field) + ": " + std::to_string(n) +
                                           " elements, expected " + std::to_string(min) + " .. " +
                                           std::to_string(max));
}

Rules& Rules::Range(double value, const char* field, double min, double max) {
  return Require(value >= min && value <= max, std::string(field) + " is " + std::to_string(value) +
                                                   ", expected " + std::to_string(min) + " .. " +
                                                   std::to_string(max));
}

Rules& Rules::Time(Utime utime) { return Require(utime > 0, "utime is not a time"); }

bool Sane(const Pose& pose) {
  return pose.matrix().allFinite() && pose.translation().norm() < 1000 &&
         (pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 &&
         pose.linear().determinant() > 0;
}

void PoseToArrays(const Pose& pose, double (&position)[3], double (&rotation)[4]) {
  ToArray(pose.translation(), position);
  std::ranges::copy(QuaternionWxyz(pose), rotation);
}

Result<Pose> PoseFromArrays(const double (&position)[3], const double (&rotation)[4]) {
  return MakePose(std::to_array(position), std::to_array(rotation));
}

void Walk(Walker& w, const seal_t*) {
  w.String("seal.sender", kMaxName);
  w.Skip(8 + 8 + 8 + 64);
}

Status Check(const msg::Seal& seal) {
  return Rules("seal")
      .Text(seal.sender, "sender", kMaxName)
      .Require(seal.counter >= 0, "counter is negative")
      .Require(seal.expires_utime >= 0, "expires_utime is negative");
}

seal_t ToWire(const msg::Seal& seal) {
  seal_t wire{};
  wire.sender = seal.sender;
  wire.counter = seal.counter;
  wire.expires_utime = seal.expires_utime;
  std::ranges::copy(seal.key_id, wire.key_id);
  std::ranges::copy(seal.signature, wire.signature);
  return wire;
}

msg::Seal FromWire(const seal_t& wire) {
  msg::Seal seal;
  seal.sender = wire.sender;
  seal.counter = wire.counter;
  seal.expires_utime = wire.expires_utime;
  std::ranges::copy(wire.key_id, seal.key_id.begin());
  std::ranges::copy(wire.signature, seal.signature.begin());
  return seal;
}

void Walk(Walker& w, const object_ref_t*) {
  w.Skip(4);
  w.String("category", kMaxName);
  w.Skip(4);
}

Status Check(const msg::ObjectRef& object) {
  return Rules("object")
      .Name(object.category, "category")
      .Range(object.object_id, "object_id", 1, 1e9)
      .Range(object.instance, "instance", 1, msg::kMaxObjects);
}

object_ref_t ToWire(const msg::ObjectRef& object) {
  object_ref_t wire{};
  wire.object_id = object.object_id;
  wire.category = object.category;
  wire.instance = object.instance;
  return wire;
}

msg::ObjectRef FromWire(const object_ref_t& wire) {
  return {.object_id = wire.object_id, .category = wire.category, .instance = wire.instance};
}

constexpr size_t kBytesOfShape = (3 + 4 + 3 + 2 + 2) * 8;

static Status CheckShape(const Pose& X_WO, std::span<const double> semi_axes,
                         std::span<const double> epsilon, std::span<const double> taper) {
  Rules rules("superquadric");
  rules.Require(Sane(X_WO), "X_WO is not a pose");
  for (double a : semi_axes) rules.Range(a, "semi-axis", 1e-6, 100);
  for (double e : epsilon) rules.Range(e, "epsilon", 0.02, 2);
  for (double k : taper) rules.Range(k, "taper", -1, 1);
  return rules;
}

static superquadric_t ToWire(const msg::SuperquadricShape& shape) {
  superquadric_t wire{};
  PoseToArrays(shape.X_WO, wire.X_WO_position, wire.X_WO_rotation);
  std::ranges::copy(shape.semi_axes, wire.semi_axes);
  std::ranges::copy(shape.epsilon, wire.epsilon);
  std::ranges::copy(shape.taper, wire.taper);
  return wire;
}

static Result<std::vector<msg::SuperquadricShape>> FromWire(
    const std::vector<superquadric_t>& wires) {
  std::vector<msg::SuperquadricShape> shapes;
  for (const superquadric_t& wire : wires) {
    const auto X_WO = PoseFromArrays(wire.X_WO_position, wire.X_WO_rotation);
    if (!X_WO) return X_WO.error();
    msg::SuperquadricShape& shape = shapes.emplace_back();
    shape.X_WO = *X_WO;
    std::ranges::copy(wire.semi_axes, shape.semi_axes.begin());
    std::ranges::copy(wire.epsilon, shape.epsilon.begin());
    std::ranges::copy(wire.taper, shape.taper.begin());
  }
  return shapes;
}

void Walk(Walker& w, const object_pose_t*) {
  w.Skip(4 + 7 * 8 + 3 * 8 + 2 * 8 + 2 * 8 + 4 + 1 + 1);
  w.String("reason", kMaxText);
  w.Skip(36 * 4);
  w.Skip(static_cast<size_t>(w.Count("n_alternatives", msg::kMaxAlternatives)) * kBytesOfShape);
  w.Skip(static_cast<size_t>(w.Count("n_parts", msg::kMaxParts)) * kBytesOfShape);
  const int32_t grasps = w.Count("n_grasps", msg::kMaxGrasps);
  w.Skip(static_cast<size_t>(grasps) * (7 * 8 + 8 + 4));
  w.Skip(4);
}

Status Check(const msg::ObjectPose& pose) {
  Rules rules("object pose");
  rules.Range(pose.object_id, "object_id", 1, 1e9)
      .Require(CheckShape(pose.X_WO, pose.semi_axes, pose.epsilon, pose.taper))
      .Range(pose.mean_radial_distance_m, "mean_radial_distance_m", 0, 1000)
      .Text(pose.reason, "reason")
      .Require(pose.covariance.allFinite(), "covariance is not finite")
      .Range(pose.fit_ms, "fit_ms", 0, 1e9)
      .Count(pose.alternatives.size(), "alternatives", msg::kMaxAlternatives)
      .Count(pose.parts.size(), "parts", msg::kMaxParts)
      .Require(pose.parts.size() != 1, "parts: one alone is no part")
      .Count(pose.grasps.size(), "grasps", msg::kMaxGrasps);
  for (const auto* shapes : {&pose.alternatives, &pose.parts}) {
    for (const auto& s : *shapes) {
      rules.Require(CheckShape(s.X_WO, s.semi_axes, s.epsilon, s.taper));
    }
  }
  for (const auto& grasp : pose.grasps) {
    rules.Require(Sane(grasp.X_WG), "grasp: X_WG is not a pose")
        .Range(grasp.opening_m, "grasp: opening_m", 1e-4, 10)
        .Range(grasp.score, "grasp: score", 0, 1);
  }
  return rules;
}

object_pose_t ToWire(const msg::ObjectPose& pose) {
  object_pose_t wire{};
  wire.object_id = pose.object_id;
  PoseToArrays(pose.X_WO, wire.X_WO_position, wire.X_WO_rotation);
  std::ranges::copy(pose.semi_axes, wire.semi_axes);
  std::ranges::copy(pose.epsilon, wire.epsilon);
  std::ranges::copy(pose.taper, wire.taper);
  wire.mean_radial_distance_m = pose.mean_radial_distance_m;
  wire.converged = pose.converged;
  wire.ambiguous = pose.ambiguous;
  wire.reason = pose.reason;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) wire.covariance[i][j] = pose.covariance(i, j);
  }
  wire.n_alternatives = static_cast<int32_t>(pose.alternatives.size());
  for (const auto& shape : pose.alternatives) wire.alternatives.push_back(ToWire(shape));
  wire.n_parts = static_cast<int32_t>(pose.parts.size());
  for (const auto& shape : pose.parts) wire.parts.push_back(ToWire(shape));
  wire.n_grasps = static_cast<int32_t>(pose.grasps.size());
  for (const auto& grasp : pose.grasps) {
    grasp_t g{};
    PoseToArrays(grasp.X_WG, g.X_WG_position, g.X_WG_rotation);
    g.opening_m = grasp.opening_m;
    g.score = grasp.score;
    wire.grasps.push_back(g);
  }
  wire.fit_ms = pose.fit_ms;
  return wire;
}

Result<msg::ObjectPose> FromWire(const object_pose_t& wire) {
  if (!IsBool(wire.converged) || !IsBool(wire.ambiguous))
    return Error{"object pose: a flag is neither 0 nor 1"};
  const auto X_WO = PoseFromArrays(wire.X_WO_position, wire.X_WO_rotation);
  if (!X_WO) return X_WO.error();
  msg::ObjectPose pose;
  pose.object_id = wire.object_id;
  pose.X_WO = *X_WO;
  std::ranges::copy(wire.semi_axes, pose.semi_axes.begin());
  std::ranges::copy(wire.epsilon, pose.epsilon.begin());
  std::ranges::copy(wire.taper, pose.taper.begin());
  pose.mean_radial_distance_m = wire.mean_radial_distance_m;
  pose.converged = wire.converged != 0;
  pose.ambiguous = wire.ambiguous != 0;
  pose.reason = wire.reason;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) pose.covariance(i, j) = wire.covariance[i][j];
  }
  auto alternatives = FromWire(wire.alternatives), parts = FromWire(wire.parts);
  if (!alternatives) return alternatives.error();
  if (!parts) return parts.error();
  pose.alternatives = *std::move(alternatives);
  pose.parts = *std::move(parts);
  for (const auto& g : wire.grasps) {
    const auto X_WG = PoseFromArrays(g.X_WG_position, g.X_WG_rotation);
    if (!X_WG) return X_WG.error();
    pose.grasps.push_back({.X_WG = *X_WG, .opening_m = g.opening_m, .score = g.score});
  }
  pose.fit_ms = wire.fit_ms;
  return pose;
}

}  // namespace beckon::codec
