#include "services/ui_bridge/speech/segmenter.h"

#include <algorithm>
#include <cmath>

namespace beckon::ui_bridge::speech {
namespace {

constexpr double kHighPass = 0.95;
constexpr size_t kRecent = 8;
constexpr double kSmooth = 0.4;  // weight of the newest frame

}  // namespace

double LevelMeter::Push(std::span<const int16_t> frame) {
  double sum = 0;
  for (const int16_t sample : frame) {
    high_ = kHighPass * (high_ + sample - sample_);
    sample_ = sample;
    sum += high_ * high_;
  }
  const double n = std::max<double>(1, static_cast<double>(frame.size()));
  return std::max(kNoLevel_dB, 10 * std::log10(sum / n / (32768.0 * 32768.0) + 1e-12));
}

std::optional<Segment> Segmenter::Push(std::span<const int16_t> frame, double echo_dB) {
  level_dB_ = meter_.Push(frame);
  FollowFloor();
  ++frames_;
  const double over = speaking_ ? config_.hold_dB : config_.onset_dB;
  const bool loud = level_dB_ > std::max(floor_dB_ + over, echo_dB);
  recent_.push_back(loud);
  if (recent_.size() > kRecent) recent_.pop_front();
  if (speaking_) {
    samples_.insert(samples_.end(), frame.begin(), frame.end());
    return Continue(loud);
  }
  before_.emplace_back(frame.begin(), frame.end());
  if (before_.size() > static_cast<size_t>(config_.before_frames)) before_.pop_front();
  if (std::ranges::count(recent_, true) >= config_.onset_frames) Begin();
  return std::nullopt;
}

/// Minimum statistics: speech has gaps, noise has none.
void Segmenter::FollowFloor() {
  smooth_dB_ = frames_ == 0 ? level_dB_ : smooth_dB_ + kSmooth * (level_dB_ - smooth_dB_);
  smooth_.push_back(smooth_dB_);
  if (smooth_.size() > static_cast<size_t>(config_.floor_frames)) smooth_.pop_front();
  floor_dB_ = std::max(config_.quietest_dB, *std::ranges::min_element(smooth_));
}

void Segmenter::Begin() {
  speaking_ = true;
  paused_ = false;
  quiet_frames_ = 0;
  loud_frames_ = static_cast<int>(std::ranges::count(recent_, true));
  begin_frame_ = frames_ - static_cast<int64_t>(before_.size());
  samples_.clear();
  for (const auto& frame : before_) samples_.insert(samples_.end(), frame.begin(), frame.end());
  loud_end_ = static_cast<int>(before_.size());
  const auto first = std::ranges::find(recent_, true) - recent_.begin();
  loud_begin_ = std::max(0, loud_end_ - static_cast<int>(recent_.size()) + static_cast<int>(first));
  before_.clear();
}

std::optional<Segment> Segmenter::Continue(bool loud) {
  loud_frames_ += loud ? 1 : 0;
  quiet_frames_ = loud ? 0 : quiet_frames_ + 1;
  if (loud) {
    paused_ = false;
    loud_end_ = static_cast<int>(frames_ - begin_frame_);
  }
  const bool cut = frames_ - begin_frame_ >= config_.longest_frames;
  if (cut || quiet_frames_ >= config_.end_frames) {
    speaking_ = false;
    recent_.clear();
    if (loud_frames_ < config_.shortest_frames) return std::nullopt;
    return Said(/*ended=*/true, cut);
  }
  if (quiet_frames_ >= config_.pause_frames && !paused_ &&
      loud_frames_ >= config_.shortest_frames) {
    paused_ = true;
    return Said(/*ended=*/false, /*cut=*/false);
  }
  return std::nullopt;
}

Segment Segmenter::Said(bool ended, bool cut) const {
  return {begin_frame_, samples_, loud_begin_, loud_end_, ended, cut};
}

}  // namespace beckon::ui_bridge::speech
