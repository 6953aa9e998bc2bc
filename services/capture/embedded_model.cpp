#include "services/capture/embedded_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/capture/embedded_model_makers.h"

namespace beckon::capture {
namespace {

using Maker = Model (*)(Random&);
constexpr std::array<Maker, kCategories.size()> kMakers = {
    MakeBottle, MakeBowl,     MakeBox, MakeCan,  MakeCarton, MakeCup,
    MakeMug,    MakeSprayCan, MakeTin, MakeTube, MakeTub};

Eigen::AlignedBox3f Bounds(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const auto& p : mesh.positions) box.extend(p);
  return box;
}

/// Turns a body that lies along x about y until its lowest points left and right are level.
Eigen::Matrix3d Settle(const Mesh& mesh, Eigen::Matrix3d rotation) {
  for (int i = 0; i < 3; ++i) {
    Eigen::Vector3d low[2] = {{0, 0, 1e9}, {0, 0, 1e9}};
    for (const auto& p : mesh.positions) {
      const Eigen::Vector3d q = rotation * p.cast<double>();
      Eigen::Vector3d& side = low[q.x() > 0];
      if (q.z() < side.z()) side = q;
    }
    const double slope = std::atan2(low[1].z() - low[0].z(), low[1].x() - low[0].x());
    if (!std::isfinite(slope) || std::abs(slope) > 0.5) break;
    rotation = Eigen::AngleAxisd(slope, Eigen::Vector3d::UnitY()).toRotationMatrix() * rotation;
  }
  return rotation;
}

}  // namespace

uint32_t Model::AddMaterial(Texture texture, float gloss, float metal) {
  materials.push_back({std::move(texture), gloss, metal});
  return static_cast<uint32_t>(materials.size() - 1);
}

Model MakeModel(size_t category, Random& random) {
  Model model = kMakers.at(category)(random);
  model.category = kCategories[category];
  const auto box = Bounds(model.mesh);
  for (auto& p : model.mesh.positions) p -= box.center();
  return model;
}

void RestLike(const std::string& category, Model& model) {
  Random random(1);
  for (size_t c = 0; c < kCategories.size(); ++c) {
    if (category != kCategories[c]) continue;
    const Model typical = kMakers[c](random);
    model.lying = typical.lying;
    model.upside_down = typical.upside_down;
    model.any_face = typical.any_face;
  }
}

Pose RestingPose(const Model& model, Random& random) {
  constexpr double kQuarter = std::numbers::pi / 2;
  const auto turn = [](double angle, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  const double choice = random.Unit();
  if (model.any_face) {
    const int face = random.Int(0, 2);
    if (face == 1) rotation = turn(kQuarter, Eigen::Vector3d::UnitX());
    if (face == 2) rotation = turn(kQuarter, Eigen::Vector3d::UnitY());
    if (random.Chance(0.3)) rotation = turn(2 * kQuarter, Eigen::Vector3d::UnitX()) * rotation;
  } else if (choice < model.lying) {
    // Its axis along x. Flat bodies lie on a flat side, round ones anyhow.
    double roll = random.Uniform(0, 4 * kQuarter);
    if (model.category == "Tube" || model.category == "Bottle") roll = random.Uniform(-0.1, 0.1);
    if (model.category == "Carton" || model.category == "Tin") roll = kQuarter * random.Int(0, 3);
    rotation =
        turn(kQuarter, Eigen::Vector3d::UnitY()) * turn(kQuarter + roll, Eigen::Vector3d::UnitZ());
    rotation = Settle(model.mesh, rotation);
  } else if (choice < model.lying + model.upside_down) {
    rotation = turn(2 * kQuarter, Eigen::Vector3d::UnitX());
  }
  rotation = turn(random.Uniform(0, 4 * kQuarter), Eigen::Vector3d::UnitZ()) * rotation;
  double lowest = 1e9;
  for (const auto& p : model.mesh.positions) {
    lowest = std::min(lowest, rotation.row(2).dot(p.cast<double>()));
  }
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation().z() = -lowest;
  return pose;
}

Mesh Turn(const std::vector<OutlinePoint>& outline, double flatness, double exponent) {
  double low = 1e9, high = -1e9;
  for (const auto& p : outline) low = std::min(low, p.z), high = std::max(high, p.z);
  std::vector<Ring> rings;
  for (const auto& p : outline) {
    rings.push_back({p.z, p.radius, p.radius * flatness, exponent,
                     (p.z - low) / std::max(1e-9, high - low), p.material});
  }
  return Loft(rings);
}

void AddCurve(std::vector<OutlinePoint>& outline, double r1, double z1, bool along_z_first, int n,
              uint32_t material) {
  const double r0 = outline.back().radius, z0 = outline.back().z;
  for (int i = 1; i <= n; ++i) {
    const double angle = std::numbers::pi / 2 * i / n;
    const double slow = 1 - std::cos(angle), fast = std::sin(angle);
    outline.push_back({r0 + (r1 - r0) * (along_z_first ? slow : fast),
                       z0 + (z1 - z0) * (along_z_first ? fast : slow), material});
  }
}

}  // namespace beckon::capture
