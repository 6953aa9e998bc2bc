// What is announced.
#include "services/ui_bridge/bci/announcement.h"

#include <gtest/gtest.h>

#include <numeric>

#include "lcmtypes/codec.h"
#include "services/ui_bridge/bci/residual.h"

namespace beckon::ui_bridge::bci {
namespace {

TrialsConfig Matrix(int rows, int columns) {
  TrialsConfig config;
  config.layout.rows = rows;
  config.layout.columns = columns;
  return config;
}

TEST(Announcement, AMatrixTakesVectorsForAllItsCellsButTheControls) {
  auto config = Matrix(3, 3);
  config.layout.controls = {Control::kStop};
  const auto interface = Announce(config, Calibration(9), 3);
  EXPECT_EQ(interface.kind, msg::InterfaceKind::kVector);
  EXPECT_EQ(interface.max_options, 8);
  EXPECT_EQ(interface.confusion.size(), 8u);
}

TEST(Announcement, TwoClassesTakeYesNoQuestions) {
  TrialsConfig config;
  config.layout.mode = msg::StimulusMode::kBinary;
  const auto interface = Announce(config, Calibration(2), 3);
  EXPECT_EQ(interface.kind, msg::InterfaceKind::kYesNo);
  EXPECT_EQ(interface.max_options, 2);
  EXPECT_TRUE(interface.confusion.empty());
  EXPECT_GT(interface.false_yes, 0);
}

TEST(Announcement, ErrorsAreThoseOfFusedAnswersNotOfTrials) {
  const auto interface = Announce(Matrix(2, 2), Calibration(4), 3);  // 70 % of trials
  for (size_t m = 0; m < 4; ++m) EXPECT_GT(interface.confusion[m][m], 0.93);
  EXPECT_LT(interface.false_no, 0.07);
  EXPECT_GT(interface.false_no, 0.001);
}

TEST(Announcement, ABetterDecoderIsFasterAndRarelyWrong) {
  const CalibrationConfig good{.prior_accuracy = 0.95}, poor{.prior_accuracy = 0.5};
  const auto fast = Announce(Matrix(2, 2), Calibration(4, good), 3);
  const auto slow = Announce(Matrix(2, 2), Calibration(4, poor), 3);
  EXPECT_LT(fast.seconds_per_question + 4 * fast.seconds_per_option,
            0.5 * (slow.seconds_per_question + 4 * slow.seconds_per_option));
  EXPECT_GE(fast.seconds_per_question, 3);
}

TEST(Announcement, IsAlwaysAMessageThatMayBeSent) {
  for (const int side : {1, 2, 3, 6, 8}) {
    for (const double accuracy : {0.05, 0.3, 0.7, 0.999}) {
      if (side == 1) continue;
      const size_t classes = static_cast<size_t>(side * side);
      auto interface =
          Announce(Matrix(side, side), Calibration(classes, {.prior_accuracy = accuracy}), 0.5);
      interface.utime = 1;
      interface.device = "bci@here";
      const auto bytes = Codec<msg::Interface>::Encode(interface);
      EXPECT_TRUE(bytes.ok()) << side << " " << accuracy << ": "
                              << (bytes.ok() ? "" : bytes.error().message);
    }
  }
}

TEST(Residual, ConfusesTheSameClassesAsTrialsDoButLess) {
  Confusion trial = EvenConfusion(3, 0.7);
  trial[0] = {0.5, 0.45, 0.05};
  const auto residual = ResidualConfusion(trial, 3, 0.03);
  EXPECT_GT(residual[0][1], 5 * residual[0][2]);
  EXPECT_GT(1 - residual[0][0], 1 - residual[1][1]);
  double off = 0;
  for (size_t m = 0; m < 3; ++m) off += 1 - residual[m][m];
  EXPECT_NEAR(off / 3, 0.03, 1e-5);
}

TEST(Residual, IsTheSameEveryTime) {
  const StoppingConfig stopping;
  EXPECT_EQ(SimulateResidual(4, 4, 0.7, stopping).error,
            SimulateResidual(4, 4, 0.7, stopping).error);
}

TEST(Residual, StaysBelowWhatTheThresholdAllows) {
  const StoppingConfig stopping{.threshold = 0.95, .max_repetitions = 50};
  for (const double accuracy : {0.6, 0.7, 0.9}) {
    const auto residual = SimulateResidual(4, 4, accuracy, stopping);
    EXPECT_LT(residual.error, 0.06);
    EXPECT_GE(residual.repetitions, 1);
  }
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
