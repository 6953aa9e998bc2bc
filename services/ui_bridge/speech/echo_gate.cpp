#include "services/ui_bridge/speech/echo_gate.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/ui_bridge/speech/segmenter.h"

namespace beckon::ui_bridge::speech {
namespace {

constexpr int kLearnEvery = 5;  // frames
constexpr double kEverything_dB = 100;
constexpr int kSlack = 3;         // frames by which levels may be misaligned
constexpr int kLongestTail = 40;  // frames
constexpr double kMostSpread_dB = 8;
constexpr double kMostDeviation_dB = 25;  // of a frame: more is somebody talking over it

double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

std::vector<double> Levels_dB(const std::vector<int16_t>& samples) {
  std::vector<double> levels;
  LevelMeter meter;
  for (size_t i = 0; i + kSamplesPerFrame <= samples.size(); i += kSamplesPerFrame) {
    levels.push_back(meter.Push({samples.data() + i, kSamplesPerFrame}));
  }
  return levels;
}

void EchoGate::Start(std::vector<double> levels_dB, int64_t now) {
  reference_dB_ = std::move(levels_dB);
  loudest_dB_ = reference_dB_.empty() ? kNoLevel_dB : *std::ranges::max_element(reference_dB_);
  start_ = now;
  end_ = now + static_cast<int64_t>(reference_dB_.size());
  started_ = true;
  heard_.clear();
  since_learning_ = 0;
}

void EchoGate::Stop(int64_t now) {
  if (!started_ || now >= end_) return;
  // What was handed to the sound card is still played.
  end_ = std::min(end_, now + config_.most_delay);
}

bool EchoGate::Playing(int64_t now) const {
  return started_ && now >= start_ && now < end_ + config_.most_delay + kLongestTail;
}

double EchoGate::Expected_dB(int64_t now) const {
  if (!Playing(now)) return kNoLevel_dB;
  if (!gain_dB_) return kEverything_dB;
  double expected = kNoLevel_dB;
  for (int64_t back = -kSlack; back <= kLongestTail; ++back) {
    const int64_t index = now - start_ - delay_ - back;
    if (index < 0 || index >= end_ - start_ || index >= static_cast<int64_t>(reference_dB_.size()))
      continue;
    const double faded = reference_dB_[static_cast<size_t>(index)] -
                         config_.tail_dB * static_cast<double>(std::max<int64_t>(0, back - kSlack));
    expected = std::max(expected, faded);
  }
  if (expected <= kNoLevel_dB) return kNoLevel_dB;
  return expected + *gain_dB_ + config_.margin_dB + 2 * spread_dB_;
}

void EchoGate::Observe(int64_t now, double level_dB, double floor_dB) {
  // The echo may not have come yet: quiet frames would teach that there is none.
  if (!Playing(now) || now >= end_ || now - start_ < config_.most_delay) return;
  // Frames that are no louder than the room say only that the echo is soft.
  heard_.push_back({now - start_, std::max(level_dB, floor_dB)});
  if (heard_.size() > static_cast<size_t>(config_.learnt_frames)) heard_.pop_front();
  if (++since_learning_ < kLearnEvery) return;
  since_learning_ = 0;
  Learn();
}

/// The delay at which the microphone follows the prompt best: where the difference of their levels
/// varies least.
void EchoGate::Learn() {
  std::optional<double> least;
  for (int delay = 0; delay <= config_.most_delay; ++delay) {
    std::vector<double> differences;
    for (const auto& [index, level_dB] : heard_) {
      const int64_t at = index - delay;
      if (at < 0 || at >= static_cast<int64_t>(reference_dB_.size())) continue;
      const double played = reference_dB_[static_cast<size_t>(at)];
      if (played > loudest_dB_ - config_.loud_dB) differences.push_back(level_dB - played);
    }
    if (differences.size() < static_cast<size_t>(config_.fewest_frames)) continue;
    const double middle = Median(differences);
    double deviation = 0;
    for (double& difference : differences) {
      difference = std::min(std::abs(difference - middle), kMostDeviation_dB);
      deviation += difference / static_cast<double>(differences.size());
    }
    if (least && deviation >= *least) continue;
    least = deviation;
    gain_dB_ = middle;
    spread_dB_ = std::min(Median(differences), kMostSpread_dB);
    delay_ = delay;
  }
}

}  // namespace beckon::ui_bridge::speech
