// Whole conversations of the front end bci.
#include <fstream>

#include "services/ui_bridge/bci/calibration_file.h"
#include "tests/ui_bridge/bci/front_end_fixture.h"

namespace beckon::ui_bridge::bci {
namespace {

using Kind = msg::SessionKind;
using ::testing::SizeIs;

class BciFrontEndTest : public FrontEndTest {};

TEST_F(BciFrontEndTest, LeadsAConversationAndCalibratesByItsTask) {
  on_begun_ = [this] { Ask(1); };
  on_answer_ = [this](const msg::Answer& answer) {
    if (answer.query_id == 1) return Ask(2);
    TellTask("Grasp", {2, "Mug", 1});
    Tell(Kind::kConfirmed);
  };
  decode_ = [this](const msg::Stimulus& stimulus) { Decode(stimulus, 1, 0.7); };
  ASSERT_TRUE(Start(Quick(), 1));
  loop_.After(20 * kSecond, [this] {
    ADD_FAILURE() << "not done after 20 s";
    loop_.Stop();
  });
  loop_.Run();  // it ends by itself after one session
  ASSERT_THAT(answers_, SizeIs(2));
  for (const auto& answer : answers_) {
    ASSERT_THAT(answer.likelihoods, SizeIs(3));
    EXPECT_GT(answer.likelihoods[1], 0.9);
    EXPECT_GT(answer.likelihoods[0], 0);
  }
  EXPECT_GE(stimuli_.size(), 4u);
  EXPECT_EQ(interface_.kind, msg::InterfaceKind::kVector);
  EXPECT_EQ(interface_.max_options, 3);
  const auto path = (folder_ / "bci" / CalibrationFileName("ann", "cap", 4)).string();
  ASSERT_TRUE(std::filesystem::exists(path));
  const auto learnt = LoadCalibration(path, 4, {});
  EXPECT_EQ(learnt.warning, "");
  EXPECT_GE(learnt.calibration.trials().size(), 4u);
  for (const auto& trial : learnt.calibration.trials()) EXPECT_EQ(trial.meant, 1u);
}

TEST_F(BciFrontEndTest, ACalibrationIsUsedFromTheFirstTrial) {
  Calibration worthless(4);  // always says class 0
  for (int i = 0; i < 200; ++i)
    ASSERT_TRUE(worthless.Add({static_cast<size_t>(i) % 4, {0.91, 0.03, 0.03, 0.03}}));
  const auto path = (folder_ / "bci" / CalibrationFileName("ann", "cap", 4)).string();
  ASSERT_TRUE(SaveCalibration(path, worthless));
  on_begun_ = [this] { Ask(1); };
  decode_ = [this](const msg::Stimulus& stimulus) { Decode(stimulus, 0, 0.91); };
  ASSERT_TRUE(Start(Quick() + "max_repetitions = 6\n"));
  Until([this] { return !answers_.empty(); });
  EXPECT_EQ(std::ranges::count(stimuli_, 1, &msg::Stimulus::query_id), 6);
  EXPECT_LT(answers_[0].likelihoods[0], 0.7);
}

TEST_F(BciFrontEndTest, ATornCalibrationIsPutAsideAndNothingElseHappens) {
  const auto path = folder_ / "bci" / CalibrationFileName("ann", "cap", 4);
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << "{\"version\":1,\"clas";
  on_begun_ = [this] { Ask(1); };
  decode_ = [this](const msg::Stimulus& stimulus) { Decode(stimulus, 2); };
  ASSERT_TRUE(Start(Quick()));
  Until([this] { return !answers_.empty(); });
  EXPECT_TRUE(std::filesystem::exists(path.string() + ".bad"));
}

TEST_F(BciFrontEndTest, StopByTheDecoderReachesTheBusAndTwoWordsResume) {
  on_begun_ = [this] { Ask(1); };
  decode_ = [this](const msg::Stimulus& stimulus) {
    const auto onwards = std::ranges::find_if(stimulus.labels, [](const std::string& label) {
      return label == "Go on" || label == "Yes, go on";
    });
    Decode(stimulus,
           onwards == stimulus.labels.end()
               ? 3
               : static_cast<size_t>(onwards - stimulus.labels.begin()),
           0.9);
  };
  ASSERT_TRUE(Start(Quick()));
  Until([this] { return Requested(Kind::kRequestResume); });
  EXPECT_TRUE(Requested(Kind::kRequestStop));
  EXPECT_TRUE(answers_.empty());
}

TEST_F(BciFrontEndTest, StopByAKeyIsHeardInTheMiddleOfATrial) {
  on_begun_ = [this] { Ask(1); };
  decode_ = [this](const msg::Stimulus& stimulus) {
    if (stimulus.query_id != 0) Type("s\n");
  };
  ASSERT_TRUE(Start(Quick()));
  Until([this] { return Requested(Kind::kRequestStop); });
  EXPECT_EQ(std::ranges::count(stimuli_, 1, &msg::Stimulus::query_id), 1);
}

TEST_F(BciFrontEndTest, StopByAKeyIsHeardWithoutADecoderAndWithoutAConversation) {
  ASSERT_TRUE(Start(Quick()));
  Type("nonsense\ns\n");
  Until([this] { return Requested(Kind::kRequestStop); });
}

TEST_F(BciFrontEndTest, TwoClassesAreAnnouncedAsAYesNoSwitch) {
  ASSERT_TRUE(Start("[bci]\nmode = \"binary\"\n"));
  Until([this] { return !interface_.device.empty(); });
  EXPECT_EQ(interface_.kind, msg::InterfaceKind::kYesNo);
  EXPECT_EQ(interface_.max_options, 2);
  EXPECT_GT(interface_.false_no, 0);
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
