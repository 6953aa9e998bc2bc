// How fast a user presses, and which scan time that suggests. Nothing is applied here: whoever asks
// lets the user decide.
//
// Simpson, Koester & LoPresti, "Selecting an appropriate scan rate: the '.65 rule'", Assistive
// Technology 19 (2007) 51-60, doi:10.1080/10400435.2007.10131865: a scan time of mean press time /
// 0.65 suits most users, and is about the mean plus two standard deviations; with a known
// distribution a scan time can be chosen for an error level.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "services/base/utime.h"

namespace beckon::ui_bridge::scan {

struct ReactionConfig {
  double share = 0.65;       // of the scan time that the mean reaction takes
  size_t least = 12;         // presses, before anything is suggested
  size_t kept = 60;          // the latest ones
  double notable = 0.15;     // a suggestion differs at least by this share of the scan time
  double many_undone = 0.1;  // share of choices taken back at once above which it gets slower
  double slower = 1.25;      // times the scan time, then
  Utime shortest_us = 300'000;
  Utime longest_us = 15'000'000;
};

/// What is known of a user's times from lit to press, taken as log-normal (they have a long tail to
/// the right), by median and median absolute deviation of their logarithms: up to half of the
/// presses may be odd.
struct ReactionEstimate {
  size_t presses = 0;
  Utime mean_us = 0;    // exp(mu + sigma^2 / 2)
  Utime spread_us = 0;  // standard deviation
  double undone = 0;    // share of the choices that were taken back at once
};

struct ScanSuggestion {
  Utime scan_us = 0;
  bool because_undone = false;  // slower, as many choices were taken back; else by the rule
  ReactionEstimate estimate;
};

class ReactionTimes {
 public:
  explicit ReactionTimes(ReactionConfig config = {}) : config_(config) {}

  /// A press that Action::reaction_us tells of; 0 or less says nothing.
  void Add(Utime reaction_us);
  /// Something was chosen; and the last that was chosen was taken back before anything else.
  void Chosen();
  void Undone();

  std::optional<ReactionEstimate> Estimate() const;
  /// Another scan time, where it would differ notably; rounded to 50 ms.
  std::optional<ScanSuggestion> Suggest(Utime scan_us) const;
  /// The user was asked, whatever they said: not again before as many presses as at first.
  void Asked() { since_asked_ = 0; }
  /// The scan time changed: choices taken back with the old one say nothing of the new one.
  void ScanTimeChanged();

 private:
  ReactionConfig config_;
  std::deque<double> logs_;  // of reactions in us, oldest first
  std::deque<bool> undone_;  // choices, oldest first
  size_t since_asked_ = 0;
};

}  // namespace beckon::ui_bridge::scan
