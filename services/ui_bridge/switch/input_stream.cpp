#include "services/ui_bridge/switch/input_stream.h"

#include <linux/input.h>

#include <cstring>

namespace beckon::ui_bridge {
namespace {

constexpr size_t kEventBytes = sizeof(input_event);
constexpr int64_t kLatest_s = int64_t{1} << 33;  // the year 2242

/// Whether these bytes can be an event: bytes of any other kind nearly never look like one.
bool IsPlausible(const input_event& event) {
  if (event.input_event_sec < 0 || static_cast<int64_t>(event.input_event_sec) > kLatest_s) {
    return false;
  }
  if (event.input_event_usec < 0 || event.input_event_usec >= kSecond) return false;
  switch (event.type) {
    case EV_SYN:
      return event.code <= SYN_MAX;
    case EV_KEY:
      return event.code <= KEY_MAX && event.value >= 0 && event.value <= 2;
    case EV_REL:
      return event.code <= REL_MAX;
    case EV_ABS:
      return event.code <= ABS_MAX;
    case EV_MSC:
      return event.code <= MSC_MAX;
    case EV_SW:
      return event.code <= SW_MAX;
    case EV_LED:
      return event.code <= LED_MAX;
    case EV_SND:
      return event.code <= SND_MAX;
    case EV_REP:
      return event.code <= REP_MAX;
    default:
      return event.type <= EV_MAX && event.type >= EV_FF;
  }
}

input_event ReadEvent(const uint8_t* bytes) {
  input_event event;
  std::memcpy(&event, bytes, kEventBytes);
  return event;
}

}  // namespace

std::vector<InputEvent> InputStream::Feed(std::span<const uint8_t> bytes) {
  rest_.insert(rest_.end(), bytes.begin(), bytes.end());
  std::vector<InputEvent> events;
  size_t at = 0;
  while (rest_.size() - at >= kEventBytes) {
    const uint8_t* here = rest_.data() + at;
    const bool plausible = IsPlausible(ReadEvent(here));
    if (plausible && !in_step_) {
      // After bytes that were no event one that looks like one may be none: two in a row are.
      if (rest_.size() - at < 2 * kEventBytes) break;
      in_step_ = IsPlausible(ReadEvent(here + kEventBytes));
    }
    if (plausible && in_step_) {
      Take(events, here);
      at += kEventBytes;
    } else {
      in_step_ = false;
      ++garbage_;
      ++at;
    }
  }
  rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(at));
  return events;
}

void InputStream::Take(std::vector<InputEvent>& events, const uint8_t* bytes) {
  const input_event event = ReadEvent(bytes);
  if (event.type == EV_SYN) {
    if (event.code == SYN_DROPPED) {
      dropping_ = true;
      events.push_back({.kind = InputEvent::Kind::kLost});
    } else if (event.code == SYN_REPORT) {
      dropping_ = false;
    }
    return;
  }
  if (dropping_ || event.type != EV_KEY || event.value == 2) return;
  events.push_back({.kind = InputEvent::Kind::kKey,
                    .code = event.code,
                    .down = event.value == 1,
                    .device_us = static_cast<Utime>(event.input_event_sec) * kSecond +
                                 static_cast<Utime>(event.input_event_usec)});
}

void InputStream::Reset() {
  rest_.clear();
  dropping_ = false;
  in_step_ = true;
}

}  // namespace beckon::ui_bridge
