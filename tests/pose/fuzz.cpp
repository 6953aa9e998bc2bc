// What fuzzing feeds the pose service: bytes that choose a hostile cloud, or a SCENE on the bus.
#include "tests/pose/fuzz.h"

#include "lcmtypes/codec.h"
#include "services/pose/service.h"
#include "tests/pose/hostile_clouds.h"

namespace beckon::pose {
namespace {

HostileCloud DamagedCloud(Draws& draws, size_t most_damages) {
  HostileCloud cloud = SoundCloud(draws);
  for (size_t n = draws.Index(most_damages + 1); n > 0; --n) {
    if (cloud.points.empty() || !cloud.table || cloud.rim.empty()) break;
    Damages()[draws.Index(Damages().size())].second(cloud, draws);
  }
  return cloud;
}

// The slow methods less often.
Method AnyMethod(Draws& draws) {
  constexpr Method kOthers[] = {Method::kMultiscale, Method::kClassic, Method::kHierarchical};
  const size_t i = draws.Index(16);
  return i < 3 ? kOthers[i] : Method::kAdaptive;
}

msg::Scene SceneOf(const std::vector<HostileCloud>& clouds) {
  msg::Scene scene{.utime = 1, .seq = 1, .frame_seq = 1, .source = "fuzz"};
  scene.width = 640;
  scene.height = 480;
  scene.has_table = true;
  for (const HostileCloud& cloud : clouds) {
    if (cloud.table) scene.X_WC = WorldFromTable(*cloud.table);
    msg::SceneObject& object = scene.objects.emplace_back();
    object.id = static_cast<int>(scene.objects.size());
    object.points_C = cloud.points;
    object.rim_C = cloud.rim;
  }
  return scene;
}

// Writes any bytes over some of the message, now and then at the same place of a length.
void Overwrite(std::vector<uint8_t>& bytes, Draws& draws) {
  for (size_t n = draws.Index(24); n > 0; --n) {
    const size_t at = draws.Index(bytes.size());
    const uint32_t value = draws();
    const size_t length = 1 + draws.Index(8);
    for (size_t i = 0; i < length && at + i < bytes.size(); ++i) {
      bytes[at + i] = static_cast<uint8_t>(value >> (8 * (i % 4)));
    }
  }
}

}  // namespace

std::string FuzzFit(std::span<const uint8_t> bytes) {
  Draws draws(bytes);
  PoseConfig config;
  config.fit.method = AnyMethod(draws);
  const HostileCloud cloud = DamagedCloud(draws, 3);
  return Unsound(EstimateObject(cloud.input(), config));
}

std::string FuzzScene(std::span<const uint8_t> bytes) {
  Draws draws(bytes);
  std::vector<HostileCloud> clouds;
  for (size_t n = 1 + draws.Index(3); n > 0; --n) clouds.push_back(DamagedCloud(draws, 1));
  auto encoded = Codec<msg::Scene>::Encode(SceneOf(clouds));
  if (!encoded) return "";
  Overwrite(*encoded, draws);
  const auto scene = Codec<msg::Scene>::Decode(*encoded);
  if (!scene) return "";
  msg::Poses poses = SceneEstimator{PoseConfig{}}.Estimate(*scene);
  poses.seq = 1;
  if (poses.poses.size() != scene->objects.size()) return "not an answer for each object";
  for (const msg::ObjectPose& pose : poses.poses) {
    if (pose.converged != pose.reason.empty()) return "no reason, or one too many: " + pose.reason;
  }
  const auto answer = Codec<msg::Poses>::Encode(poses);
  return answer ? "" : answer.error().message;
}

}  // namespace beckon::pose
