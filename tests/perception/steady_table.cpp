// Renders anew only what changed; the noise is new in every frame.
#include "tests/perception/steady_table.h"

#include <cmath>
#include <utility>

namespace beckon::perception {
namespace {

constexpr int kCategories[] = {2, 3, 6, 4, 8, 1, 5, 7, 10, 0};  // Box Can Mug Carton Tin Bowl ..

}  // namespace

SteadyTable::SteadyTable(uint64_t seed, int n_objects)
    : random_(seed),
      stage_(capture::MakeStage(random_)),
      noise_(capture::RandomKinectNoise(random_)) {
  const int in_row = (n_objects + 1) / 2;
  for (int i = 0; i < n_objects; ++i) {
    const auto category = static_cast<size_t>(kCategories[i % std::size(kCategories)]);
    Object object{capture::MakeModel(category, random_), Pose::Identity()};
    object.X_WO = capture::RestingPose(object.model, random_);
    objects_.push_back(std::move(object));
    const int row = i / in_row, column = i % in_row;
    const double spread_m = 0.14 * (column - 0.5 * (in_row - 1)) + (row == 0 ? 0 : 0.05);
    Place(i, spread_m, stage_.aim_y_m + (row == 0 ? -0.08 : 0.12));
  }
}

void SteadyTable::Place(int object, double x_m, double y_m) {
  objects_[object].X_WO.translation().x() = x_m;
  objects_[object].X_WO.translation().y() = y_m;
  rendering_.reset();
}

RgbdImage SteadyTable::Next() {
  if (!rendering_) {
    std::vector<capture::Instance> instances = {{&stage_.furniture, Pose::Identity(), 0}};
    for (size_t i = 0; i < objects_.size(); ++i) {
      if (!objects_[i].there) continue;
      instances.push_back({&objects_[i].model, objects_[i].X_WO, static_cast<uint16_t>(i + 1)});
    }
    const capture::Raycaster raycaster(instances, stage_.X_WC);
    rendering_ = raycaster.Render(stage_.intrinsics, {}, stage_.lighting, random_);
  }
  depth_ = capture::SimulateDepth(*rendering_, noise_, random_);
  RgbdImage image;
  image.width = rendering_->window.width;
  image.height = rendering_->window.height;
  image.intrinsics = stage_.intrinsics;
  image.depth_m = depth_.depth_m;
  image.colour = capture::SimulateColour(*rendering_, random_);
  return image;
}

void SteadyTable::Move(int object, double dx_m, double dy_m, double dz_m) {
  objects_[object].X_WO.translation() += Eigen::Vector3d(dx_m, dy_m, dz_m);
  rendering_.reset();
}

void SteadyTable::Remove(int object) {
  objects_[object].there = false;
  rendering_.reset();
}

void SteadyTable::PutBack(int object) {
  objects_[object].there = true;
  rendering_.reset();
}

int SteadyTable::AddBox(const Eigen::Vector3d& size_m, const Eigen::Vector3d& at_W,
                        const Rgb& colour) {
  Object box;
  const uint32_t material = box.model.AddMaterial(capture::PlainTexture(colour));
  box.model.category = "Box";
  box.model.mesh =
      capture::BoxMesh(size_m, {material, material, material, material, material, material});
  box.X_WO = Pose::Identity();
  box.X_WO.translation() = at_W;
  objects_.push_back(std::move(box));
  rendering_.reset();
  return n_objects() - 1;
}

}  // namespace beckon::perception
