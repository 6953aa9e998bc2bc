// The section [bci].
#include "services/ui_bridge/bci/bci_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace beckon::ui_bridge::bci {
namespace {

using ::testing::HasSubstr;

Status Read(const std::string& text, BciConfig& config) {
  auto table = ConfigTable::Parse("[bci]\n" + text, "test.toml");
  if (!table) return table.error();
  ReadConfig(table->Section("bci"), config);
  return table->Finish();
}

TEST(BciConfig, ReadsWhatIsThere) {
  BciConfig config;
  ASSERT_TRUE(
      Read("rows = 6\ncolumns = 6\ncontrols = [\"undo\", \"stop\"]\nthreshold = 0.9\n"
           "decoder = \"cap\"\nlearn = false\n",
           config));
  EXPECT_EQ(MaxOptions(config.trials.layout), 34u);
  EXPECT_EQ(config.trials.layout.controls.back(), Control::kStop);
  EXPECT_EQ(config.trials.stopping.threshold, 0.9);
  EXPECT_EQ(config.trials.decoder, "cap");
  EXPECT_FALSE(config.learn);
}

TEST(BciConfig, SaysWhatIsWrong) {
  for (const char* wrong :
       {"threshold = 0.2", "threshold = nan", "rows = 0", "rows = 9\ncolumns = 9",
        "rows = 1\ncolumns = 1", "controls = [\"jump\"]", "controls = [\"stop\", \"stop\"]",
        "controls = [\"stop\", \"undo\", \"pause\"]", "mode = \"p300\"", "trial_timeout_s = 0",
        "min_repetitions = 5\nmax_repetitions = 4", "lsl = 3", "unknown = 1", "fading = 2"}) {
    BciConfig config;
    EXPECT_FALSE(Read(wrong, config)) << wrong;
  }
  BciConfig config;
  EXPECT_THAT(Read("controls = [\"jump\"]", config).error().message, HasSubstr("\"jump\""));
}

/// Each "# key = value" of the shipped section, without its '#'.
std::string Uncommented() {
  std::ifstream file(BECKON_SOURCE_DIR "/services/ui_bridge/bci/bci.toml");
  std::string text, line;
  while (std::getline(file, line)) {
    const size_t equals = line.find(" = ");
    const bool key =
        line.starts_with("# ") && equals != std::string::npos && line.find(' ', 2) == equals;
    text += (key ? line.substr(2) : line) + "\n";
  }
  return text;
}

TEST(BciConfig, TheShippedSectionSaysTheDefaults) {
  auto table = ConfigTable::Parse(Uncommented(), "bci.toml");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_GE(table->Section("bci").Keys().size(), 22u);
  const BciConfig defaults;
  BciConfig config;
  ReadConfig(table->Section("bci"), config);
  const auto read = table->Finish();
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(config.trials.layout.rows, defaults.trials.layout.rows);
  EXPECT_EQ(config.trials.layout.columns, defaults.trials.layout.columns);
  EXPECT_EQ(config.trials.layout.control_prior, defaults.trials.layout.control_prior);
  EXPECT_EQ(config.trials.stopping.threshold, defaults.trials.stopping.threshold);
  EXPECT_EQ(config.trials.stopping.final_threshold, defaults.trials.stopping.final_threshold);
  EXPECT_EQ(config.trials.stopping.min_repetitions, defaults.trials.stopping.min_repetitions);
  EXPECT_EQ(config.trials.stopping.max_repetitions, defaults.trials.stopping.max_repetitions);
  EXPECT_EQ(config.trials.stop_watch.trials_per_false_stop,
            defaults.trials.stop_watch.trials_per_false_stop);
  EXPECT_EQ(config.trials.read_s, defaults.trials.read_s);
  EXPECT_EQ(config.trials.pause_s, defaults.trials.pause_s);
  EXPECT_EQ(config.trials.rest_s, defaults.trials.rest_s);
  EXPECT_EQ(config.trials.trial_timeout_s, defaults.trials.trial_timeout_s);
  EXPECT_EQ(config.trials.invite, defaults.trials.invite);
  EXPECT_EQ(config.trial_s, defaults.trial_s);
  EXPECT_EQ(config.calibration.prior_accuracy, defaults.calibration.prior_accuracy);
  EXPECT_EQ(config.calibration.prior_trials, defaults.calibration.prior_trials);
  EXPECT_EQ(config.calibration.prior_sharpness, defaults.calibration.prior_sharpness);
  EXPECT_EQ(config.calibration.fading, defaults.calibration.fading);
  EXPECT_EQ(config.learn, defaults.learn);
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
