// The pointer: what is lit, for how long, and what choosing it leads to.
#include "services/ui_bridge/scan/scanner.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace beckon::ui_bridge::scan {

Scanner::Scanner(const Config& config)
    : config_(config),
      presses_{Press{Contact(config.debounce_us)}, Press{Contact(config.debounce_us)}},
      now_(std::numeric_limits<Utime>::min() / 2),
      shown_at_(now_) {}

void Scanner::Show(Utime now, const Page& page) {
  now = Forward(now);
  page_ = page;
  answered_ = false;
  if (!stopped_) Activate(now);
}

void Scanner::Clear(Utime now) { Show(now, {}); }

void Scanner::SetStopped(Utime now, bool stopped) {
  now = Forward(now);
  if (stopped == stopped_) return;
  stopped_ = stopped;
  confirming_ = false;
  Activate(now);
}

void Scanner::SetConfig(Utime now, const Config& config) {
  now = Forward(now);
  config_ = config;
  for (Press& press : presses_) press.contact.SetDebounce(config.debounce_us);
  Activate(now);
}

std::vector<Action> Scanner::Tick(Utime now) {
  now = Forward(now);
  Settle(now);
  UpdateRest(now);
  if (const auto due = RestDue(); due && *due <= now) {
    if (config_.method == Method::kStep) {
      Choose(now, now);  // dwelling
    } else {
      Advance(now);
    }
  }
  return Done(now);
}

std::optional<Utime> Scanner::NextDeadline() const {
  std::optional<Utime> next = RestDue();
  const auto take = [&next](std::optional<Utime> at) {
    if (at) next = next ? std::min(*next, *at) : *at;
  };
  for (const Switch which : {Switch::kMain, Switch::kSelect}) {
    const Contact& contact = Of(which).contact;
    take(contact.NextDeadline());
    const auto hold = NextHold(which);
    if (hold && contact.raw_down()) take(hold->at);
  }
  return next;
}

View Scanner::view() const {
  View view;
  view.page = ActivePage();
  view.pressed = std::ranges::any_of(presses_, [](const Press& p) { return p.contact.down(); });
  view.paused = paused_;
  view.stopped = stopped_;
  view.confirming = confirming_;
  view.answered = answered_ && !stopped_;
  view.entries = Entries();
  if (plan_.empty()) return view;
  for (int level = level_; level > 0; level = plan_.levels[static_cast<size_t>(level)].parent) {
    ++view.depth;
  }
  if (!Lit()) return view;
  const Entry& entry = ActiveLevel().entries[static_cast<size_t>(entry_)];
  view.options = OptionsOf(plan_, entry);
  view.controls = ControlsOf(plan_, entry);
  view.back = entry.kind == Entry::Kind::kBack;
  view.group = entry.kind == Entry::Kind::kGroup;
  view.entry = entry_;
  view.dwell_us = RestOf(entry_).value_or(0);
  return view;
}

void Scanner::Activate(Utime now) {
  shown_at_ = now;
  paused_ = false;
  for (Press& press : presses_) {
    press.state = Press::State::kVoid;
    press.closed_at_page = press.contact.raw_down();
    // What was held to scan was no beginning of a stop.
    if (std::exchange(press.advances, false)) press.stops_from = now;
  }
  if (stopped_) {
    Page page;
    if (config_.resume_by == ResumeBy::kTwice) {
      page.controls = {Control::kResume, Control::kStay};
      if (confirming_) std::swap(page.controls[0], page.controls[1]);
    }
    plan_ = MakePlan(config_, page);
  } else {
    plan_ = answered_ ? Plan{} : MakePlan(config_, page_);
  }
  EnterLevel(now, 0);
  first_ = true;
}

void Scanner::EnterLevel(Utime now, int level) {
  level_ = level;
  passes_ = 0;
  const bool lit_at_once =
      config_.method == Method::kAutomatic ||
      (config_.method == Method::kStep && config_.step_select != StepSelect::kDwell);
  Light(now, lit_at_once ? 0 : -1);
}

void Scanner::Light(Utime now, int entry) {
  entry_ = entry;
  first_ = false;
  rest_ = {.left = RestOf(entry), .since = {}, .fresh = true};
  UpdateRest(now);
}

