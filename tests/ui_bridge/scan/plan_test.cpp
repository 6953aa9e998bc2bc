// Order, groups, and the reckoned times, which the machine itself has to confirm.
#include "services/ui_bridge/scan/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <random>

#include "services/ui_bridge/scan/pace.h"
#include "tests/ui_bridge/scan/rig.h"

namespace beckon::ui_bridge::scan {
namespace {

using ::testing::ElementsAre;

std::vector<int> InOrder(const Plan& plan) {
  std::vector<int> options;
  for (const Entry& entry : plan.levels[0].entries) {
    const auto inner = OptionsOf(plan, entry);
    options.insert(options.end(), inner.begin(), inner.end());
  }
  return options;
}

TEST(Plan, PutsTheLikeliestFirstAndNoneOfTheseLast) {
  Page page = Options(4, {0.1, 0.2, 0.15, 0.55});
  page.none_last = true;
  EXPECT_THAT(InOrder(MakePlan(PlainConfig(), page)), ElementsAre(1, 2, 0, 3));
  page.none_last = false;
  EXPECT_THAT(InOrder(MakePlan(PlainConfig(), page)), ElementsAre(3, 1, 2, 0));
  Config given = PlainConfig();
  given.order = Order::kGiven;
  EXPECT_THAT(InOrder(MakePlan(given, page)), ElementsAre(0, 1, 2, 3));
}

TEST(Plan, TakesUselessProbabilitiesAsEqual) {
  for (const std::vector<double>& odd : {std::vector<double>{},
                                         {1},
                                         {0, 0, 0},
                                         {-1, 2, 3},
                                         {std::numeric_limits<double>::quiet_NaN(), 1, 1}}) {
    EXPECT_THAT(InOrder(MakePlan(PlainConfig(), Options(3, odd))), ElementsAre(0, 1, 2));
  }
}

TEST(Plan, PutsSeveralControlsInOneGroupAfterTheOptions) {
  Page page = Options(2);
  page.controls = {Control::kUndo, Control::kStop};
  const Plan plan = MakePlan(PlainConfig(), page);
  ASSERT_EQ(plan.levels[0].entries.size(), 3u);
  EXPECT_EQ(plan.levels[0].entries[2].kind, Entry::Kind::kGroup);
  EXPECT_THAT(ControlsOf(plan, plan.levels[0].entries[2]),
              ElementsAre(Control::kUndo, Control::kStop));
  page.controls = {Control::kStop};
  EXPECT_EQ(MakePlan(PlainConfig(), page).levels[0].entries[2].kind, Entry::Kind::kControl);
}

TEST(Plan, ShowsControlsAloneWithoutAGroup) {
  Page page;
  page.controls = {Control::kStart, Control::kStop};
  EXPECT_EQ(MakePlan(PlainConfig(), page).levels.size(), 1u);
  EXPECT_TRUE(MakePlan(PlainConfig(), {}).empty());
}

TEST(Plan, GivesRowsOfTheWidthThatIsQuickest) {
  Config config = PlainConfig();
  config.grouping = Grouping::kRowColumn;
  config.columns = 4;
  const Plan rows = MakePlan(config, Options(10));
  ASSERT_EQ(rows.levels[0].entries.size(), 3u);
  EXPECT_THAT(OptionsOf(rows, rows.levels[0].entries[0]), ElementsAre(0, 1, 2, 3));
  config.columns = 0;
  const double quickest = ExpectedSeconds(MakePlan(config, Options(16)), config, Options(16));
  for (config.columns = 1; config.columns <= 16; ++config.columns) {
    EXPECT_LE(quickest, ExpectedSeconds(MakePlan(config, Options(16)), config, Options(16)) + 1e-9);
  }
}

TEST(Plan, HasABackEntryInEveryGroupWhereOneIsWanted) {
  for (const Grouping grouping : {Grouping::kRowColumn, Grouping::kBinary}) {
    Config config = PlainConfig();
    config.grouping = grouping;
    config.columns = 3;
    config.back = Back::kEntry;
    Page page = Options(9);
    page.controls = {Control::kUndo, Control::kStop};
    const Plan plan = MakePlan(config, page);
    for (size_t level = 1; level < plan.levels.size(); ++level) {
      EXPECT_EQ(plan.levels[level].entries.back().kind, Entry::Kind::kBack);
    }
    EXPECT_NE(plan.levels[0].entries.back().kind, Entry::Kind::kBack);
  }
}

/// The least expected cost of any ordered binary tree over weights i .. j-1, by trying all.
double LeastCost(const std::vector<double>& weights, size_t i, size_t j, double first,
                 double second) {
  if (j - i == 1) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (size_t cut = i + 1; cut < j; ++cut) {
    const auto sum = [&](size_t a, size_t b) {
      return std::accumulate(weights.begin() + static_cast<std::ptrdiff_t>(a),
                             weights.begin() + static_cast<std::ptrdiff_t>(b), 0.0);
    };
    least = std::min(least, LeastCost(weights, i, cut, first, second) +
                                LeastCost(weights, cut, j, first, second) + first * sum(i, cut) +
                                second * sum(cut, j));
  }
  return least;
}

TEST(Plan, CutsBinaryGroupsSoThatNoOtherCutsAreQuicker) {
  std::mt19937 engine(5);
  for (int n = 2; n <= 9; ++n) {
    for (int round = 0; round < 20; ++round) {
      std::vector<double> weights;
      for (int i = 0; i < n; ++i) weights.push_back(1 + engine() % 1000);
      std::ranges::sort(weights, std::greater<>());
      const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
      for (double& weight : weights) weight /= sum;
      Config config = PlainConfig();
      config.grouping = Grouping::kBinary;
      config.scan_us = (200 + engine() % 3000) * kMs;
      config.first_us = (engine() % 1000) * kMs;
      const Pace pace(config);
      const double least = LeastCost(weights, 0, weights.size(), pace.Choose_us(0, 1) / 1e6,
                                     pace.Choose_us(1, 1) / 1e6);
      const Page page = Options(n, weights);
      EXPECT_NEAR(ExpectedSeconds(MakePlan(config, page), config, page), least, 1e-6)
          << n << " options, round " << round;
    }
  }
}

/// Chooses `target` as Config says of the user; the time it took.
class Chooser {
 public:
  Chooser(Rig& rig, int target) : rig_(rig), config_(rig.scanner.config()), target_(target) {}

