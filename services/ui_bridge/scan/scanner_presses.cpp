// The presses: which of them count, and what holding on makes of them.
#include <algorithm>
#include <utility>

#include "services/ui_bridge/scan/scanner.h"

namespace beckon::ui_bridge::scan {

std::vector<Action> Scanner::OnSwitch(Utime now, Switch which, bool down) {
  now = Forward(now);
  Settle(now);
  Of(which).contact.OnEdge(now, down);
  Settle(now);
  return Done(now);
}

std::vector<Action> Scanner::OnClick(Utime now, Switch which) {
  now = Forward(now);
  Settle(now);
  Press& press = Of(which);
  if (!press.contact.down()) {
    BeginPress(now, which);
    // Keys repeat while they are held: the window lasts until they no longer do.
    last_press_ended_ = now;
    if (press.state == Press::State::kLive && config_.method != Method::kInverse) {
      press.state = Press::State::kVoid;
      Count(now, which, config_.hold_us);
    }
    press.state = Press::State::kVoid;
  }
  return Done(now);
}

void Scanner::ReleaseAll(Utime now) {
  now = Forward(now);
  for (Press& press : presses_) {
    press.contact.Reset();
    press.state = Press::State::kVoid;
    if (std::exchange(press.advances, false)) EnterLevel(now, level_);
  }
  UpdateRest(now);
}

Utime Scanner::Forward(Utime now) { return now_ = std::max(now_, now); }

std::vector<Action> Scanner::Done(Utime now) {
  UpdateRest(now);
  return std::exchange(actions_, {});
}

void Scanner::Settle(Utime now) {
  for (const Switch which : {Switch::kMain, Switch::kSelect}) {
    CheckHolds(now, which);
    const auto change = Of(which).contact.Settle(now);
    if (!change) continue;
    if (change->down) {
      BeginPress(change->at, which);
      CheckHolds(now, which);
    } else {
      EndPress(now, change->at, which);
    }
  }
}

void Scanner::BeginPress(Utime at, Switch which) {
  Press& press = Of(which);
  const Press& other = Of(which == Switch::kMain ? Switch::kSelect : Switch::kMain);
  const bool repeat = last_press_ended_ && at - *last_press_ended_ < config_.ignore_repeat_us;
  const bool carried = press.closed_at_page && at <= shown_at_;
  const bool early = at < shown_at_ + config_.guard_us;
  press.state = repeat || early || carried || other.contact.down() ? Press::State::kVoid
                                                                   : Press::State::kLive;
  press.began = at;
  press.advances = false;
  press.stops_from = at;
}

void Scanner::EndPress(Utime now, Utime at, Switch which) {
  Press& press = Of(which);
  if (press.state == Press::State::kVoid && !press.advances) return;
  last_press_ended_ = at;
  const auto state = std::exchange(press.state, Press::State::kVoid);
  if (std::exchange(press.advances, false)) return EndAdvancing(now);
  const Utime length_us = at - press.began;
  if (state == Press::State::kLive && length_us >= config_.hold_us) Count(now, which, length_us);
}

/// What comes next of a press that is held on; nothing for one that is up.
std::optional<Scanner::Hold> Scanner::NextHold(Switch which) const {
  const Press& press = Of(which);
  if (!press.contact.down()) return {};
  std::optional<Hold> next;
  const auto take = [&next](Hold::What what, Utime at) {
    if (!next || at < next->at) next = {what, at};
  };
  const bool live = press.state == Press::State::kLive;
  const bool inverse = config_.method == Method::kInverse;
  if (live && inverse && which == Switch::kMain && !press.advances && !paused_ && Entries() > 0) {
    take(Hold::What::kAdvance, press.began + config_.hold_us);
  }
  if (live && !inverse && config_.accept == Accept::kPress && !LongPressChooses()) {
    take(Hold::What::kCount, press.began + config_.hold_us);
  }
  if (stopped_ && config_.resume_by == ResumeBy::kHold) {
    if (live) take(Hold::What::kResume, press.began + config_.resume_hold_us);
  } else if (config_.stop_hold_us > 0 && press.stops_from) {
    take(Hold::What::kStop, *press.stops_from + config_.stop_hold_us);
  }
  return next;
}

void Scanner::CheckHolds(Utime now, Switch which) {
  while (const auto hold = NextHold(which)) {
    if (hold->at > Of(which).began + Of(which).contact.Held_us(now)) return;
    OnHold(now, hold->what, which);
  }
}

void Scanner::OnHold(Utime now, Hold::What what, Switch which) {
  Press& press = Of(which);
  switch (what) {
    case Hold::What::kAdvance:
      press.advances = true;
      press.stops_from.reset();
      return Light(now, 0);
    case Hold::What::kCount:
      press.state = Press::State::kCounted;
      Count(now, which, config_.hold_us);
      if (press.contact.down() && press.state == Press::State::kVoid) {
        press.state = Press::State::kCounted;  // by a page that it led to
      }
      return;
    case Hold::What::kStop:
      press.stops_from.reset();
      press.advances = false;
      last_press_ended_ = now;
      return Stop(now);
    case Hold::What::kResume:
      press.state = Press::State::kCounted;
      press.stops_from.reset();
      return Say(Action::Kind::kResume);
  }
}

bool Scanner::LongPressChooses() const {
  return config_.method == Method::kStep && config_.step_select == StepSelect::kLongPress;
}

void Scanner::Count(Utime now, Switch which, Utime length_us) {
  if (paused_) {
    paused_ = false;
    Say(Action::Kind::kWake);
    return EnterLevel(now, 0);
  }
  if (plan_.empty()) return;
  if (config_.method == Method::kStep) {
    const bool chooses = config_.step_select == StepSelect::kSecondSwitch ? which == Switch::kSelect
                         : config_.step_select == StepSelect::kLongPress
                             ? length_us >= config_.long_press_us
                             : false;
    return chooses ? Choose(now, Of(which).began) : Advance(now);
  }
  if (config_.method == Method::kAutomatic) Choose(now, Of(which).began);
}

void Scanner::EndAdvancing(Utime now) {
  if (Lit()) return Choose(now, now);
  if (ActiveLevel().parent >= 0) return Leave(now);
  EnterLevel(now, 0);
}

}  // namespace beckon::ui_bridge::scan