std::optional<Utime> Scanner::RestOf(int entry) const {
  if (entry < 0 || entry >= Entries()) return {};
  if (config_.method != Method::kStep) return config_.scan_us + (entry == 0 ? config_.first_us : 0);
  if (config_.step_select == StepSelect::kDwell) return config_.dwell_us;
  return {};
}

int Scanner::Entries() const {
  return plan_.empty() ? 0 : static_cast<int>(ActiveLevel().entries.size());
}

bool Scanner::AnyHeld() const {
  return std::ranges::any_of(
      presses_, [](const Press& p) { return p.contact.down() || p.contact.raw_down(); });
}

bool Scanner::PointerRuns() const {
  if (config_.method != Method::kInverse) return !AnyHeld();
  const Press& press = Of(Switch::kMain);
  return press.advances && press.contact.raw_down();
}

void Scanner::UpdateRest(Utime now) {
  if (!rest_.left) return;
  const bool runs = PointerRuns();
  if (runs == rest_.since.has_value()) return;
  if (runs) {
    rest_.since = now;
    if (std::exchange(rest_.fresh, false)) lit_at_ = now;
  } else {
    *rest_.left = std::max<Utime>(0, *rest_.left - (now - *std::exchange(rest_.since, {})));
  }
}

std::optional<Utime> Scanner::RestDue() const {
  if (!rest_.left || !rest_.since || !Lit()) return {};
  return *rest_.since + *rest_.left;
}

void Scanner::Advance(Utime now) {
  if (entry_ + 1 < Entries()) return Light(now, entry_ + 1);
  PassEnd(now);
}

void Scanner::PassEnd(Utime now) {
  const bool inner = ActiveLevel().parent >= 0;
  switch (config_.method) {
    case Method::kInverse:
      Of(Switch::kMain).stops_from = now;
      return Light(now, Entries());  // past the end: letting go chooses nothing
    case Method::kStep:
      return inner ? Leave(now) : Light(now, 0);
    case Method::kAutomatic:
      ++passes_;
      if (inner && passes_ >= config_.group_passes) return Leave(now);
      if (!inner && config_.rounds > 0 && passes_ >= config_.rounds) return RestNow();
      return Light(now, 0);
  }
}

void Scanner::Leave(Utime now) {
  Say(Action::Kind::kBack);
  EnterLevel(now, ActiveLevel().parent);
}

void Scanner::RestNow() {
  paused_ = true;
  entry_ = -1;
  rest_ = {};
  Say(Action::Kind::kRest);
}

void Scanner::Choose(Utime now, Utime pressed_at) {
  if (!Lit()) return;
  const Entry entry = ActiveLevel().entries[static_cast<size_t>(entry_)];
  const bool tells = config_.method == Method::kAutomatic && !first_ && !rest_.fresh;
  const Utime reaction_us = tells ? std::max<Utime>(0, pressed_at - lit_at_) : 0;
  switch (entry.kind) {
    case Entry::Kind::kBack:
      return Leave(now);
    case Entry::Kind::kControl:
      return ChooseControl(now, entry.control, reaction_us);
    case Entry::Kind::kGroup:
      actions_.push_back(
          {.kind = Action::Kind::kOpen, .page = ActivePage(), .reaction_us = reaction_us});
      return EnterLevel(now, entry.level);
    case Entry::Kind::kOption:
      actions_.push_back({.kind = Action::Kind::kChoose,
                          .page = ActivePage(),
                          .option = entry.option,
                          .reaction_us = reaction_us});
      answered_ = true;
      return Activate(now);
  }
}

void Scanner::ChooseControl(Utime now, Control control, Utime reaction_us) {
  switch (control) {
    case Control::kStop:
      return Stop(now);
    case Control::kPause:
      return RestNow();
    case Control::kResume:
    case Control::kStay: {
      const bool resume = control == Control::kResume && stopped_;
      if (std::exchange(confirming_, resume && !confirming_) && resume) {
        Say(Action::Kind::kResume);
      }
      return Activate(now);
    }
    default:
      actions_.push_back({.kind = Action::Kind::kControl,
                          .page = ActivePage(),
                          .control = control,
                          .reaction_us = reaction_us});
      return Activate(now);
  }
}

void Scanner::Stop(Utime now) {
  Say(Action::Kind::kStop);
  stopped_ = true;
  confirming_ = false;
  Activate(now);
}

}  // namespace beckon::ui_bridge::scan