  Utime Run() {
    const Utime begun = rig_.now;
    free_ = begun;
    may_press_ = begun + config_.guard_us;
    for (int presses = 0; rig_.Chosen().empty(); ++presses) {
      if (presses > 500 || !OneStep()) return -1;
    }
    return rig_.actions.back().first - begun;
  }

 private:
  bool Lit() const {
    const auto options = rig_.scanner.view().options;
    return std::ranges::find(options, target_) != options.end();
  }

  bool OneStep() {
    switch (config_.method) {
      case Method::kAutomatic:
        if (!AwaitLit()) return false;
        return PressFor(Length(), Switch::kMain);
      case Method::kStep:
        return Step();
      case Method::kInverse:
        return HoldUntilLit();
    }
    return false;
  }

  bool AwaitLit() {
    Utime lit = free_;
    while (!Lit()) {
      if (!rig_.StepTo(rig_.now + 1000 * kSecond)) return false;
      lit = rig_.now;
    }
    free_ = std::max(free_, lit);
    return true;
  }

  bool Step() {
    if (!Lit()) return PressFor(Length(), Switch::kMain);
    switch (config_.step_select) {
      case StepSelect::kSecondSwitch:
        return PressFor(Length(), Switch::kSelect);
      case StepSelect::kLongPress:
        return PressFor(std::max(config_.long_press_us, config_.debounce_us), Switch::kMain);
      case StepSelect::kDwell:
        if (!rig_.StepTo(rig_.now + config_.dwell_us)) return false;
        free_ = rig_.now;
        return true;
    }
    return false;
  }

  bool HoldUntilLit() {
    BeginPress(Switch::kMain);
    while (!Lit()) {
      if (!rig_.StepTo(rig_.now + 1000 * kSecond)) return false;
    }
    rig_.Wait(Reaction_us(config_));
    EndPress(Switch::kMain);
    return true;
  }

  Utime Length() const {
    return std::max({config_.press_us, config_.hold_us, config_.debounce_us});
  }

  bool PressFor(Utime length, Switch which) {
    BeginPress(which);
    rig_.Wait(length);
    if (!rig_.Chosen().empty()) return true;
    EndPress(which);
    return true;
  }

  void BeginPress(Switch which) {
    rig_.Until(std::max(free_ + Reaction_us(config_), may_press_));
    rig_.Down(which);
  }

  void EndPress(Switch which) {
    rig_.Up(which);
    may_press_ = rig_.now + config_.ignore_repeat_us;
    rig_.Wait(config_.debounce_us);
    free_ = rig_.now;
  }

