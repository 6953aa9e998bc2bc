// The page's scanner: what it offers when, and what a choice means for the conversation.
#include "services/ui_bridge/web/page_scanner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "services/ui_bridge/web/settings.h"
#include "tests/draws.h"

namespace beckon::ui_bridge::web {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsSupersetOf;

scan::Config OneSwitch() { return ScanConfig(Presets().at("one_switch")); }

PageState Asked(int64_t id, int questions_asked = 0) {
  PageState state{.phase = Phase::kRunning};
  state.query = msg::Query{.id = id, .options = {{.text = "Yes"}, {.text = "No"}}};
  state.query->questions_asked = questions_asked;
  return state;
}

class PageScannerTest : public ::testing::Test {
 protected:
  /// Lets time pass until `lit`, pressing nothing.
  bool WaitFor(const std::function<bool(const msg::Highlight&)>& lit) {
    for (int i = 0; i < 1000; ++i) {
      if (lit(scanner_.highlight())) return true;
      const auto next = scanner_.NextDeadline();
      if (!next) return false;
      now_ = std::max(now_, *next);
      for (auto& choice : scanner_.Tick(now_)) chosen_.push_back(choice);
      scanner_.Update(now_, state_, trial_);
    }
    return false;
  }
  bool WaitForControl(const std::string& name) {
    return WaitFor([&](const auto& lit) { return lit.controls == std::vector{name}; });
  }
  void Press(Utime length_us = 100'000) {
    now_ += 400'000;
    for (auto& choice : scanner_.OnSwitch(now_, scan::Switch::kMain, true))
      chosen_.push_back(choice);
    const Utime up = now_ + length_us;
    while (scanner_.NextDeadline() && *scanner_.NextDeadline() < up) {
      now_ = *scanner_.NextDeadline();
      for (auto& choice : scanner_.Tick(now_)) chosen_.push_back(choice);
      scanner_.Update(now_, state_, trial_);
    }
    now_ = up;
    for (auto& choice : scanner_.OnSwitch(now_, scan::Switch::kMain, false))
      chosen_.push_back(choice);
  }
  void Show(PageState state, bool trial = false) {
    state_ = std::move(state);
    trial_ = trial;
    scanner_.Update(now_, state_, trial_);
  }
  /// The one request that was chosen.
  msg::SessionKind Request() const {
    EXPECT_EQ(chosen_.size(), 1u);
    if (chosen_.empty()) return msg::SessionKind::kIdle;
    const auto* request = std::get_if<ScannedRequest>(&chosen_.back());
    EXPECT_NE(request, nullptr);
    return request == nullptr ? msg::SessionKind::kIdle : request->request;
  }

