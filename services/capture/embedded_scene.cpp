#include "services/capture/embedded_scene.h"

#include <algorithm>

#include "services/capture/embedded_kinect.h"
#include "services/capture/embedded_stage.h"

namespace beckon::capture {
namespace {

constexpr int kFewestObjects = 4;
constexpr int kMostObjects = 8;
constexpr int kFewestVisiblePoints = 300;

struct Placed {
  Model model;
  Pose X_WO;
  std::vector<Eigen::Vector2d> footprint;
  Window window;
};

int Area(const Window& w) { return w.width * w.height; }

int CommonArea(const Window& a, const Window& b) {
  const int w = std::min(a.u0 + a.width, b.u0 + b.width) - std::max(a.u0, b.u0);
  const int h = std::min(a.v0 + a.height, b.v0 + b.height) - std::max(a.v0, b.v0);
  return w > 0 && h > 0 ? w * h : 0;
}

bool OnTable(const Stage& stage, const std::vector<Eigen::Vector2d>& footprint) {
  constexpr double kMargin_m = 0.02;
  return std::all_of(footprint.begin(), footprint.end(), [&](const Eigen::Vector2d& p) {
    return std::abs(p.x()) < stage.table_half_width_m - kMargin_m &&
           p.y() > stage.table_near_m + kMargin_m && p.y() < stage.table_far_m - kMargin_m;
  });
}

/// Wholly in view, and neither hides most of another nor is hidden.
bool InSight(const Window& window, const std::vector<Placed>& others) {
  constexpr int kBorder_px = 6;
  constexpr double kMostHidden = 0.45;
  if (window.u0 < kBorder_px || window.v0 < kBorder_px ||
      window.u0 + window.width > 640 - kBorder_px || window.v0 + window.height > 480 - kBorder_px) {
    return false;
  }
  return std::all_of(others.begin(), others.end(), [&](const Placed& other) {
    const int common = CommonArea(window, other.window);
    return common < kMostHidden * std::min(Area(window), Area(other.window));
  });
}

/// Tries places until one is free; `spread_m` is how far from the camera's aim they are sought.
bool Place(Placed& placed, const Stage& stage, const std::vector<Placed>& others, double spread_m,
           Random& random) {
  const Pose resting = placed.X_WO;
  for (int attempt = 0; attempt < 60; ++attempt) {
    const double gap = random.Chance(0.5) ? random.Uniform(0.003, 0.02) : 0.02;
    placed.X_WO.translation().x() = resting.translation().x() + random.Uniform(-1, 1) * spread_m;
    placed.X_WO.translation().y() = stage.aim_y_m + random.Uniform(-0.9, 1) * spread_m;
    placed.footprint = Footprint(placed.model, placed.X_WO);
    if (!OnTable(stage, placed.footprint)) continue;
    const bool free = std::all_of(others.begin(), others.end(), [&](const Placed& other) {
      return Gap(placed.footprint, other.footprint) >= gap;
    });
    if (!free) continue;
    const auto window = ImageWindow(stage, placed.model, placed.X_WO, 0);
    if (!window || !InSight(*window, others)) continue;
    placed.window = *window;
    return true;
  }
  return false;
}

std::vector<Placed> PlaceObjects(const Stage& stage, Random& random) {
  std::vector<Placed> objects;
  const auto wanted = static_cast<size_t>(random.Int(kFewestObjects, kMostObjects));
  double spread_m = random.Uniform(0.2, 0.32);
  for (int attempt = 0; attempt < 200 && objects.size() < wanted; ++attempt) {
    Placed placed;
    placed.model = MakeModel(static_cast<size_t>(random.Int(0, kCategories.size() - 1)), random);
    placed.X_WO = RestingPose(placed.model, random);
    if (Place(placed, stage, objects, spread_m, random)) {
      objects.push_back(std::move(placed));
    } else {
      spread_m = std::min(0.45, spread_m * 1.1);
    }
    if (attempt >= 40 && objects.size() >= kFewestObjects) break;
  }
  return objects;
}

RgbdImage MakeImage(const Stage& stage, const Window& window, std::vector<float> depth_m,
                    std::vector<Rgb> colour) {
  RgbdImage image;
  image.width = window.width;
  image.height = window.height;
  image.intrinsics = stage.intrinsics;
  image.depth_m = std::move(depth_m);
  image.colour = std::move(colour);
  return image;
}

}  // namespace

EmbeddedFrame RenderEmbeddedScene(uint64_t seed) {
  Random random(seed);
  const Stage stage = MakeStage(random);
  std::vector<Placed> objects = PlaceObjects(stage, random);
  std::vector<Instance> instances = {{&stage.furniture, Pose::Identity(), 0}};
  for (size_t i = 0; i < objects.size(); ++i) {
    instances.push_back({&objects[i].model, objects[i].X_WO, static_cast<uint16_t>(i + 1)});
  }
  const Raycaster raycaster(instances, stage.X_WC);
  const Rendering rendering = raycaster.Render(stage.intrinsics, Window{}, stage.lighting, random);
  KinectDepth depth = SimulateDepth(rendering, RandomKinectNoise(random), random);

  EmbeddedFrame frame;
  frame.image = MakeImage(stage, rendering.window, std::move(depth.depth_m),
                          SimulateColour(rendering, random));
  frame.labels = std::move(depth.labels);
  frame.description.known = true;
  frame.description.table_C = stage.table_C;
  frame.description.intrinsics = stage.intrinsics;
  std::map<int, std::string> categories;
  for (size_t i = 0; i < objects.size(); ++i)
    categories[static_cast<int>(i + 1)] = objects[i].model.category;
  const std::vector<uint32_t> labels(frame.labels.begin(), frame.labels.end());
  for (DescribedObject& object : DescribeLabels(frame.image, labels, categories)) {
    if (object.visible_points < kFewestVisiblePoints) continue;
    object.X_WO = objects[object.label - 1].X_WO;
    object.X_CO = stage.X_WC.inverse() * *object.X_WO;
    frame.description.objects.push_back(object);
  }
  return frame;
}

uint64_t FrameSeed(uint64_t seed, uint64_t index) { return Random::Mix(seed, index); }

}  // namespace beckon::capture
