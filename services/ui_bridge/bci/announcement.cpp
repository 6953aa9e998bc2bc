#include "services/ui_bridge/bci/announcement.h"

#include <algorithm>

#include "services/ui_bridge/bci/residual.h"

namespace beckon::ui_bridge::bci {
namespace {

constexpr double kMostSeconds = 3600;

double Seconds(const TrialsConfig& config, const Residual& residual, double trial_s) {
  return config.read_s + residual.repetitions * (trial_s + config.pause_s);
}

}  // namespace

msg::Interface Announce(const TrialsConfig& config, const Calibration& calibration,
                        double trial_s) {
  const size_t classes = Classes(config.layout), most = MaxOptions(config.layout);
  const double accuracy = calibration.Accuracy();
  const Confusion trial = calibration.ExpectedConfusion();
  const Residual two = SimulateResidual(classes, 2, accuracy, config.stopping);
  const auto yes_no = ResidualConfusion(trial, 2, two.error);
  msg::Interface interface;
  interface.kind = msg::InterfaceKind::kYesNo;
  interface.max_options = 2;
  interface.false_no = std::min(yes_no[0][1], 0.5f);
  interface.false_yes = std::min(yes_no[1][0], 0.5f);
  double first = Seconds(config, two, trial_s), slope = 0;
  if (config.layout.mode == msg::StimulusMode::kMatrix && most > 2) {
    const Residual all = SimulateResidual(classes, most, accuracy, config.stopping);
    interface.kind = msg::InterfaceKind::kVector;
    interface.max_options = static_cast<int>(most);
    interface.confusion = ResidualConfusion(trial, most, all.error);
    const double last = Seconds(config, all, trial_s);
    slope = std::max(0.0, (last - first) / static_cast<double>(most - 2));
  }
  interface.seconds_per_option = static_cast<float>(std::min(slope, kMostSeconds));
  interface.seconds_per_question =
      static_cast<float>(std::clamp(first - 2 * slope, 1e-3, kMostSeconds));
  return interface;
}

}  // namespace beckon::ui_bridge::bci