  Utime now_ = kSecond;
  PageScanner scanner_{OneSwitch()};
  PageState state_;
  bool trial_ = false;
  std::vector<Scanned> chosen_;
};

TEST_F(PageScannerTest, AnswersTheQuestionWithWhatIsLit) {
  Show(Asked(7));
  EXPECT_EQ(scanner_.highlight().query_id, 7);
  ASSERT_TRUE(WaitFor([](const auto& lit) { return lit.options == std::vector{1}; }));
  Press();
  ASSERT_EQ(chosen_.size(), 1u);
  const auto& answer = std::get<ScannedAnswer>(chosen_[0]);
  EXPECT_EQ(answer.query_id, 7);
  EXPECT_EQ(answer.option, 1);
}

TEST_F(PageScannerTest, OffersUndoOnceSomethingWasAnsweredAndNoneOfTheseWhereNoOptionSaysIt) {
  Show(Asked(7));
  EXPECT_THAT(scanner_.controls(), ElementsAre("none", "pause", "stop"));
  Show(Asked(8, 1));
  EXPECT_THAT(scanner_.controls(), ElementsAre("undo", "none", "pause", "stop"));
  PageState choice = Asked(9, 1);
  choice.query->kind = msg::QueryKind::kChoice;
  choice.query->options = {{.text = "A", .actions = {"Open"}}, {.text = "none"}};
  Show(choice);
  EXPECT_THAT(scanner_.controls(), ElementsAre("undo", "pause", "stop"));
}

TEST_F(PageScannerTest, ReachesEveryControlAndMeansIt) {
  const std::pair<const char*, msg::SessionKind> controls[] = {
      {"undo", msg::SessionKind::kRequestUndo},
      {"none", msg::SessionKind::kRequestNoneOfThese},
      {"stop", msg::SessionKind::kRequestStop}};
  int64_t id = 10;
  for (const auto& [name, meant] : controls) {
    chosen_.clear();
    Show(Asked(++id, 1));
    ASSERT_TRUE(WaitFor([](const auto& lit) { return lit.controls.size() > 1; })) << "their group";
    Press();
    ASSERT_TRUE(WaitForControl(name)) << name;
    Press();
    EXPECT_EQ(Request(), meant) << name;
  }
}

TEST_F(PageScannerTest, BeginsAConversationWhereNoneRuns) {
  Show({});
  EXPECT_THAT(scanner_.controls(), ElementsAre("start", "stop"));
  ASSERT_TRUE(WaitForControl("start"));
  EXPECT_EQ(scanner_.highlight().query_id, 0);
  Press();
  EXPECT_EQ(Request(), msg::SessionKind::kRequestStart);
}

TEST_F(PageScannerTest, StopsByHoldingWhateverIsShown) {
  PageState stopped{.phase = Phase::kStopped};
  PageState answered = Asked(7);
  answered.answered = true;
  for (const PageState& state : {PageState{}, Asked(8), answered}) {
    Show(state);
    chosen_.clear();
    Press(3 * kSecond);
    EXPECT_EQ(Request(), msg::SessionKind::kRequestStop);
    Show(stopped);
    Show({});
  }
}

TEST_F(PageScannerTest, LeavesAStopOnlyByTwoChoices) {
  Show({.phase = Phase::kStopped});
  EXPECT_THAT(scanner_.controls(), ElementsAre("resume", "stay"));
  ASSERT_TRUE(WaitForControl("resume"));
  Press();
  EXPECT_TRUE(chosen_.empty());
  ASSERT_TRUE(WaitForControl("resume"));
  Press();
  EXPECT_EQ(Request(), msg::SessionKind::kRequestResume);
}

TEST_F(PageScannerTest, LightsNothingBetweenTwoQuestionsButOffersStopWhenTheNextDoesNotCome) {
  Show(Asked(7, 1));
  state_.answered = true;
  Show(state_);
  EXPECT_THAT(scanner_.highlight().options, ElementsAre());
  EXPECT_THAT(scanner_.highlight().controls, ElementsAre());
  ASSERT_TRUE(WaitForControl("stop"));
  Press();
  EXPECT_EQ(Request(), msg::SessionKind::kRequestStop);
}

TEST_F(PageScannerTest, StaysWhereItIsWhileTheQuestionStands) {
  Show(Asked(7));
  ASSERT_TRUE(WaitFor([](const auto& lit) { return lit.options == std::vector{1}; }));
  state_.notice = "something else changed";
  Show(state_);
  EXPECT_THAT(scanner_.highlight().options, ElementsAre(1));
}

TEST_F(PageScannerTest, AsksWhetherToKeepSettingsOnTrial) {
  Show(Asked(7), /*trial=*/true);
  EXPECT_THAT(scanner_.controls(), ElementsAre("keep", "revert"));
  EXPECT_EQ(scanner_.highlight().query_id, 0);
  ASSERT_TRUE(WaitForControl("keep"));
  EXPECT_THAT(scanner_.highlight().options, ElementsAre());
  Press();
  ASSERT_EQ(chosen_.size(), 1u);
  EXPECT_TRUE(std::get<ScannedTrial>(chosen_[0]).keep);
  chosen_.clear();
  Show(Asked(7), false);
  Show(Asked(7), true);
  ASSERT_TRUE(WaitForControl("revert"));
  Press();
  ASSERT_EQ(chosen_.size(), 1u);
  EXPECT_FALSE(std::get<ScannedTrial>(chosen_[0]).keep);
}

double SecondsTo(const scan::Config& config, int option) {
  const scan::Page page{.n_options = 6, .controls = {scan::Control::kStop}};
  return static_cast<double>(*scan::TimeToOption(scan::MakePlan(config, page), config, option)) /
         kSecond;
}

TEST(ScanSeconds, AreRightOnAverageAndExactForLinearGrouping) {
  scan::Config config = OneSwitch();
  auto seconds = ExpectedScanSeconds(config, 6);
  double error = 0;
  for (int i = 0; i < 6; ++i)
    error += seconds.per_question + seconds.per_option * (i + 1) - SecondsTo(config, i);
  EXPECT_NEAR(error, 0, 0.01);
  config.first_us = 0;
  config.reaction_us = 1'400'000;
  seconds = ExpectedScanSeconds(config, 6);
  EXPECT_NEAR(seconds.per_option, static_cast<double>(config.scan_us) / kSecond, 1e-9);
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(seconds.per_question + seconds.per_option * (i + 1), SecondsTo(config, i), 1e-6);
}

TEST(ScanSeconds, ArePositiveForAnySettings) {
  for (const char* method : {"automatic", "step", "inverse"}) {
    for (const char* grouping : {"linear", "row_column", "binary"}) {
      for (const int n : {2, 3, 6, 64}) {
        Settings settings{.access = "two_switches"};
        settings.scan.method = method;
        settings.scan.grouping = grouping;
        const auto seconds = ExpectedScanSeconds(ScanConfig(settings), n);
        EXPECT_GT(seconds.per_question, 0) << method << ' ' << grouping << ' ' << n;
        EXPECT_GE(seconds.per_option, 0);
      }
    }
  }
}

/// Whatever is shown and pressed: an answer is one of the question that stands, and at most one.
TEST(PageScanner, AnswersNothingButTheQuestionThatStands) {
  int answers = 0;
  for (unsigned round = 0; round < 300; ++round) {
    Draws draws(round);
    PageScanner scanner(OneSwitch());
    Utime now = kSecond;
    PageState state;
    std::set<int64_t> answered;
    int64_t id = 0;
    bool down = false;
    for (int step = 0; step < 300; ++step) {
      now += draws.Between(0, 2'000'000);
      std::vector<Scanned> chosen;
      if (draws.OneIn(8)) state = draws.OneIn(3) ? PageState{} : Asked(++id, draws.Between(0, 1));
      if (draws.OneIn(40)) state.phase = Phase::kStopped;
      scanner.Update(now, state, draws.OneIn(30));
      if (draws.OneIn(2)) chosen = scanner.OnSwitch(now, scan::Switch::kMain, down = !down);
      if (chosen.empty()) chosen = scanner.Tick(now);
      for (const auto& choice : chosen) {
        const auto* answer = std::get_if<ScannedAnswer>(&choice);
        if (answer == nullptr) continue;
        ++answers;
        ASSERT_TRUE(state.query && state.phase == Phase::kRunning);
        ASSERT_EQ(answer->query_id, state.query->id);
        ASSERT_TRUE(answer->option == 0 || answer->option == 1);
        ASSERT_TRUE(answered.insert(answer->query_id).second);
        state.answered = true;
      }
    }
  }
  EXPECT_GT(answers, 100);
}

}  // namespace
}  // namespace beckon::ui_bridge::web
