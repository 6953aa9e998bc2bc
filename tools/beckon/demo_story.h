// What a picture of a demo shows: what was seen, and how the first conversation went.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "lcmtypes/messages.h"
#include "tools/beckon/session_observer.h"

namespace beckon::tool {

/// Feed it what passes on the bus. It keeps the scene of the first question, with its frame and
/// poses, and little else.
class DemoStory {
 public:
  void OnFrame(msg::Frame frame);
  void OnScene(msg::Scene scene);
  void OnPoses(msg::Poses poses);
  void OnQuery(const msg::Query& query);
  void OnEnd(const SessionRecord& record);

  /// Nothing before the first question, and where its scene or frame was not heard.
  const std::optional<msg::Scene>& scene() const { return scene_; }
  const std::optional<msg::Frame>& frame() const { return frame_; }
  /// Of that scene; empty where none came.
  const std::vector<msg::ObjectPose>& poses() const { return poses_; }
  /// In the order of their ends.
  const std::vector<SessionRecord>& sessions() const { return sessions_; }

 private:
  void ChooseScene(int64_t seq);

  std::deque<msg::Frame> frames_;  // the latest
  std::deque<msg::Scene> scenes_;
  std::optional<int64_t> asked_about_;  // scene_t.seq of the first question
  std::optional<msg::Scene> scene_;
  std::optional<msg::Frame> frame_;
  std::vector<msg::ObjectPose> poses_;
  int64_t poses_of_ = 0;  // scene_t.seq
  std::vector<SessionRecord> sessions_;
};

}  // namespace beckon::tool
