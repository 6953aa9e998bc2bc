#include "services/ui_bridge/scan/contact.h"

namespace beckon::ui_bridge::scan {

void Contact::OnEdge(Utime now, bool raw_down) {
  if (raw_down == raw_) return;
  raw_ = raw_down;
  if (!last_edge_at_ || now - *last_edge_at_ >= debounce_us_) burst_at_ = now;
  last_edge_at_ = now;
}

std::optional<Contact::Change> Contact::Settle(Utime now) {
  if (raw_ == down_ || now - *last_edge_at_ < debounce_us_) return {};
  down_ = raw_;
  if (down_) pressed_at_ = burst_at_;
  return Change{down_, burst_at_};
}

std::optional<Utime> Contact::NextDeadline() const {
  if (raw_ == down_) return {};
  return *last_edge_at_ + debounce_us_;
}

void Contact::Reset() {
  down_ = raw_ = false;
  last_edge_at_.reset();
}

Utime Contact::Held_us(Utime now) const {
  if (!down_) return 0;
  return (raw_ ? now : burst_at_) - pressed_at_;
}

}  // namespace beckon::ui_bridge::scan
