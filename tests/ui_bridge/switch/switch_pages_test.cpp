#include "services/ui_bridge/switch/switch_pages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beckon::ui_bridge {
namespace {

using scan::Control;
using ::testing::ElementsAre;

msg::Query YesNo() {
  msg::Query query;
  query.id = 7;
  query.kind = msg::QueryKind::kFull;
  query.text = "Open the carton?";
  query.options = {{.text = "Yes"}, {.text = "No"}};
  return query;
}

TEST(QuestionPages, OfferWhatCanBeDone) {
  msg::Query query = YesNo();
  scan::Page page = QuestionPage(query);
  EXPECT_EQ(page.id, 7);
  EXPECT_EQ(page.n_options, 2);
  EXPECT_FALSE(page.none_last);
  EXPECT_THAT(page.controls, ElementsAre(Control::kNone, Control::kPause, Control::kStop));
  query.questions_asked = 1;
  query.kind = msg::QueryKind::kChoice;
  query.prospects = {{.probability = 0.25f}, {.probability = 0.75f}};
  page = QuestionPage(query, 0.1);
  EXPECT_TRUE(page.none_last);
  EXPECT_THAT(page.controls, ElementsAre(Control::kUndo, Control::kPause, Control::kStop));
  EXPECT_THAT(page.probabilities, ElementsAre(0.25, 0.75));
  EXPECT_EQ(page.read_us, 1'600'000);
  query.text = std::string(5000, 'a');
  EXPECT_EQ(QuestionPage(query, 0.1).read_us, 10 * kSecond);
}

TEST(LitWords, AreWhatAPressWouldTake) {
  const msg::Query query = YesNo();
  scan::View view;
  EXPECT_EQ(LitWords(view, &query), "");
  view.entry = 0;
  view.options = {1};
  EXPECT_EQ(LitWords(view, &query), "No");
  view.options = {0, 1};
  view.group = true;
  view.controls = {Control::kUndo, Control::kStop};
  EXPECT_EQ(LitWords(view, &query), "Yes, No, Menu");
  view.options = {};
  EXPECT_EQ(LitWords(view, &query), "Menu");
  view.group = false;
  view.controls = {Control::kUndo};
  EXPECT_EQ(LitWords(view, nullptr), "Undo");
  view.options = {5};  // of another question
  view.controls = {};
  EXPECT_EQ(LitWords(view, &query), "");
}

TEST(Highlights, NameOptionsOfTheQuestionOnly) {
  scan::View view;
  view.page = 7;
  view.options = {1};
  view.controls = {Control::kStop};
  view.dwell_us = 1'500'000;
  view.pressed = true;
  msg::Highlight highlight = HighlightOf(view, true);
  EXPECT_EQ(highlight.query_id, 7);
  EXPECT_THAT(highlight.options, ElementsAre(1));
  EXPECT_THAT(highlight.controls, ElementsAre("stop"));
  EXPECT_EQ(highlight.dwell_ms, 1500);
  EXPECT_TRUE(highlight.pressed);
  highlight = HighlightOf(view, false);
  EXPECT_EQ(highlight.query_id, 0);
  EXPECT_TRUE(highlight.options.empty());
}

TEST(SuggestionWords, SayWhatIsAndWhatWouldBe) {
  scan::ScanSuggestion suggestion;
  suggestion.scan_us = 900'000;
  suggestion.estimate.mean_us = 585'000;
  EXPECT_EQ(SuggestionWords(suggestion, 1'500'000),
            "Your presses take about 0.58 s. Scan every 0.9 s instead of every 1.5 s?");
  suggestion.because_undone = true;
  EXPECT_THAT(SuggestionWords(suggestion, 750'000), ::testing::HasSubstr("taken back"));
}

}  // namespace
}  // namespace beckon::ui_bridge