  Rig& rig_;
  const Config config_;
  const int target_;
  Utime free_ = 0;       // what is lit has been lit, and the switch free, since
  Utime may_press_ = 0;  // presses count from then on
};

Config RandomConfig(std::mt19937& engine) {
  const auto draw = [&](Utime lo, Utime hi) {
    return (lo + static_cast<Utime>(engine() % static_cast<uint64_t>(hi - lo + 1))) * kMs;
  };
  Config config;
  config.scan_us = draw(600, 3000);
  config.first_us = draw(0, 1500);
  config.reaction_us = draw(100, 599);
  config.press_us = draw(20, 300);
  config.hold_us = engine() % 2 == 0 ? 0 : draw(1, 250);
  config.debounce_us = engine() % 3 == 0 ? 0 : draw(1, 15);
  config.ignore_repeat_us = engine() % 3 == 0 ? 0 : draw(50, 590);
  config.guard_us = engine() % 3 == 0 ? 0 : draw(1, 590);
  config.dwell_us = draw(601, 3000);
  config.long_press_us = draw(320, 1500);
  config.accept = engine() % 2 == 0 ? Accept::kPress : Accept::kRelease;
  config.back = engine() % 2 == 0 ? Back::kPass : Back::kEntry;
  config.columns = static_cast<int>(engine() % 5);
  return config;
}

class ExpectedTime : public ::testing::TestWithParam<std::tuple<Method, StepSelect, Grouping>> {};

TEST_P(ExpectedTime, IsExactlyWhatTheMachineTakesForEveryOption) {
  const auto [method, select, grouping] = GetParam();
  std::mt19937 engine(11);
  for (int round = 0; round < 40; ++round) {
    Config config = RandomConfig(engine);
    config.method = method;
    config.step_select = select;
    config.grouping = grouping;
    ASSERT_TRUE(Validate(config)) << Validate(config).error().message;
    Page page = Options(1 + static_cast<int>(engine() % 12));
    for (int i = 0; i < page.n_options; ++i) page.probabilities.push_back(1 + engine() % 50);
    page.none_last = engine() % 2 == 0;
    if (engine() % 2 == 0) page.controls = {Control::kUndo, Control::kPause, Control::kStop};
    const Plan plan = MakePlan(config, page);
    double expected = 0;
    const double sum = std::accumulate(page.probabilities.begin(), page.probabilities.end(), 0.0);
    for (int option = 0; option < page.n_options; ++option) {
      Rig rig(config);
      rig.now = 7 * kSecond;
      rig.Show(page);
      const Utime took = Chooser(rig, option).Run();
      ASSERT_THAT(rig.Chosen(), ElementsAre(option)) << "round " << round;
      ASSERT_EQ(took, TimeToOption(plan, config, option)) << "round " << round;
      expected += page.probabilities[static_cast<size_t>(option)] / sum *
                  static_cast<double>(took) / kSecond;
    }
    EXPECT_NEAR(ExpectedSeconds(plan, config, page), expected, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(
    EveryWay, ExpectedTime,
    ::testing::Combine(
        ::testing::Values(Method::kAutomatic, Method::kStep, Method::kInverse),
        ::testing::Values(StepSelect::kSecondSwitch, StepSelect::kDwell, StepSelect::kLongPress),
        ::testing::Values(Grouping::kLinear, Grouping::kRowColumn, Grouping::kBinary)));

TEST(ExpectedTime, IsNothingForWhatIsNotOnOffer) {
  const Plan plan = MakePlan(PlainConfig(), Options(3));
  EXPECT_FALSE(TimeToOption(plan, PlainConfig(), 3));
  EXPECT_FALSE(TimeToControl(plan, PlainConfig(), Control::kUndo));
  EXPECT_FALSE(TimeToOption({}, PlainConfig(), 0));
}

TEST(ExpectedTime, OfSixteenEqualOptionsIsLeastInGroups) {
  Config config = PlainConfig();
  const Page page = Options(16);
  const auto seconds = [&](Grouping grouping) {
    config.grouping = grouping;
    return ExpectedSeconds(MakePlan(config, page), config, page);
  };
  EXPECT_LT(seconds(Grouping::kRowColumn), seconds(Grouping::kLinear));
  EXPECT_LT(seconds(Grouping::kBinary), seconds(Grouping::kLinear));
}

}  // namespace
}  // namespace beckon::ui_bridge::scan
