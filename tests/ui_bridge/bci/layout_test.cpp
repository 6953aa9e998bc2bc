// Which class stands for what.
#include "services/ui_bridge/bci/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace beckon::ui_bridge::bci {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

msg::Query Question(const std::vector<std::string>& options, int asked = 1) {
  msg::Query query;
  query.questions_asked = asked;
  for (const auto& option : options) query.options.push_back({.text = option});
  return query;
}

LayoutConfig Matrix(int rows, int columns, std::vector<Control> controls = {}) {
  return {.rows = rows, .columns = columns, .controls = std::move(controls)};
}

TEST(Layout, PutsOptionsFirstAndControlsLast) {
  const auto config = Matrix(2, 3, {Control::kUndo, Control::kStop});
  EXPECT_EQ(MaxOptions(config), 4u);
  const auto layout = LayOut(config, Question({"A", "B", "C"}));
  ASSERT_TRUE(layout);
  EXPECT_THAT(layout->labels, ElementsAre("A", "B", "C", "", "Undo", "STOP"));
  EXPECT_EQ(layout->prior[3], 0);
  EXPECT_NEAR(std::accumulate(layout->prior.begin(), layout->prior.end(), 0.0), 1, 1e-12);
  EXPECT_EQ(layout->controls[5], Control::kStop);
  EXPECT_EQ(ClassOf(config, Control::kStop), 5u);
  EXPECT_FALSE(ClassOf(config, Control::kPause));
}

TEST(Layout, ARefusedQuestionSaysWhy) {
  const auto layout = LayOut(Matrix(2, 2, {Control::kStop}), Question({"A", "B", "C", "D"}));
  ASSERT_FALSE(layout);
  EXPECT_THAT(layout.error().message, HasSubstr("4 answers"));
  EXPECT_THAT(layout.error().message, HasSubstr("3 classes"));
}

TEST(Layout, TwoClassesTakeYesAndNoAndNothingElse) {
  LayoutConfig config{.mode = msg::StimulusMode::kBinary};
  EXPECT_EQ(MaxOptions(config), 2u);
  EXPECT_EQ(LayOut(config, Question({"Yes", "No"}))->columns, 2);
  EXPECT_FALSE(LayOut(config, Question({"A", "B", "C"})));
  config.controls = {Control::kStop};
  const auto layout = LayOut(config, Question({"Yes", "No"}));
  EXPECT_THAT(layout->labels, ElementsAre("Yes", "No", "STOP"));
  EXPECT_EQ(layout->rows * layout->columns, 3);
}

TEST(Layout, UndoIsOnlyThereWhereThereIsAnAnswerToTakeBack) {
  const auto config = Matrix(2, 2, {Control::kUndo});
  EXPECT_EQ(LayOut(config, Question({"Yes", "No"}, 0))->labels[3], "");
  EXPECT_EQ(LayOut(config, Question({"Yes", "No"}, 1))->labels[3], "Undo");
}

TEST(Layout, ProspectsAreThePrior) {
  auto query = Question({"A", "B"});
  query.prospects = {{.probability = 0.8f, .questions_left = 0}, {0.0f, 3, 10}};
  const auto layout = LayOut(Matrix(1, 3), query);
  EXPECT_NEAR(layout->prior[0], 0.8 / 0.81, 1e-6);
  EXPECT_GT(layout->prior[1], 0);  // they may be wrong
  EXPECT_THAT(layout->ends, ElementsAre(true, false, false));
  EXPECT_NEAR(LayOut(Matrix(1, 3), Question({"A", "B"}))->prior[0], 0.5, 1e-12);
}

TEST(Layout, ControlsTwiceOrTooManyAreRefused) {
  EXPECT_TRUE(Check(Matrix(2, 2, {Control::kStop, Control::kUndo})));
  EXPECT_FALSE(Check(Matrix(2, 2, {Control::kStop, Control::kStop})));
  EXPECT_FALSE(Check(Matrix(2, 2, {Control::kStop, Control::kUndo, Control::kPause})));
  EXPECT_FALSE(Check(Matrix(1, 1)));
  EXPECT_FALSE(Check(Matrix(64, 2)));
}

TEST(Layout, EveryQuestionThatFitsIsWholeAndItsPriorSumsToOne) {
  for (int rows = 1; rows <= 6; ++rows) {
    for (int columns = 1; columns <= 6; ++columns) {
      const auto config = Matrix(rows, columns, {Control::kStop});
      if (!Check(config)) continue;
      for (size_t n = 2; n <= MaxOptions(config); ++n) {
        const auto layout = LayOut(config, Question(std::vector<std::string>(n, "x")));
        ASSERT_TRUE(layout);
        EXPECT_EQ(layout->labels.size(), static_cast<size_t>(rows * columns));
        EXPECT_EQ(std::count(layout->labels.begin(), layout->labels.end(), "x"),
                  static_cast<long>(n));
        EXPECT_NEAR(std::accumulate(layout->prior.begin(), layout->prior.end(), 0.0), 1, 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
