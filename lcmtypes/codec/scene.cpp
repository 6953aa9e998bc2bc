// SCENE: the table and the objects on it.
#include <beckon/scene_t.hpp>
#include <cmath>

#include "lcmtypes/codec.h"
#include "lcmtypes/codec/message.h"
#include "lcmtypes/codec/parts.h"

namespace beckon {
namespace codec {

constexpr int kMaxVertices = 256;
constexpr int kMaxSamples = 4096;
constexpr double kPointUnit_m = 1e-4;
constexpr double kMaxReach_m = 32767 * kPointUnit_m;

static void Walk(Walker& w, const scene_object_t*) {
  w.Skip(4);
  w.String("category", kMaxName);
  w.Skip(4 + 1);
  const int32_t probabilities = w.Count("n_probabilities", kMaxOptions);
  for (int32_t i = 0; i < probabilities && w.ok(); ++i) {
    w.String("category", kMaxName);
    w.Skip(4);
  }
  w.Skip(3 * 8 + 3 * 8 + 4 + 8);
  w.Skip(static_cast<size_t>(w.Count("n_samples", kMaxSamples)) * 6);
  w.Skip(3 * 8);
  w.Skip(static_cast<size_t>(w.Count("n_rim", kMaxRim)) * (6 + 1));
  w.Skip(static_cast<size_t>(w.Count("n_outline", kMaxVertices)) * 4);
}

static void Walk(Walker& w, const scene_t*) {
  w.Skip(3 * 8);
  w.String("source", kMaxText);
  w.Skip(4 + 4 + 4 * 8 + 1 + 7 * 8);
  w.Skip(static_cast<size_t>(w.Count("n_table", kMaxVertices)) * 16);
  const int32_t objects = w.Count("n_objects", msg::kMaxObjects);
  for (int32_t i = 0; i < objects && w.ok(); ++i)
    Walk(w, static_cast<const scene_object_t*>(nullptr));
  w.Skip(4 + 4);
  Walk(w, static_cast<const seal_t*>(nullptr));
}

/// Samples and rim travel as offsets from the first of them.
static Eigen::Vector3d Origin(const msg::SceneObject& object) {
  if (!object.points_C.empty()) return object.points_C.front().cast<double>();
  if (!object.rim_C.empty()) return object.rim_C.front().point.cast<double>();
  return Eigen::Vector3d::Zero();
}

/// Whether what stands for `p` is within reach of an offset; half a unit is what rounding may add
/// on the way.
static bool Reaches(const Eigen::Vector3d& origin, const Eigen::Vector3f& p) {
  return p.allFinite() &&
         (p.cast<double>() - origin).cwiseAbs().maxCoeff() <= kMaxReach_m + kPointUnit_m;
}

static std::vector<int16_t> ToCounts(const Eigen::Vector3d& origin, const Eigen::Vector3f& p) {
  std::vector<int16_t> counts;
  for (int i = 0; i < 3; ++i) {
    counts.push_back(static_cast<int16_t>(
        std::clamp(std::lround((p[i] - origin[i]) / kPointUnit_m), -32767L, 32767L)));
  }
  return counts;
}

static Eigen::Vector3f FromCounts(const Eigen::Vector3d& origin, double unit_m,
                                  const std::vector<int16_t>& counts) {
  return (origin + Eigen::Vector3d(counts[0], counts[1], counts[2]) * unit_m).cast<float>();
}

static Status Check(const msg::SceneObject& object) {
  Rules rules("scene object");
  rules.Range(object.id, "id", 1, 1e9)
      .Name(object.category, "category")
      .Range(object.confidence, "confidence", 0, 1)
      .Count(object.probabilities.size(), "probabilities", kMaxOptions)
      .Require(Finite(object.centroid_W) && object.centroid_W.norm() < 1000,
               "centroid_W is not a place")
      .Require(Finite(object.extent_W) && (object.extent_W.array() >= 0).all(),
               "extent_W is not a size")
      .Require(object.n_points >= 0, "n_points is negative")
      .Count(object.points_C.size(), "points_C", kMaxSamples)
      .Count(object.rim_C.size(), "rim_C", kMaxRim)
      .Count(object.outline_px.size(), "outline_px", kMaxVertices);
  for (const auto& p : object.probabilities) {
    rules.Name(p.category, "category").Range(p.probability, "probability", 0, 1);
  }
  const Eigen::Vector3d origin = Origin(object);
  for (const auto& p : object.points_C) {
    rules.Require(Reaches(origin, p), "points_C spans more than 3 m or is not finite");
  }
  for (const auto& rim : object.rim_C) {
    rules.Require(Reaches(origin, rim.point), "rim_C is more than 3 m off or is not finite")
        .Range(static_cast<int>(rim.beyond), "rim_beyond", scene_object_t::BEYOND_UNKNOWN,
               scene_object_t::BEYOND_IMAGE_BORDER);
  }
  return rules;
}

static Status Check(const msg::Scene& scene) {
  Rules rules("scene");
  rules.Time(scene.utime)
      .Require(scene.seq >= 1 && scene.frame_seq >= 1, "seq is below 1")
      .Text(scene.source, "source")
      .Range(scene.width, "width", 1, 4096)
      .Range(scene.height, "height", 1, 4096)
      .Require(Validate(scene.intrinsics))
      .Require(Sane(scene.X_WC), "X_WC is not a pose")
      .Count(scene.table_W.size(), "table_W", kMaxVertices)
      .Count(scene.objects.size(), "objects", msg::kMaxObjects)
      .Require(scene.has_table || scene.objects.empty(), "objects without a table")
      .Range(scene.segmentation_ms, "segmentation_ms", 0, 1e9)
      .Range(scene.categorisation_ms, "categorisation_ms", 0, 1e9)
      .Require(Check(scene.seal));
  for (const auto& vertex : scene.table_W) rules.Require(Finite(vertex), "table_W is not finite");
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    rules.Require(Check(scene.objects[i]));
    for (size_t j = 0; j < i; ++j) {
      rules.Require(scene.objects[i].id != scene.objects[j].id, "two objects with the same id");
    }
  }
  return rules;
}

static scene_object_t ToWire(const msg::SceneObject& object) {
  scene_object_t wire{};
  wire.id = object.id;
  wire.category = object.category;
  wire.confidence = object.confidence;
  wire.ask_user = object.ask_user;
  wire.n_probabilities = static_cast<int32_t>(object.probabilities.size());
  for (const auto& p : object.probabilities) {
    category_probability_t probability{};
    probability.category = p.category;
    probability.probability = p.probability;
    wire.probabilities.push_back(probability);
  }
  ToArray(object.centroid_W, wire.centroid_W);
  ToArray(object.extent_W, wire.extent_W);
  wire.n_points = object.n_points;
  wire.point_unit_m = kPointUnit_m;
  const Eigen::Vector3d origin = Origin(object);
  ToArray(origin, wire.points_origin_C);
  wire.n_samples = static_cast<int32_t>(object.points_C.size());
  for (const auto& p : object.points_C) wire.points_C.push_back(ToCounts(origin, p));
  wire.n_rim = static_cast<int32_t>(object.rim_C.size());
  for (const auto& rim : object.rim_C) {
    wire.rim_C.push_back(ToCounts(origin, rim.point));
    wire.rim_beyond.push_back(static_cast<int8_t>(rim.beyond));
  }
  wire.n_outline = static_cast<int32_t>(object.outline_px.size());
  for (const auto& vertex : object.outline_px) wire.outline_px.push_back({vertex[0], vertex[1]});
  return wire;
}

static scene_t ToWire(const msg::Scene& scene) {
  scene_t wire{};
  wire.utime = scene.utime;
  wire.seq = scene.seq;
  wire.frame_seq = scene.frame_seq;
  wire.source = scene.source;
  wire.width = scene.width;
  wire.height = scene.height;
  wire.fx = scene.intrinsics.fx;
  wire.fy = scene.intrinsics.fy;
  wire.cx = scene.intrinsics.cx;
  wire.cy = scene.intrinsics.cy;
  wire.has_table = scene.has_table;
  PoseToArrays(scene.X_WC, wire.X_WC_position, wire.X_WC_rotation);
  wire.n_table = static_cast<int32_t>(scene.table_W.size());
  for (const auto& vertex : scene.table_W) wire.table_W.push_back({vertex.x(), vertex.y()});
  wire.n_objects = static_cast<int32_t>(scene.objects.size());
  for (const auto& object : scene.objects) wire.objects.push_back(ToWire(object));
  wire.segmentation_ms = scene.segmentation_ms;
  wire.categorisation_ms = scene.categorisation_ms;
  wire.seal = ToWire(scene.seal);
  return wire;
}

static Result<msg::SceneObject> FromWire(const scene_object_t& wire) {
  if (!IsBool(wire.ask_user)) return Error{"ask_user is neither 0 nor 1"};
  if (!(wire.point_unit_m > 0 && wire.point_unit_m <= kPointUnit_m))
    return Error{"point_unit_m is out of range"};
  msg::SceneObject object;
  object.id = wire.id;
  object.category = wire.category;
  object.confidence = wire.confidence;
  object.ask_user = wire.ask_user != 0;
  for (const auto& p : wire.probabilities)
    object.probabilities.push_back({p.category, p.probability});
  object.centroid_W = FromArray(wire.centroid_W);
  object.extent_W = FromArray(wire.extent_W);
  object.n_points = wire.n_points;
  const Eigen::Vector3d origin = FromArray(wire.points_origin_C);
  object.points_C.reserve(wire.points_C.size());
  for (const auto& p : wire.points_C) {
    object.points_C.push_back(FromCounts(origin, wire.point_unit_m, p));
  }
  for (size_t i = 0; i < wire.rim_C.size(); ++i) {
    object.rim_C.push_back({FromCounts(origin, wire.point_unit_m, wire.rim_C[i]),
                            static_cast<Beyond>(wire.rim_beyond[i])});
  }
  for (const auto& vertex : wire.outline_px) object.outline_px.push_back({vertex[0], vertex[1]});
  return object;
}

static Result<msg::Scene> FromWire(const scene_t& wire) {
  if (!IsBool(wire.has_table)) return Error{"has_table is neither 0 nor 1"};
  const auto X_WC = PoseFromArrays(wire.X_WC_position, wire.X_WC_rotation);
  if (!X_WC) return X_WC.error();
  msg::Scene scene;
  scene.utime = wire.utime;
  scene.seq = wire.seq;
  scene.frame_seq = wire.frame_seq;
  scene.source = wire.source;
  scene.width = wire.width;
  scene.height = wire.height;
  scene.intrinsics = {wire.fx, wire.fy, wire.cx, wire.cy};
  scene.has_table = wire.has_table != 0;
  scene.X_WC = *X_WC;
  for (const auto& vertex : wire.table_W) scene.table_W.emplace_back(vertex[0], vertex[1]);
  for (const auto& object : wire.objects) {
    auto converted = FromWire(object);
    if (!converted) return converted.error();
    scene.objects.push_back(*std::move(converted));
  }
  scene.segmentation_ms = wire.segmentation_ms;
  scene.categorisation_ms = wire.categorisation_ms;
  scene.seal = FromWire(wire.seal);
  return scene;
}

}  // namespace codec

BECKON_DEFINE_CODEC(Scene, scene_t)

}  // namespace beckon
