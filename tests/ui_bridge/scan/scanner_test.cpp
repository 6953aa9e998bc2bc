#include "services/ui_bridge/scan/scanner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/ui_bridge/scan/rig.h"

namespace beckon::ui_bridge::scan {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Kind = Action::Kind;

Page WithControls(int n) {
  Page page = Options(n);
  page.controls = {Control::kUndo, Control::kPause, Control::kStop};
  return page;
}

TEST(AutomaticScanning, LightsTheFirstLongerAndThenOneAfterTheOther) {
  Rig rig(PlainConfig());
  rig.Show(Options(3));
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(0));
  EXPECT_EQ(rig.scanner.view().dwell_us, 1500 * kMs);
  rig.Wait(1499 * kMs);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(0));
  rig.Wait(1 * kMs);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(1));
  rig.Wait(1000 * kMs);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(2));
  rig.Wait(1000 * kMs);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(0));
}

TEST(AutomaticScanning, ChoosesWhatIsLitAndTellsTheReactionTime) {
  Rig rig(PlainConfig());
  rig.Show(Options(3));
  rig.Wait(1900 * kMs);
  rig.Press(120 * kMs);
  ASSERT_THAT(rig.Chosen(), ElementsAre(1));
  EXPECT_EQ(rig.actions.back().second.reaction_us, 400 * kMs);
  EXPECT_EQ(rig.actions.back().second.page, 1);
  EXPECT_TRUE(rig.scanner.view().answered);
  EXPECT_EQ(rig.scanner.view().entry, -1);
}

TEST(AutomaticScanning, TellsNoReactionTimeOfThePagesFirstEntry) {
  Rig rig(PlainConfig());
  rig.Show(Options(3));
  rig.Wait(900 * kMs);
  rig.Press(120 * kMs);
  ASSERT_THAT(rig.Chosen(), ElementsAre(0));
  EXPECT_EQ(rig.actions.back().second.reaction_us, 0);
}

TEST(AutomaticScanning, StandsStillWhileTheSwitchIsHeld) {
  Config config = PlainConfig();
  config.hold_us = 500 * kMs;
  Rig rig(config);
  rig.Show(Options(3));
  rig.Wait(1400 * kMs);
  rig.Press(300 * kMs);  // too short to count
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(0));
  rig.Wait(99 * kMs);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(0));
  rig.Wait(1 * kMs);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(1));
  EXPECT_THAT(rig.Chosen(), IsEmpty());
}

TEST(AutomaticScanning, TakesWhatWasLitWhenThePressBeganThoughTheTickIsLate) {
  Rig rig(PlainConfig());
  rig.Show(Options(3));
  rig.now = 1510 * kMs;  // overdue: the user still sees the first
  rig.Down();
  rig.now = 1600 * kMs;
  rig.Up();
  EXPECT_THAT(rig.Chosen(), ElementsAre(0));
}

TEST(AutomaticScanning, NeverSkipsAnEntryHoweverLateTheTickIs) {
  Rig rig(PlainConfig());
  rig.Show(Options(4));
  rig.Take(rig.scanner.Tick(60 * kSecond));
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(1));
  EXPECT_EQ(rig.scanner.NextDeadline(), 61 * kSecond);
}

TEST(AutomaticScanning, RestsAfterItsRoundsAndGoesOnByAPressThatChoosesNothing) {
  Config config = PlainConfig();
  config.rounds = 2;
  Rig rig(config);
  rig.Show(Options(2));
  rig.Wait(4999 * kMs);
  EXPECT_FALSE(rig.scanner.view().paused);
  rig.Wait(1 * kMs);
  EXPECT_TRUE(rig.scanner.view().paused);
  EXPECT_EQ(rig.scanner.view().entry, -1);
  EXPECT_FALSE(rig.scanner.NextDeadline());
  rig.Wait(3600 * kSecond);
  rig.Press(100 * kMs);
  EXPECT_THAT(rig.Chosen(), IsEmpty());
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(0));
  rig.Wait(500 * kMs);
  rig.Press(100 * kMs);
  EXPECT_THAT(rig.Chosen(), ElementsAre(0));
}

TEST(AutomaticScanning, LeavesAGroupThatPassedWithoutAPress) {
  Config config = PlainConfig();
  config.group_passes = 1;
  Rig rig(config);
  rig.Show(WithControls(2));
  rig.Wait(3000 * kMs);
  ASSERT_EQ(rig.scanner.view().controls.size(), 3u);
  EXPECT_TRUE(rig.scanner.view().group);
  rig.Press(100 * kMs);
  EXPECT_THAT(rig.scanner.view().controls, ElementsAre(Control::kUndo));
  EXPECT_EQ(rig.scanner.view().depth, 1);
  rig.Wait(3500 * kMs);
  EXPECT_EQ(rig.Count(Kind::kBack), 1);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(0));
}

