// Scanning: a pointer goes over what can be chosen, one or two switches choose. A machine without a
// clock: whoever owns it tells it the time, draws what View() says, and does what the returned
// Actions say.
//
// How to use it:
//   Scanner scanner(config);                          // after Validate(config)
//   scanner.Show(now, page);                          // a question, or controls alone
//   for (const Action& a : scanner.OnSwitch(now, Switch::kMain, true)) Do(a);   // key down, key up
//   ... call Tick(*scanner.NextDeadline()) at that time, and ask for the next one after every call;
//   draw scanner.view() when it differs from what was drawn.
//
// `now` is a steady clock's, in microseconds; what goes back is taken as standing still. Being late
// does no harm: the pointer never passes more than one entry at a time, and a press means what was
// lit until then.
//
// What it promises:
// - Nothing is chosen but what is lit, and by a press that began after the page was shown (and
//   `guard_us` after it): a press carried over from the page before chooses nothing.
// - From a page at most one option is chosen; then nothing is lit until the next Show.
// - A switch held for StopWithin_us of the plan is a stop, in every state: answered, paused, with
//   nothing to choose, and in a press that counts for nothing else.
// - After a stop nothing but "resume" can be chosen until the owner calls SetStopped(false).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "services/ui_bridge/scan/contact.h"
#include "services/ui_bridge/scan/plan.h"

namespace beckon::ui_bridge::scan {

/// kSelect chooses where Method::kStep has StepSelect::kSecondSwitch; else both do the same, but
/// Method::kInverse scans by kMain only.
enum class Switch { kMain, kSelect };

/// What a press, or time, led to.
struct Action {
  enum class Kind {
    kChoose,   // `option` of the page
    kControl,  // `control`, one of the page's; never kStop, kPause, kResume, kStay
    kStop,     // at once, by holding or by choosing it
    kResume,   // deliberately, after a stop
    kOpen,     // a group was opened: for who speaks it or counts
    kBack,     // a group was left without a choice
    kRest,     // scanning rests until a press: `rounds` are over, or "pause" was chosen
    kWake      // and goes on
  };
  Kind kind = Kind::kChoose;
  int64_t page = 0;                  // Page::id; 0 of the page that stands while stopped
  int option = -1;                   // of kChoose
  Control control = Control::kUndo;  // of kControl
  /// From lit to press, of kChoose, kControl and kOpen by Method::kAutomatic; 0 where it says
  /// nothing of the user's speed: on a page's first entry, where reading is included.
  Utime reaction_us = 0;

  bool operator==(const Action&) const = default;
};

/// What is to be drawn.
struct View {
  int64_t page = 0;
  std::vector<int> options;       // that a press would take, or that the lit group holds
  std::vector<Control> controls;  // likewise
  bool back = false;              // "back" is lit
  bool group = false;             // what is lit is a group
  bool pressed = false;           // a switch is held
  bool paused = false;            // it rests until a press
  bool stopped = false;
  bool confirming = false;  // stopped, and "resume" was chosen once
  bool answered = false;    // an option of this page was chosen
  int entry = -1;           // of the level that is scanned, from 0; -1 = nothing is lit
  int entries = 0;
  int depth = 0;       // 0 = the outermost level
  Utime dwell_us = 0;  // for which this is lit; 0 = until a press

  bool operator==(const View&) const = default;
};

/// Not thread-safe.
class Scanner {
 public:
  /// `config` as Validate takes it.
  explicit Scanner(const Config& config);

  /// Replaces what there was to choose. Presses that are held already are void.
  void Show(Utime now, const Page& page);
  /// Nothing to choose; holding still stops.
  void Clear(Utime now);
  /// What the conversation says: true as after Action::kStop, false leads out of it. The page
  /// shown last stands again.
  void SetStopped(Utime now, bool stopped);
  /// Takes effect at once; the page starts again.
  void SetConfig(Utime now, const Config& config);

