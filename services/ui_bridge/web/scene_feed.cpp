#include "services/ui_bridge/web/scene_feed.h"

#include <algorithm>
#include <utility>

#include "services/ui_bridge/web/page_state.h"

namespace beckon::ui_bridge::web {

void SceneFeed::OnScene(const msg::Scene& scene) {
  scene_ = scene;
  // What no page draws need not be kept.
  for (auto& object : scene_->objects) {
    object.points_C = {};
    object.rim_C = {};
  }
  renewed_ = true;
}

void SceneFeed::OnPoses(const msg::Poses& poses) {
  poses_ = poses;
  renewed_ = true;
}

void SceneFeed::OnFrame(msg::Frame frame) {
  if (frame.colour_codec == msg::ColourCodec::kNone || frame.colour.empty()) {
    image_.reset();
    image_type_.clear();
    image_seq_.reset();
    return;
  }
  const auto& bytes = frame.colour;
  const bool same = image_ && std::ranges::equal(*image_, bytes, {},
                                                 [](char c) { return static_cast<uint8_t>(c); });
  if (same) return;
  image_type_ = frame.colour_codec == msg::ColourCodec::kPng ? "image/png" : "image/jpeg";
  image_ = std::make_shared<const std::string>(bytes.begin(), bytes.end());
  image_seq_ = frame.seq;
}

bool SceneFeed::Refresh() {
  bool changed = std::exchange(frame_seq_, image_seq_) != image_seq_;
  if (!scene_ || !std::exchange(renewed_, false)) return changed;
  nlohmann::ordered_json json = ToJson(*scene_, poses_ ? &*poses_ : nullptr);
  if (!json_.is_null()) json["seq"] = json_["seq"];
  if (json != json_) {
    json["seq"] = scene_->seq;
    json_ = std::move(json);
    changed = true;
  }
  return changed;
}

}  // namespace beckon::ui_bridge::web
