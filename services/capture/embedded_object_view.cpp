#include "services/capture/embedded_object_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "services/capture/embedded_kinect.h"
#include "services/capture/embedded_stage.h"

namespace beckon::capture {
namespace {

constexpr uint16_t kLabel = 1;
constexpr int kMargin_px = 12;

/// Widens a window for filters that look beyond its border.
Window Grown(const Window& w, int by_px) {
  const int u0 = std::max(0, w.u0 - by_px), v0 = std::max(0, w.v0 - by_px);
  const int u1 = std::min(640, w.u0 + w.width + by_px), v1 = std::min(480, w.v0 + w.height + by_px);
  return {u0, v0, u1 - u0, v1 - v0};
}

/// Puts the model so that the whole of it is in view.
std::optional<Pose> PutInView(const Stage& stage, const Model& model, Random& random) {
  Pose X_WO = RestingPose(model, random);
  const double height = X_WO.translation().z();
  for (int attempt = 0; attempt < 50; ++attempt) {
    X_WO.translation() = Eigen::Vector3d(random.Uniform(-0.3, 0.3),
                                         stage.aim_y_m + random.Uniform(-0.2, 0.25), height);
    const auto window = ImageWindow(stage, model, X_WO, 2);
    if (window && window->u0 > 0 && window->v0 > 0 && window->u0 + window->width < 640 &&
        window->v0 + window->height < 480) {
      return X_WO;
    }
  }
  return std::nullopt;
}

/// A pose beside the object, `bearing` from it (0 = right, -pi/2 = towards the camera), as near as
/// `gap_m` lets it stand.
Pose PutBeside(const Model& neighbour, const std::vector<Eigen::Vector2d>& object,
               const Eigen::Vector2d& centre, double bearing, double gap_m, Random& random) {
  Pose X_WN = RestingPose(neighbour, random);
  const Eigen::Vector2d direction(std::cos(bearing), std::sin(bearing));
  for (double distance = 0.02; distance < 0.6; distance += 0.004) {
    X_WN.translation().head<2>() = centre + direction * distance;
    if (Gap(object, Footprint(neighbour, X_WN)) >= gap_m) break;
  }
  return X_WN;
}

/// The mask a segmentation would give: the outline strays by about a pixel, and what lies as low as
/// the table is lost.
std::vector<uint8_t> StrayMask(const Stage& stage, const Window& window, const KinectDepth& depth,
                               Random& random) {
  const int w = window.width, h = window.height;
  const double stray_px = random.Uniform(0.0, 0.7);
  const double lowest_m = random.Chance(0.5) ? random.Uniform(0.002, 0.008) : -0.01;
  const auto du = SmoothNoise(w, h, 2, 2, random), dv = SmoothNoise(w, h, 2, 2, random);
  std::vector<uint8_t> mask(window.Size(), 0);
  for (int v = 0; v < h; ++v) {
    for (int u = 0; u < w; ++u) {
      const size_t i = static_cast<size_t>(v) * w + u;
      const int x = std::clamp(u + static_cast<int>(std::lround(stray_px * du[i])), 0, w - 1);
      const int y = std::clamp(v + static_cast<int>(std::lround(stray_px * dv[i])), 0, h - 1);
      if (depth.depth_m[i] <= 0 || depth.labels[static_cast<size_t>(y) * w + x] != kLabel) continue;
      const auto p = stage.intrinsics.Unproject(window.u0 + u, window.v0 + v, depth.depth_m[i]);
      if (stage.table_C.Distance(p) > (depth.labels[i] == kLabel ? lowest_m : 0.01)) mask[i] = 255;
    }
  }
  return mask;
}

float NearestDepth(const KinectDepth& depth, const std::vector<uint8_t>& mask) {
  float nearest = 1e9f;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0) nearest = std::min(nearest, depth.depth_m[i]);
  }
  return nearest;
}

template <typename T>
std::vector<T> Cut(const std::vector<T>& image, const Window& from, const Window& to) {
  std::vector<T> out;
  out.reserve(to.Size());
  for (int v = 0; v < to.height; ++v) {
    const auto row = image.begin() + static_cast<std::ptrdiff_t>(v + to.v0 - from.v0) * from.width +
                     (to.u0 - from.u0);
    out.insert(out.end(), row, row + to.width);
  }
  return out;
}

/// The window of the mask's pixels, `kMargin_px` wider, within `window`; none where it is empty.
std::optional<Window> MaskWindow(const std::vector<uint8_t>& mask, const Window& window) {
  int u0 = window.width, v0 = window.height, u1 = -1, v1 = -1;
  for (int v = 0; v < window.height; ++v) {
    for (int u = 0; u < window.width; ++u) {
      if (mask[static_cast<size_t>(v) * window.width + u] == 0) continue;
      u0 = std::min(u0, u), u1 = std::max(u1, u), v0 = std::min(v0, v), v1 = std::max(v1, v);
    }
  }
  if (u1 < 0) return std::nullopt;
  u0 = std::max(0, u0 - kMargin_px), v0 = std::max(0, v0 - kMargin_px);
  u1 = std::min(window.width - 1, u1 + kMargin_px),
  v1 = std::min(window.height - 1, v1 + kMargin_px);
  return Window{window.u0 + u0, window.v0 + v0, u1 - u0 + 1, v1 - v0 + 1};
}

