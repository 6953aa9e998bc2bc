// What fuzzing feeds perception: bytes that choose hostile images and settings.
#include "tests/perception/fuzz.h"

#include <algorithm>
#include <set>

#include "lcmtypes/codec.h"
#include "services/perception/perceiver.h"
#include "services/perception/scene_message.h"
#include "tests/perception/hostile_images.h"

namespace beckon::perception {
namespace {

constexpr int kReferenceWidth = 112;  // the reference is slow

/// Mostly small images, for more of them.
int AnyWidth(Draws& draws) { return draws.OneIn(4) ? 320 : 160; }

std::string Fuzz(SegmentationMethod method, Draws draws, int width) {
  SegmentationConfig config = AnyConfig(draws);
  config.method = method;
  const RgbdImage image = HostileImage(draws, width);
  const Segmentation result = Segment(image, config);
  if (std::string wrong = Unsound(image, config, result); !wrong.empty()) return wrong;
  return Same(result, Segment(image, config)) ? "" : "another result the second time";
}

/// As FRAME messages have it: never NaN, infinite or negative.
RgbdImage AsReceived(RgbdImage image) {
  for (float& depth_m : image.depth_m) {
    if (!(depth_m > 0 && depth_m <= 65535)) depth_m = 0;
  }
  return image;
}

std::string UnsoundObjects(const Perception& perception) {
  std::set<int> ids;
  for (const PerceivedObject& object : perception.objects) {
    if (object.id < 1 || !ids.insert(object.id).second) return "an id twice, or none";
    if (!object.shape.centroid_C.allFinite()) return "an object nowhere";
  }
  const auto n = static_cast<size_t>(perception.segmentation.n_objects);
  return perception.objects.size() == n ? "" : "not an object for each label";
}

}  // namespace

std::string FuzzFast(std::span<const uint8_t> bytes) {
  Draws draws(bytes);
  const int width = AnyWidth(draws);
  return Fuzz(SegmentationMethod::kFast, draws, width);
}

std::string FuzzReference(std::span<const uint8_t> bytes) {
  return Fuzz(SegmentationMethod::kReference, Draws(bytes), kReferenceWidth);
}

std::string FuzzPerceiver(std::span<const uint8_t> bytes) {
  Draws draws(bytes);
  PerceiverConfig config;
  config.segmentation = AnyConfig(draws);
  config.tracker.settle_after_frames = draws.Between(1, 3);
  Perceiver perceiver(config, nullptr);
  RgbdImage image;
  for (int frame = draws.Between(1, 5); frame > 0; --frame) {
    if (image.depth_m.empty() || !draws.OneIn(3)) {
      image = AsReceived(HostileImage(draws, AnyWidth(draws)));
    }
    const Perception perception = perceiver.Perceive(image);
    if (std::string wrong = UnsoundObjects(perception); !wrong.empty()) return wrong;
    msg::Scene scene = MakeScene(image, perception);
    scene.utime = scene.seq = scene.frame_seq = 1;
    scene.source = "fuzz";
    const auto encoded = Codec<msg::Scene>::Encode(scene);
    if (!encoded) return "no scene: " + encoded.error().message;
  }
  return "";
}

}  // namespace beckon::perception
