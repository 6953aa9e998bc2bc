// Fills a SCENE, within one datagram.
#include "services/perception/scene_message.h"

#include <algorithm>
#include <utility>

#include "services/base/rim.h"

namespace beckon::perception {
namespace {

constexpr size_t kMaxHull = 64;           // vertices of the table
constexpr size_t kMaxProbabilities = 12;  // categories told of one object
constexpr size_t kBytesOfPoint = 6;
constexpr size_t kBytesOfRimPoint = 7;
constexpr size_t kSamplesFirst = 40;  // points of an object that its rim takes no room from;
constexpr size_t kRimsPart = 2;       // of the rest it takes at most this part
constexpr size_t kMargin = 1500;      // source, table's pose, times, lengths and the seal

/// Every so many-th vertex of a hull that has too many.
std::vector<Eigen::Vector2d> TableOutline(const Perception& perception) {
  const auto& hull_C = perception.segmentation.hull_C;
  const size_t n = std::min(hull_C.size(), kMaxHull);
  std::vector<Eigen::Vector2d> outline;
  for (size_t i = 0; i < n; ++i) {
    outline.push_back((perception.X_WC * hull_C[i * hull_C.size() / n]).head<2>());
  }
  return outline;
}

/// The likeliest, made to sum to 1 again where some were left out.
std::vector<msg::CategoryProbability> Probabilities(const Categorisation& category) {
  std::vector<msg::CategoryProbability> told;
  float sum = 0;
  for (const auto& [name, probability] : category.probabilities) {
    if (told.size() == kMaxProbabilities) break;
    told.push_back({name, probability});
    sum += probability;
  }
  if (told.size() < category.probabilities.size() && sum > 0) {
    for (auto& p : told) p.probability /= sum;
  }
  return told;
}

size_t BytesWithoutPoints(const msg::SceneObject& object) {
  size_t bytes = 128 + object.category.size() + object.outline_px.size() * 4;
  for (const auto& p : object.probabilities) bytes += 9 + p.category.size();
  return bytes;
}

msg::SceneObject MakeObject(const PerceivedObject& perceived) {
  msg::SceneObject object;
  object.id = perceived.id;
  object.confidence = perceived.category.confidence;
  object.ask_user = perceived.category.ask_user;
  object.probabilities = Probabilities(perceived.category);
  if (!object.probabilities.empty()) object.category = object.probabilities.front().category;
  object.centroid_W = perceived.shape.centroid_W;
  object.extent_W = perceived.shape.extent_W;
  object.n_points = static_cast<int>(perceived.shape.pixels.size());
  object.outline_px = perceived.shape.outline_px;
  return object;
}

/// Rims and samples of as many objects as `scene` has, each within `share` bytes.
void FillPoints(const RgbdImage& image, const Perception& perception, size_t share,
                msg::Scene& scene) {
  const auto& segmentation = perception.segmentation;
  const size_t first = std::min(share, kSamplesFirst * kBytesOfPoint);
  const size_t n_rim = std::min<size_t>((share - first) / kRimsPart / kBytesOfRimPoint, kMaxRim);
  const size_t n_samples =
      std::min<size_t>((share - n_rim * kBytesOfRimPoint) / kBytesOfPoint, kMaxSamples);
  // Object k of the segmentation is the k-th that was perceived.
  auto rims = FindRims(image, segmentation.labels, static_cast<int>(scene.objects.size()),
                       segmentation.table_C, static_cast<int>(n_rim));
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    scene.objects[i].rim_C = std::move(rims[i]);
    scene.objects[i].points_C =
        SampleSurface(image, perception.objects[i].shape.pixels, static_cast<int>(n_samples));
  }
}

/// Whether a SCENE can say where the object is. What spans more than 3 m, or is a kilometre away,
/// is nothing to take; left in, it would cost the other objects of the frame their scene.
bool CanBeTold(const msg::SceneObject& object) {
  constexpr double kFarthest_m = 1000;
  constexpr float kMostReach_m = 3;
  if (!(object.centroid_W.norm() < kFarthest_m)) return false;
  std::vector<Eigen::Vector3f> points = object.points_C;
  for (const RimPoint& rim : object.rim_C) points.push_back(rim.point);
  return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3f& p) {
    return (p - points.front()).cwiseAbs().maxCoeff() <= kMostReach_m;
  });
}

}  // namespace

msg::Scene MakeScene(const RgbdImage& image, const Perception& perception) {
  msg::Scene scene;
  scene.width = image.width;
  scene.height = image.height;
  scene.intrinsics = image.intrinsics;
  scene.segmentation_ms = static_cast<float>(perception.segmentation_ms);
  scene.categorisation_ms = static_cast<float>(perception.categorisation_ms);
  scene.has_table = perception.segmentation.table_C.has_value();
  if (!scene.has_table) return scene;
  scene.X_WC = perception.X_WC;
  scene.table_W = TableOutline(perception);

  size_t bytes = kMargin + 16 * scene.table_W.size();
  const size_t n_objects =
      std::min<size_t>(perception.objects.size(), static_cast<size_t>(msg::kMaxObjects));
  for (size_t i = 0; i < n_objects; ++i) {
    scene.objects.push_back(MakeObject(perception.objects[i]));
    bytes += BytesWithoutPoints(scene.objects.back());
  }
  const size_t room = msg::kMaxDatagram > bytes ? msg::kMaxDatagram - bytes : 0;
  FillPoints(image, perception, n_objects == 0 ? 0 : room / n_objects, scene);
  std::erase_if(scene.objects, [](const msg::SceneObject& object) { return !CanBeTold(object); });
  return scene;
}

}  // namespace beckon::perception