TEST(AutomaticScanning, LeavesAGroupByItsLastEntry) {
  Config config = PlainConfig();
  config.back = Back::kEntry;
  Rig rig(config);
  rig.Show(WithControls(2));
  rig.Wait(3000 * kMs);
  rig.Press(100 * kMs);
  rig.Wait(4000 * kMs);
  ASSERT_TRUE(rig.scanner.view().back);
  rig.Press(100 * kMs);
  EXPECT_EQ(rig.Count(Kind::kBack), 1);
  EXPECT_EQ(rig.scanner.view().depth, 0);
}

TEST(AutomaticScanning, OffersUndoAndPauseAmongItsControls) {
  Rig rig(PlainConfig());
  rig.Show(WithControls(2));
  rig.Wait(3000 * kMs);
  rig.Press(100 * kMs);
  rig.Wait(600 * kMs);
  rig.Press(100 * kMs);
  ASSERT_EQ(rig.Count(Kind::kControl), 1);
  EXPECT_EQ(rig.actions.back().second.control, Control::kUndo);
  EXPECT_EQ(rig.scanner.view().depth, 0);
  rig.Wait(3000 * kMs);
  rig.Press(100 * kMs);
  rig.Wait(2000 * kMs);
  rig.Press(100 * kMs);
  EXPECT_TRUE(rig.scanner.view().paused);
}

TEST(StepScanning, MovesByOneSwitchAndChoosesByTheOther) {
  Config config = PlainConfig();
  config.method = Method::kStep;
  Rig rig(config);
  rig.Show(Options(3));
  EXPECT_FALSE(rig.scanner.NextDeadline());
  rig.Wait(3600 * kSecond);
  rig.Press(100 * kMs);
  rig.Wait(100 * kMs);
  rig.Press(100 * kMs);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(2));
  rig.Wait(100 * kMs);
  rig.Press(100 * kMs, Switch::kSelect);
  EXPECT_THAT(rig.Chosen(), ElementsAre(2));
}

TEST(StepScanning, ByDwellingChoosesNothingForWhoDoesNothing) {
  Config config = PlainConfig();
  config.method = Method::kStep;
  config.step_select = StepSelect::kDwell;
  config.dwell_us = 1000 * kMs;
  Rig rig(config);
  rig.Show(Options(3));
  rig.Wait(3600 * kSecond);
  EXPECT_THAT(rig.Chosen(), IsEmpty());
  rig.Press(100 * kMs);
  rig.Wait(900 * kMs);
  rig.Press(100 * kMs);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(1));
  rig.Wait(999 * kMs);
  EXPECT_THAT(rig.Chosen(), IsEmpty());
  rig.Wait(1 * kMs);
  EXPECT_THAT(rig.Chosen(), ElementsAre(1));
}

TEST(StepScanning, ByALongPressMovesByTheShortOnes) {
  Config config = PlainConfig();
  config.method = Method::kStep;
  config.step_select = StepSelect::kLongPress;
  Rig rig(config);
  rig.Show(Options(3));
  rig.Press(699 * kMs);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(1));
  rig.Wait(100 * kMs);
  rig.Press(700 * kMs);
  EXPECT_THAT(rig.Chosen(), ElementsAre(1));
}

TEST(StepScanning, PastTheLastEntryOfAGroupLeavesIt) {
  Config config = PlainConfig();
  config.method = Method::kStep;
  config.grouping = Grouping::kRowColumn;
  config.columns = 2;
  Rig rig(config);
  rig.Show(Options(4));
  rig.Press(100 * kMs, Switch::kSelect);
  EXPECT_EQ(rig.scanner.view().depth, 1);
  rig.Wait(100 * kMs);
  rig.Press(100 * kMs);
  rig.Wait(100 * kMs);
  rig.Press(100 * kMs);
  EXPECT_EQ(rig.scanner.view().depth, 0);
  EXPECT_EQ(rig.Count(Kind::kBack), 1);
}

