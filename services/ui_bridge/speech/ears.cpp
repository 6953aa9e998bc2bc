#include "services/ui_bridge/speech/ears.h"

#include <utility>

namespace beckon::ui_bridge::speech {

Ears::Ears(const EarsConfig& config, RunLoop& loop, Callbacks callbacks)
    : callbacks_(std::move(callbacks)),
      segmenter_(config.segmenter),
      gate_(config.echo),
      listener_(config.recogniser, loop, {.heard = callbacks_.heard, .failed = callbacks_.failed}),
      source_(config.source, loop,
              {.samples = [this](std::span<const int16_t> samples) { Take(samples); },
               .state = callbacks_.microphone}) {}

void Ears::Take(std::span<const int16_t> samples) {
  rest_.insert(rest_.end(), samples.begin(), samples.end());
  size_t at = 0;
  for (; at + kSamplesPerFrame <= rest_.size(); at += kSamplesPerFrame)
    TakeFrame({rest_.data() + at, kSamplesPerFrame});
  rest_.erase(rest_.begin(), rest_.begin() + static_cast<ptrdiff_t>(at));
}

void Ears::TakeFrame(std::span<const int16_t> frame) {
  const int64_t now = segmenter_.frames();
  const bool was_speaking = segmenter_.speaking();
  auto segment = segmenter_.Push(frame, gate_.Expected_dB(now));
  gate_.Observe(now, segmenter_.level_dB(), segmenter_.floor_dB());
  if (!was_speaking && segmenter_.speaking()) callbacks_.speaking();
  if (!segment) return;
  if (segment->ended) ++segments_;
  listener_.Hear(*std::move(segment));
}

}  // namespace beckon::ui_bridge::speech