  /// A switch closed or opened, as its contacts say, bounce and all; the same twice is once.
  std::vector<Action> OnSwitch(Utime now, Switch which, bool down);
  /// A press of a device that tells no release (a terminal's key): begins and ends at once, and
  /// is long enough to count.
  std::vector<Action> OnClick(Utime now, Switch which);
  /// The device is gone: what was held is up and chooses nothing.
  void ReleaseAll(Utime now);
  std::vector<Action> Tick(Utime now);
  /// When to call Tick; nothing = not before something else happens.
  std::optional<Utime> NextDeadline() const;

  View view() const;
  const Config& config() const { return config_; }
  /// What is scanned now.
  const Plan& plan() const { return plan_; }
  bool stopped() const { return stopped_; }

 private:
  struct Press {
    enum class State { kVoid, kLive, kCounted };
    Contact contact;
    State state = State::kVoid;  // kLive: may still choose or move
    Utime began = 0;
    bool closed_at_page = false;      // when the page began
    bool advances = false;            // Method::kInverse: it moves the pointer
    std::optional<Utime> stops_from;  // holding from then on is a stop
  };
  /// What a press becomes by being held on.
  struct Hold {
    enum class What { kCount, kAdvance, kStop, kResume };
    What what;
    Utime at;
  };
  /// Time for which the pointer stays where it is; stands still while a switch is held.
  struct Rest {
    std::optional<Utime> left;
    std::optional<Utime> since;  // running
    bool fresh = true;           // never ran
  };

  // The pointer (scanner.cpp).
  void Activate(Utime now);
  void EnterLevel(Utime now, int level);
  void Light(Utime now, int entry);
  std::optional<Utime> RestOf(int entry) const;
  void UpdateRest(Utime now);
  std::optional<Utime> RestDue() const;
  void Advance(Utime now);
  void PassEnd(Utime now);
  void Leave(Utime now);
  void RestNow();
  void Choose(Utime now, Utime pressed_at);
  void ChooseControl(Utime now, Control control, Utime reaction_us);
  void Stop(Utime now);
  bool AnyHeld() const;
  bool PointerRuns() const;
  bool Lit() const { return !paused_ && entry_ >= 0 && entry_ < Entries(); }
  int Entries() const;
  const Level& ActiveLevel() const { return plan_.levels[static_cast<size_t>(level_)]; }
  int64_t ActivePage() const { return stopped_ ? 0 : page_.id; }
  void Say(Action::Kind kind) { actions_.push_back({.kind = kind, .page = ActivePage()}); }

  // The presses (scanner_presses.cpp).
  Press& Of(Switch which) { return presses_[which == Switch::kMain ? 0 : 1]; }
  const Press& Of(Switch which) const { return presses_[which == Switch::kMain ? 0 : 1]; }
  /// `now`, or what it was where a clock went back.
  Utime Forward(Utime now);
  void Settle(Utime now);
  void BeginPress(Utime at, Switch which);
  void EndPress(Utime now, Utime at, Switch which);
  std::optional<Hold> NextHold(Switch which) const;
  void CheckHolds(Utime now, Switch which);
  void OnHold(Utime now, Hold::What what, Switch which);
  bool LongPressChooses() const;
  void Count(Utime now, Switch which, Utime length_us);
  void EndAdvancing(Utime now);
  std::vector<Action> Done(Utime now);

  Config config_;
  std::array<Press, 2> presses_;
  Page page_;  // the owner's; nothing in it after Clear
  bool answered_ = false;
  bool stopped_ = false;
  bool confirming_ = false;
  bool paused_ = false;

  Plan plan_;  // of what is scanned: the page, or the way out of a stop
  int level_ = 0;
  int entry_ = -1;
  bool first_ = false;  // the entry was lit when the page began
  int passes_ = 0;      // of this level
  Utime lit_at_ = 0;
  Rest rest_;

  Utime now_;
  Utime shown_at_;
  std::optional<Utime> last_press_ended_;
  std::vector<Action> actions_;  // of the call that runs
};

}  // namespace beckon::ui_bridge::scan
