// What trials whose meaning became known say of a decoder: how sure it may be taken to be, which
// classes it takes for which, how often it is right.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "services/ui_bridge/bci/evidence.h"

namespace beckon::ui_bridge::bci {

/// A trial, and the class that was meant in it.
struct KnownTrial {
  size_t meant = 0;
  std::vector<double> probabilities;
};

struct CalibrationConfig {
  double prior_accuracy = 0.7;   // 0..1, of a decoder that is not known yet
  double prior_trials = 20;      // > 0, that count as much as that belief
  double prior_sharpness = 0.8;  // > 0; below 1: as if it were surer than it ought to be
  double fading = 0.995;         // 0.5 .. 1, weight of a trial against the one after it
  int most_trials = 400;         // >= 1 are kept
};

/// Of one decoder with one number of classes, for one user.
class Calibration {
 public:
  explicit Calibration(size_t classes, const CalibrationConfig& config = {});

  /// False: not of this decoder (another number of classes, no probabilities); not added.
  bool Add(KnownTrial trial);

  size_t classes() const { return classes_; }
  const std::deque<KnownTrial>& trials() const { return trials_; }  // oldest first

  /// Expected P(decoded | meant): Dirichlet counts of class meant x probabilities received, older
  /// ones weighing less, from an even prior.
  Confusion ExpectedConfusion() const;
  /// Expected P(the likeliest class of a trial is the one meant).
  double Accuracy() const;
  /// How to read it: sharpness and habit with the highest posterior (a multinomial logistic
  /// regression on two features, which is concave), sharpness ~ N(prior, 0.3), habit ~ N(0, 0.3),
  /// neither negative. Each trial is judged by the confusion of the others.
  DecoderModel Fit() const;

 private:
  double Gap(const DecoderModel& model) const;

  size_t classes_;
  CalibrationConfig config_;
  std::deque<KnownTrial> trials_;
};

}  // namespace beckon::ui_bridge::bci