struct Neighbour {
  Model model;
  Pose X_WN;
};

/// About 30 % are partly hidden by a neighbour in front, another 25 % have one beside or behind.
std::optional<Neighbour> MakeNeighbour(const Model& model, const Pose& X_WO, Random& random) {
  constexpr double kPi = 3.14159265358979;
  const double kind = random.Unit();
  if (kind > 0.55) return std::nullopt;
  Neighbour neighbour{MakeModel(static_cast<size_t>(random.Int(0, kCategories.size() - 1)), random),
                      {}};
  const double bearing =
      kind < 0.3 ? -kPi / 2 + random.Uniform(-0.9, 0.9) : random.Uniform(-0.3, kPi + 0.3);
  neighbour.X_WN = PutBeside(neighbour.model, Footprint(model, X_WO), X_WO.translation().head<2>(),
                             bearing, random.Uniform(0.003, 0.05), random);
  return neighbour;
}

/// The table's normal as it is found in practice: mostly to a degree or two, now and then badly,
/// and sometimes not at all.
std::optional<Eigen::Vector3d> MeasuredUp(const Stage& stage, Random& random) {
  constexpr double kDegree = 3.14159265358979 / 180;
  const double choice = random.Unit();
  if (choice < 0.1) return std::nullopt;
  const double sigma = (choice < 0.25 ? 6 : 1.2) * kDegree;
  const Eigen::Vector3d stray(random.Normal(), random.Normal(), random.Normal());
  return (stage.table_C.normal + sigma * stray).normalized();
}

std::optional<ObjectView> TryRender(const Model& model, bool any_camera, Random& random) {
  constexpr double kLeastVisible = 0.4;
  constexpr int kFewestPixels = 250;
  constexpr float kNearest_m = 0.35f;  // depth cameras are blind to what is nearer
  const CameraRange kinect{28, 52, 0.6, 1.25}, any{18, 62, 0.5, 1.5};
  Stage stage = MakeStage(random, any_camera ? any : kinect);
  DepthCamera camera{stage.intrinsics, RandomKinectNoise(random)};
  if (any_camera) camera = RandomDepthCamera(random);
  stage.intrinsics = camera.intrinsics;
  const auto X_WO = PutInView(stage, model, random);
  if (!X_WO) return std::nullopt;
  const Window window = Grown(*ImageWindow(stage, model, *X_WO, kMargin_px), 6);
  std::vector<Instance> instances = {{&model, *X_WO, kLabel},
                                     {&stage.furniture, Pose::Identity(), 0}};
  const auto neighbour = MakeNeighbour(model, *X_WO, random);
  double visible = 1;
  if (neighbour) {
    instances.push_back({&neighbour->model, neighbour->X_WN, 2});
    const Raycaster alone({instances[0]}, stage.X_WC), together(instances, stage.X_WC);
    visible =
        together.CountVisible(stage.intrinsics, window, kLabel) /
        std::max(1.0, static_cast<double>(alone.CountVisible(stage.intrinsics, window, kLabel)));
    if (visible < kLeastVisible) return std::nullopt;
  }
  const Raycaster raycaster(instances, stage.X_WC);
  const Rendering rendering = raycaster.Render(stage.intrinsics, window, stage.lighting, random);
  const KinectDepth depth = SimulateDepth(rendering, camera.noise, random);
  const auto mask = StrayMask(stage, window, depth, random);
  if (std::count(mask.begin(), mask.end(), 255) < kFewestPixels) return std::nullopt;
  if (NearestDepth(depth, mask) < kNearest_m) return std::nullopt;
  ObjectView view;
  view.intrinsics = stage.intrinsics;
  view.crop = *MaskWindow(mask, window);
  view.depth_m = Cut(depth.depth_m, window, view.crop);
  view.colour = Cut(SimulateColour(rendering, random), window, view.crop);
  view.mask = Cut(mask, window, view.crop);
  view.up_C = MeasuredUp(stage, random);
  view.visible_share = visible;
  return view;
}

}  // namespace

std::optional<ObjectView> RenderObjectView(const Model& model, bool any_camera, Random& random) {
  constexpr int kAttempts = 1000;
  for (int i = 0; i < kAttempts; ++i) {
    if (auto view = TryRender(model, any_camera, random)) return view;
  }
  return std::nullopt;
}

}  // namespace beckon::capture