TEST(InverseScanning, MovesWhileHeldAndChoosesByLettingGo) {
  Config config = PlainConfig();
  config.method = Method::kInverse;
  Rig rig(config);
  rig.Show(Options(3));
  rig.Wait(60 * kSecond);
  EXPECT_EQ(rig.scanner.view().entry, -1);
  rig.Down();
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(0));
  rig.Wait(1800 * kMs);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(1));
  rig.Up();
  EXPECT_THAT(rig.Chosen(), ElementsAre(1));
}

TEST(InverseScanning, HeldPastTheEndChoosesNothingAndHeldOnStops) {
  Config config = PlainConfig();
  config.method = Method::kInverse;
  Rig rig(config);
  rig.Show(Options(2));
  rig.Press(4000 * kMs);
  EXPECT_THAT(rig.actions, IsEmpty());
  EXPECT_EQ(StopWithin_us(rig.scanner.plan(), config), 4500 * kMs);
  rig.Down();
  rig.Wait(4499 * kMs);
  EXPECT_EQ(rig.Count(Kind::kStop), 0);
  rig.Wait(1 * kMs);
  EXPECT_EQ(rig.Count(Kind::kStop), 1);
  rig.Up();
  EXPECT_THAT(rig.Chosen(), IsEmpty());
}

TEST(InverseScanning, WhoseQuestionGoesWhileHeldIsNoStop) {
  Config config = PlainConfig();
  config.method = Method::kInverse;
  Rig rig(config);
  rig.Show(Options(9));
  rig.Down();
  rig.Wait(6 * kSecond);
  rig.Show(Options(3));
  EXPECT_EQ(rig.scanner.view().entry, -1);
  rig.Wait(1999 * kMs);
  rig.Up();
  EXPECT_THAT(rig.actions, IsEmpty());
}

TEST(Presses, ThatBeganBeforeAQuestionWasShownDoNotAnswerIt) {
  for (const Method method : {Method::kAutomatic, Method::kStep, Method::kInverse}) {
    for (const Accept accept : {Accept::kRelease, Accept::kPress}) {
      Config config = PlainConfig();
      config.method = method;
      config.accept = accept;
      config.hold_us = 50 * kMs;
      config.debounce_us = 5 * kMs;
      Rig rig(config);
      rig.Show(Options(3));
      rig.Wait(200 * kMs);
      for (const Utime before : {0 * kMs, 3 * kMs, 40 * kMs}) {
        rig.Down(Switch::kSelect);
        rig.Wait(before);
        rig.Show(Options(3));
        rig.Wait(500 * kMs);
        rig.Up(Switch::kSelect);
        rig.Wait(500 * kMs);
      }
      rig.Down();
      rig.Wait(2 * kMs);
      rig.Show(Options(3));
      rig.Wait(500 * kMs);
      rig.Up();
      rig.Wait(10 * kMs);
      EXPECT_THAT(rig.Chosen(), IsEmpty());
    }
  }
}

TEST(Presses, TooSoonAfterANewQuestionWereMeantForTheOneBefore) {
  Config config = PlainConfig();
  config.guard_us = 150 * kMs;
  Rig rig(config);
  rig.Show(Options(2));
  rig.Wait(149 * kMs);
  rig.Press(100 * kMs);
  EXPECT_THAT(rig.Chosen(), IsEmpty());
  rig.Press(100 * kMs);
  EXPECT_THAT(rig.Chosen(), ElementsAre(0));
}

TEST(Presses, TooSoonAfterTheLastAreIgnored) {
  Config config = PlainConfig();
  config.method = Method::kStep;
  config.ignore_repeat_us = 300 * kMs;
  Rig rig(config);
  rig.Show(Options(5));
  for (const Utime gap : {0 * kMs, 100 * kMs, 100 * kMs}) {  // a tremor: 0, 200 and 400 ms after
    rig.Wait(gap);
    rig.Press(100 * kMs);
  }
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(2));
}

TEST(Presses, CountByTheirBeginningOrByTheirEnd) {
  Config config = PlainConfig();
  config.hold_us = 200 * kMs;
  for (const Accept accept : {Accept::kRelease, Accept::kPress}) {
    config.accept = accept;
    Rig rig(config);
    rig.Show(Options(2));
    rig.Wait(100 * kMs);
    rig.Press(199 * kMs);
    EXPECT_THAT(rig.Chosen(), IsEmpty());
    rig.Down();
    rig.Wait(200 * kMs);
    EXPECT_EQ(rig.Chosen().size(), accept == Accept::kPress ? 1u : 0u);
    rig.Up();
    EXPECT_THAT(rig.Chosen(), ElementsAre(0));
  }
}

