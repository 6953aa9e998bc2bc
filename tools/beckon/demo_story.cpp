#include "tools/beckon/demo_story.h"

#include <algorithm>
#include <utility>

namespace beckon::tool {
namespace {

constexpr size_t kKept = 8;

template <typename T>
void Keep(std::deque<T>& latest, T message) {
  latest.push_back(std::move(message));
  if (latest.size() > kKept) latest.pop_front();
}

}  // namespace

void DemoStory::OnFrame(msg::Frame frame) {
  if (!frame_) Keep(frames_, std::move(frame));
}

void DemoStory::OnScene(msg::Scene scene) {
  if (!scene_) Keep(scenes_, std::move(scene));
  if (asked_about_) ChooseScene(*asked_about_);
}

/// A still image's scenes are all alike: poses of an earlier one do until those of its own come.
void DemoStory::OnPoses(msg::Poses poses) {
  if (scene_ && poses_of_ == scene_->seq) return;
  poses_of_ = poses.scene_seq;
  poses_ = std::move(poses.poses);
}

void DemoStory::OnQuery(const msg::Query& query) {
  if (scene_ || asked_about_) return;
  asked_about_ = query.scene_seq;
  ChooseScene(query.scene_seq);
}

void DemoStory::ChooseScene(int64_t seq) {
  if (scene_) return;
  const auto scene = std::ranges::find(scenes_, seq, &msg::Scene::seq);
  if (scene == scenes_.end()) return;
  const auto frame = std::ranges::find(frames_, scene->frame_seq, &msg::Frame::seq);
  if (frame == frames_.end()) return;
  scene_ = *scene;
  frame_ = *frame;
  scenes_.clear();
  frames_.clear();
}

void DemoStory::OnEnd(const SessionRecord& record) { sessions_.push_back(record); }

}  // namespace beckon::tool
