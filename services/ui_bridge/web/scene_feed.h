// What the camera sees, as the page is told it: objects, shapes and the newest picture, anew only
// when something looks different.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "lcmtypes/messages.h"

namespace beckon::ui_bridge::web {

class SceneFeed {
 public:
  void OnScene(const msg::Scene& scene);
  void OnPoses(const msg::Poses& poses);
  /// Takes the colour image; one that equals the one before is no new picture.
  void OnFrame(msg::Frame frame);

  /// Brings `json` and `frame_seq` up to date; true where that changed anything.
  bool Refresh();

  /// As of the last Refresh: null without a scene.
  const nlohmann::ordered_json& json() const { return json_; }
  const std::optional<int64_t>& frame_seq() const { return frame_seq_; }

  /// The newest; empty type and null where the camera has no colour.
  const std::string& image_type() const { return image_type_; }
  const std::shared_ptr<const std::string>& image() const { return image_; }

 private:
  std::optional<msg::Scene> scene_;
  std::optional<msg::Poses> poses_;
  bool renewed_ = false;  // since the last Refresh
  nlohmann::ordered_json json_;
  std::string image_type_;
  std::shared_ptr<const std::string> image_;
  std::optional<int64_t> image_seq_;
  std::optional<int64_t> frame_seq_;
};

}  // namespace beckon::ui_bridge::web
