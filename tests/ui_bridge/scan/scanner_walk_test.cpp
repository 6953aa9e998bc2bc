// Any presses at any time, in every way of scanning: what must hold, holds.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/ui_bridge/scan/rig.h"

namespace beckon::ui_bridge::scan {
namespace {

class Walk {
 public:
  explicit Walk(unsigned seed) : engine_(seed), rig_(DrawConfig()) {}

  /// What went wrong; empty where nothing did.
  std::string Run() {
    for (int step = 0; step < 400 && wrong_.empty(); ++step) OneStep();
    return wrong_;
  }
  int chosen() const { return chosen_; }
  int stops() const { return stops_; }

 private:
  Utime Draw(Utime lo, Utime hi) {
    return lo + static_cast<Utime>(engine_() % static_cast<uint64_t>(hi - lo + 1));
  }
  bool OneIn(unsigned n) { return engine_() % n == 0; }

  Config DrawConfig() {
    Config config;
    config.method = static_cast<Method>(engine_() % 3);
    config.step_select = static_cast<StepSelect>(engine_() % 3);
    config.grouping = static_cast<Grouping>(engine_() % 3);
    config.back = static_cast<Back>(engine_() % 2);
    config.accept = static_cast<Accept>(engine_() % 2);
    config.resume_by = static_cast<ResumeBy>(engine_() % 2);
    config.order = static_cast<Order>(engine_() % 2);
    config.scan_us = Draw(50, 2000) * kMs;
    config.first_us = Draw(0, 1000) * kMs;
    config.hold_us = OneIn(2) ? 0 : Draw(0, 300) * kMs;
    config.ignore_repeat_us = OneIn(2) ? 0 : Draw(0, 500) * kMs;
    config.debounce_us = OneIn(3) ? 0 : Draw(0, 20) * kMs;
    config.guard_us = OneIn(2) ? 0 : Draw(0, 300) * kMs;
    config.dwell_us = Draw(50, 2000) * kMs;
    config.long_press_us = Draw(350, 900) * kMs;
    config.rounds = static_cast<int>(Draw(0, 3));
    config.group_passes = static_cast<int>(Draw(1, 2));
    return config;
  }

  void OneStep() {
    const Utime before = rig_.now;
    switch (engine_() % 8) {
      case 0:
        rig_.Wait(Draw(0, 5000) * kMs);
        break;
      case 1:
        rig_.Wait(Draw(0, 3) * kMs);
        break;
      case 2:
        return OneIn(2) ? ShowAnother() : Conversation();
      case 3:
        rig_.now += Draw(0, 3000) * kMs;  // busy elsewhere: no tick
        break;
      default:
        Edge();
    }
    Check(before);
  }

  void ShowAnother() {
    Page page;
    page.id = ++page_id_;
    page.n_options = static_cast<int>(Draw(0, 9));
    page.none_last = OneIn(2);
    for (int i = 0; i < page.n_options; ++i) page.probabilities.push_back(engine_() % 10);
    for (const Control control :
         {Control::kUndo, Control::kNone, Control::kPause, Control::kStop}) {
      if (OneIn(3)) page.controls.push_back(control);
    }
    rig_.Show(page);
    shown_at_[page_id_] = rig_.now;
    Look();
  }

  void Conversation() {
    rig_.scanner.SetStopped(rig_.now, OneIn(4));
    may_resume_ = rig_.scanner.stopped();
    Look();
  }

  void Edge() {
    const Switch which = OneIn(3) ? Switch::kSelect : Switch::kMain;
    bool& down = down_[which == Switch::kMain ? 0 : 1];
    if (OneIn(10)) {
      rig_.Click(which);
      pressed_ever_ = rig_.now;
      return;
    }
    down = !down;
    if (down) pressed_ever_ = rig_.now;
    down ? rig_.Down(which) : rig_.Up(which);
  }

  /// Checks all that happened since the last call, against what was lit before each.
  void Check(Utime before) {
    for (; seen_ < rig_.actions.size(); ++seen_) {
      const auto& [at, action] = rig_.actions[seen_];
      const View was = At(action);
      switch (action.kind) {
        case Action::Kind::kChoose:
          ++chosen_;
          if (++answers_[action.page] > 1) Fail("a page was answered twice");
          if (action.page != page_id_) Fail("a page that is gone was answered");
          if (pressed_ever_ < shown_at_[action.page]) Fail("answered by no press of its own");
          break;
        case Action::Kind::kStop:
          ++stops_;
          break;
        case Action::Kind::kResume:
          if (!was.stopped) Fail("resumed what was not stopped");
          break;
        default:
          break;
      }
    }
    Look();
    if (const auto due = rig_.scanner.NextDeadline(); due && *due < before - 60 * kSecond) {
      Fail("a deadline was left behind");
    }
  }