TEST(Presses, OfTwoSwitchesAtOnceAreOne) {
  Config config = PlainConfig();
  config.method = Method::kStep;
  Rig rig(config);
  rig.Show(Options(3));
  rig.Down();
  rig.Wait(1 * kMs);
  rig.Down(Switch::kSelect);
  rig.Wait(100 * kMs);
  rig.Up(Switch::kSelect);
  EXPECT_THAT(rig.Chosen(), IsEmpty());
  rig.Up();
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(1));
}

TEST(Presses, OfADeviceThatGoesAreForgotten) {
  for (const Method method : {Method::kAutomatic, Method::kStep, Method::kInverse}) {
    Config config = PlainConfig();
    config.method = method;
    Rig rig(config);
    rig.Show(Options(3));
    rig.Down();
    rig.Wait(300 * kMs);
    rig.scanner.ReleaseAll(rig.now);
    rig.Wait(60 * kSecond);
    EXPECT_THAT(rig.Chosen(), IsEmpty());
    EXPECT_EQ(rig.Count(Kind::kStop), 0);
    EXPECT_FALSE(rig.scanner.view().pressed);
  }
}

TEST(Presses, WithoutAReleaseCountAtOnceAndAHeldKeysRepeatsDoNot) {
  Config config = PlainConfig();
  config.method = Method::kStep;
  config.ignore_repeat_us = 600 * kMs;
  Rig rig(config);
  rig.Show(Options(5));
  rig.Click();
  rig.Wait(500 * kMs);  // a terminal's delay before it repeats
  for (int i = 0; i < 100; ++i) {
    rig.Click();
    rig.Wait(30 * kMs);
  }
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(1));
  rig.Wait(600 * kMs);
  rig.Click(Switch::kSelect);
  EXPECT_THAT(rig.Chosen(), ElementsAre(1));
}

TEST(Stop, ComesByHoldingInEveryState) {
  const auto states = {
      +[](Rig&) {},                                   // nothing was ever shown
      +[](Rig& rig) { rig.Show(Options(3)); },        // just shown: too soon to choose
      +[](Rig& rig) { rig.scanner.Clear(rig.now); },  //
      +[](Rig& rig) {                                 // answered
        rig.Show(Options(1));
        rig.Wait(500 * kMs);
        rig.Press(50 * kMs);
      },
      +[](Rig& rig) {  // resting
        rig.Show(Options(3));
        rig.Wait(600 * kSecond);
      },
      +[](Rig& rig) {  // right after a press, which is too soon for another
        rig.Show(Options(3));
        rig.Wait(1000 * kMs);
        rig.Press(50 * kMs);
      },
  };
  for (const Accept accept : {Accept::kRelease, Accept::kPress}) {
    for (const Method method : {Method::kAutomatic, Method::kStep}) {
      for (const auto& enter : states) {
        Config config = PlainConfig();
        config.method = method;
        config.accept = accept;
        config.debounce_us = 5 * kMs;
        config.guard_us = 150 * kMs;
        config.ignore_repeat_us = 300 * kMs;
        for (const Switch which : {Switch::kMain, Switch::kSelect}) {
          Rig rig(config);
          enter(rig);
          rig.Wait(10 * kMs);
          rig.Down(which);
          rig.Wait(1999 * kMs);
          EXPECT_EQ(rig.Count(Kind::kStop), 0);
          rig.Wait(1 * kMs);
          EXPECT_EQ(rig.Count(Kind::kStop), 1);
          EXPECT_TRUE(rig.scanner.view().stopped);
          rig.Wait(60 * kSecond);
          EXPECT_EQ(rig.Count(Kind::kStop), 1);
        }
      }
    }
  }
}

TEST(Stop, ByHoldingChoosesNothingWherePressesCountByTheirEnd) {
  Rig rig(PlainConfig());
  rig.Show(Options(3));
  rig.Wait(100 * kMs);
  rig.Press(2500 * kMs);
  EXPECT_THAT(rig.Chosen(), IsEmpty());
  EXPECT_EQ(rig.Count(Kind::kStop), 1);
}

TEST(Stop, IsFoundOutByALateTickOrByTheReleaseItself) {
  Rig rig(PlainConfig());
  rig.Show(Options(3));
  rig.Down();
  rig.now = 2100 * kMs;
  rig.Up();
  EXPECT_EQ(rig.Count(Kind::kStop), 1);
  EXPECT_THAT(rig.Chosen(), IsEmpty());
}

