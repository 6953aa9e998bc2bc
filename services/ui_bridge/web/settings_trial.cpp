#include "services/ui_bridge/web/settings_trial.h"

#include <algorithm>
#include <utility>

namespace beckon::ui_bridge::web {

void SettingsTrial::Try(Utime now, Settings settings, Utime length_us) {
  trial_ = Trial{std::move(settings), now + length_us};
}

bool SettingsTrial::Keep(Utime now) {
  if (Tick(now) || !trial_) return false;
  kept_ = std::exchange(trial_, std::nullopt)->settings;
  return true;
}

bool SettingsTrial::GiveUp() { return std::exchange(trial_, std::nullopt).has_value(); }

bool SettingsTrial::Tick(Utime now) { return trial_ && now >= trial_->until && GiveUp(); }

std::optional<int> SettingsTrial::SecondsLeft(Utime now) const {
  if (!trial_) return {};
  return static_cast<int>((std::max<Utime>(trial_->until - now, 0) + kSecond - 1) / kSecond);
}

std::optional<Utime> SettingsTrial::NextDeadline() const {
  if (!trial_) return {};
  return trial_->until;
}

Utime TrialLength_us(const Settings& settings, Utime least_us) {
  if (!settings.scans()) return least_us;
  const scan::Config config = ScanConfig(settings);
  return std::max(least_us, 4 * (config.first_us + 2 * config.scan_us + config.hold_us));
}

}  // namespace beckon::ui_bridge::web