  View At(const Action&) const { return look_; }

  void Look() {
    look_ = rig_.scanner.view();
    if (look_.stopped && !look_.options.empty()) Fail("options are lit while stopped");
    if (look_.answered && look_.entry >= 0) Fail("something is lit after the answer");
    if (look_.paused && look_.entry >= 0) Fail("something is lit while it rests");
    if (look_.entry >= look_.entries) Fail("an entry that is none is lit");
    const bool lit = !look_.options.empty() || !look_.controls.empty() || look_.back;
    if (lit != (look_.entry >= 0)) Fail("lit entry and what it stands for do not agree");
  }

  void Fail(const std::string& what) {
    if (wrong_.empty()) wrong_ = what + " at " + std::to_string(rig_.now);
  }

  std::mt19937 engine_;
  Rig rig_;
  int64_t page_id_ = 0;
  bool down_[2] = {false, false};
  bool may_resume_ = false;
  Utime pressed_ever_ = -1;
  size_t seen_ = 0;
  View look_;
  std::map<int64_t, Utime> shown_at_;
  std::map<int64_t, int> answers_;
  int chosen_ = 0;
  int stops_ = 0;
  std::string wrong_;
};

TEST(AnyPresses, NeverBreakWhatTheScannerPromises) {
  int chosen = 0;
  int stops = 0;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    Walk walk(seed);
    ASSERT_EQ(walk.Run(), "") << "seed " << seed;
    chosen += walk.chosen();
    stops += walk.stops();
  }
  EXPECT_GT(chosen, 1000);
  EXPECT_GT(stops, 1000);
}

/// After any presses at all: hold one switch, and it stops within its time.
TEST(AnyPresses, AreFollowedByAStopWithinTheHoldTime) {
  for (unsigned seed = 0; seed < 1500; ++seed) {
    std::mt19937 engine(seed);
    Config config = PlainConfig();
    config.method = static_cast<Method>(engine() % 3);
    config.step_select = static_cast<StepSelect>(engine() % 3);
    config.grouping = static_cast<Grouping>(engine() % 3);
    config.accept = static_cast<Accept>(engine() % 2);
    config.guard_us = 100 * kMs;
    config.debounce_us = 5 * kMs;
    config.ignore_repeat_us = 200 * kMs;
    Rig rig(config);
    for (unsigned i = engine() % 12; i > 0; --i) {
      if (engine() % 3 == 0) {
        Page page = Options(static_cast<int>(engine() % 8));
        if (engine() % 2 == 0) page.controls = {Control::kUndo, Control::kPause, Control::kStop};
        rig.Show(page);
      }
      rig.Press(static_cast<Utime>(engine() % 900) * kMs);
      rig.Wait(static_cast<Utime>(engine() % 3000) * kMs);
    }
    rig.Wait(10 * kMs);
    const Utime within = StopWithin_us(rig.scanner.plan(), config);
    const int before = rig.Count(Action::Kind::kStop);
    rig.Down();
    rig.Wait(within);
    ASSERT_GT(rig.Count(Action::Kind::kStop), before) << "seed " << seed;
  }
}

/// What is lit just before a press is what the press takes.
TEST(AnyPresses, TakeOnlyWhatIsLit) {
  int taken = 0;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    std::mt19937 engine(seed);
    Config config = PlainConfig();
    config.grouping = static_cast<Grouping>(engine() % 3);
    config.method = engine() % 2 == 0 ? Method::kAutomatic : Method::kStep;
    Rig rig(config);
    Page page = Options(1 + static_cast<int>(engine() % 12));
    page.controls = {Control::kUndo, Control::kStop};
    rig.Show(page);
    for (int presses = 0; presses < 20 && rig.Chosen().empty() && !rig.scanner.stopped();
         ++presses) {
      rig.Wait(static_cast<Utime>(engine() % 4000) * kMs);
      const View before = rig.scanner.view();
      const size_t actions = rig.actions.size();
      rig.Press(50 * kMs, engine() % 2 == 0 ? Switch::kMain : Switch::kSelect);
      for (size_t i = actions; i < rig.actions.size(); ++i) {
        const Action& action = rig.actions[i].second;
        if (action.kind == Action::Kind::kChoose) {
          ASSERT_EQ(before.options, std::vector{action.option});
          ++taken;
        }
        if (action.kind == Action::Kind::kControl) {
          ASSERT_EQ(before.controls, std::vector{action.control});
        }
      }
    }
  }
  EXPECT_GT(taken, 1000);
}

}  // namespace
}  // namespace beckon::ui_bridge::scan
