#include "services/ui_bridge/bci/bci_config.h"

#include <vector>

namespace beckon::ui_bridge::bci {
namespace {

void ReadLayout(ConfigTable& table, LayoutConfig& layout) {
  std::string mode = layout.mode == msg::StimulusMode::kBinary ? "binary" : "matrix";
  table.Get("mode", mode, {"matrix", "binary"});
  layout.mode = mode == "binary" ? msg::StimulusMode::kBinary : msg::StimulusMode::kMatrix;
  table.Get("rows", layout.rows, 1, 64);
  table.Get("columns", layout.columns, 1, 64);
  std::vector<std::string> names;
  for (const Control control : layout.controls) names.emplace_back(Name(control));
  table.Get("controls", names);
  layout.controls.clear();
  for (const auto& name : names) {
    if (const auto control = FindControl(name)) {
      layout.controls.push_back(*control);
    } else {
      table.Fail("controls", "expected \"stop\", \"undo\" or \"pause\", found \"" + name + "\"");
    }
  }
  table.Get("control_prior", layout.control_prior, 0.0001, 0.2);
  if (auto right = Check(layout); !right) table.Fail("controls", right.error().message);
}

}  // namespace

void ReadConfig(ConfigTable table, BciConfig& config) {
  TrialsConfig& trials = config.trials;
  ReadLayout(table, trials.layout);
  table.Get("decoder", trials.decoder);
  table.Get("threshold", trials.stopping.threshold, 0.5, 0.9999);
  table.Get("final_threshold", trials.stopping.final_threshold, 0.5, 0.9999);
  table.Get("min_repetitions", trials.stopping.min_repetitions, 1, 1000);
  table.Get("max_repetitions", trials.stopping.max_repetitions, 1, 1000);
  if (trials.stopping.max_repetitions < trials.stopping.min_repetitions)
    table.Fail("max_repetitions", "expected min_repetitions or more");
  table.Get("trials_per_false_stop", trials.stop_watch.trials_per_false_stop, 2, 1e9);
  table.Get("trial_s", config.trial_s, 0.01, 600);
  table.Get("trial_timeout_s", trials.trial_timeout_s, 0.05, 600);
  table.Get("read_s", trials.read_s, 0, 600);
  table.Get("pause_s", trials.pause_s, 0, 600);
  table.Get("rest_s", trials.rest_s, 0, 3600);
  table.Get("invite", trials.invite);
  table.Get("learn", config.learn);
  table.Get("calibration_dir", config.calibration_dir);
  table.Get("prior_accuracy", config.calibration.prior_accuracy, 0.05, 0.999);
  table.Get("prior_trials", config.calibration.prior_trials, 1, 10'000);
  table.Get("prior_sharpness", config.calibration.prior_sharpness, 0.05, 2);
  table.Get("fading", config.calibration.fading, 0.5, 1);
  table.Get("lsl", config.lsl);
  table.Get("lsl_library", config.lsl_library);
}

}  // namespace beckon::ui_bridge::bci