TEST(Stop, IsAlsoAmongTheControls) {
  Rig rig(PlainConfig());
  Page page;
  page.controls = {Control::kStart, Control::kStop};
  rig.Show(page);
  rig.Wait(1600 * kMs);
  rig.Press(100 * kMs);
  EXPECT_EQ(rig.Count(Kind::kStop), 1);
  EXPECT_TRUE(rig.scanner.stopped());
}

TEST(Resume, TakesTwoChoicesInTwoPlaces) {
  Rig rig(PlainConfig());
  rig.Show(Options(3));
  rig.Press(2000 * kMs);
  rig.Wait(100 * kMs);
  EXPECT_THAT(rig.scanner.view().controls, ElementsAre(Control::kResume));
  rig.Press(100 * kMs);
  EXPECT_TRUE(rig.scanner.view().confirming);
  EXPECT_THAT(rig.scanner.view().controls, ElementsAre(Control::kStay));
  rig.Press(100 * kMs);  // the same again: no
  EXPECT_FALSE(rig.scanner.view().confirming);
  rig.Press(100 * kMs);
  EXPECT_EQ(rig.Count(Kind::kResume), 0);
  rig.Wait(1600 * kMs);
  rig.Press(100 * kMs);
  EXPECT_EQ(rig.Count(Kind::kResume), 1);
  EXPECT_TRUE(rig.scanner.view().stopped) << "until the conversation says so";
  rig.scanner.SetStopped(rig.now, false);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(0));
  EXPECT_THAT(rig.Chosen(), IsEmpty());
}

TEST(Resume, TakesANewHoldWhereItIsByHolding) {
  Config config = PlainConfig();
  config.resume_by = ResumeBy::kHold;
  Rig rig(config);
  rig.Show(Options(3));
  rig.Press(9000 * kMs);  // the hold that stopped goes on
  EXPECT_EQ(rig.Count(Kind::kStop), 1);
  EXPECT_EQ(rig.Count(Kind::kResume), 0);
  rig.Press(1999 * kMs);
  EXPECT_EQ(rig.Count(Kind::kResume), 0);
  rig.Press(2000 * kMs);
  EXPECT_EQ(rig.Count(Kind::kResume), 1);
  EXPECT_EQ(rig.Count(Kind::kStop), 1);
}

TEST(Resume, LeavesAQuestionShownMeanwhileForAfterwards) {
  Rig rig(PlainConfig());
  rig.scanner.SetStopped(0, true);
  rig.Show(Options(3));
  EXPECT_THAT(rig.scanner.view().options, IsEmpty());
  rig.scanner.SetStopped(rig.now, false);
  EXPECT_THAT(rig.scanner.view().options, ElementsAre(0));
}

TEST(Scanner, TakesAClockThatGoesBackAsStandingStill) {
  Rig rig(PlainConfig());
  rig.now = 100 * kSecond;
  rig.Show(Options(3));
  rig.Take(rig.scanner.Tick(1));
  rig.Take(rig.scanner.OnSwitch(2, Switch::kMain, true));
  rig.Take(rig.scanner.OnSwitch(3, Switch::kMain, false));
  rig.Take(rig.scanner.Tick(101500 * kMs));
  EXPECT_EQ(rig.scanner.view().entry, -1) << "the press counted, with no length";
  EXPECT_THAT(rig.Chosen(), ElementsAre(0));
}

TEST(ScanConfig, RefusesLengthsOfPressesThatMeanTwoThings) {
  EXPECT_TRUE(Validate({}));
  EXPECT_TRUE(Validate(PlainConfig()));
  const auto refused = [](auto change) {
    Config config;
    change(config);
    return !Validate(config).ok();
  };
  EXPECT_TRUE(refused([](Config& c) { c.hold_us = c.stop_hold_us; }));
  EXPECT_TRUE(refused([](Config& c) {
    c.method = Method::kStep;
    c.step_select = StepSelect::kLongPress;
    c.long_press_us = c.stop_hold_us;
  }));
  EXPECT_TRUE(refused([](Config& c) {
    c.method = Method::kStep;
    c.step_select = StepSelect::kLongPress;
    c.hold_us = c.long_press_us;
  }));
  EXPECT_TRUE(refused([](Config& c) { c.scan_us = 0; }));
  EXPECT_TRUE(refused([](Config& c) { c.stop_hold_us = 100 * kMs; }));
  EXPECT_TRUE(refused([](Config& c) { c.rounds = -1; }));
  EXPECT_TRUE(refused([](Config& c) { c.control_share = std::nan(""); }));
}

}  // namespace
}  // namespace beckon::ui_bridge::scan
