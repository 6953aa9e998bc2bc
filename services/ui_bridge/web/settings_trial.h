// New settings count at once, but for a short time only, unless they are kept: who has chosen what
// they cannot use gets the earlier ones back without doing anything.
#pragma once

#include <optional>

#include "services/base/utime.h"
#include "services/ui_bridge/web/settings.h"

namespace beckon::ui_bridge::web {

class SettingsTrial {
 public:
  /// Nothing is on trial, `kept` count.
  explicit SettingsTrial(Settings kept = {}) : kept_(std::move(kept)) {}

  /// What counts now.
  const Settings& current() const { return trial_ ? trial_->settings : kept_; }
  /// What counts when nothing is done.
  const Settings& kept() const { return kept_; }
  bool on() const { return trial_.has_value(); }

  /// Begins a trial, or goes on with others: the kept ones stay the same.
  void Try(Utime now, Settings settings, Utime length_us);
  /// False where there was no trial, or it is over.
  bool Keep(Utime now);
  /// The earlier ones, at once; false where there was no trial.
  bool GiveUp();
  /// True where time ended the trial.
  bool Tick(Utime now);

  /// Rounded up; nothing without a trial.
  std::optional<int> SecondsLeft(Utime now) const;
  std::optional<Utime> NextDeadline() const;

 private:
  struct Trial {
    Settings settings;
    Utime until;
  };
  Settings kept_;
  std::optional<Trial> trial_;
};

/// `least_us`, or more where scanning needs it: four times the longest way to the end of a question
/// "keep, go back".
Utime TrialLength_us(const Settings& settings, Utime least_us);

}  // namespace beckon::ui_bridge::web
