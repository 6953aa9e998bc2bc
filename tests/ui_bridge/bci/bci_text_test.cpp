// What stands on the terminal.
#include "services/ui_bridge/bci/bci_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beckon::ui_bridge::bci {
namespace {

using ::testing::HasSubstr;

Layout TwoByTwo() {
  Layout layout;
  layout.rows = layout.columns = 2;
  layout.labels = {"Open", "Größe", "", "STOP"};
  layout.prior = {0.4, 0.4, 0, 0.2};
  return layout;
}

TEST(BciText, ShowsQuestionAndMatrix) {
  const auto text = RenderAsked("What?", TwoByTwo());
  EXPECT_EQ(text, "\nWhat?\n  Open     | Größe   \n           | STOP    \n");
}

TEST(BciText, ShowsABarUnderEachLabelThatIsThere) {
  EXPECT_EQ(RenderPosterior(TwoByTwo(), {0.75, 0.25, 0, 0}, 1),
            "  after 1 trial\n"
            "  Open     | Größe   \n"
            "  ######.. | ##......\n"
            "           | STOP    \n"
            "           | ........\n");
}

TEST(BciText, CutsLongLabelsBetweenCharacters) {
  Layout layout;
  layout.columns = 2;
  std::string umlauts;
  for (int i = 0; i < 60; ++i) umlauts += "ü";
  layout.labels = {umlauts, std::string(60, 'x')};
  const auto text = RenderAsked("", layout);
  std::string cut;
  for (int i = 0; i < 36; ++i) cut += "ü";
  EXPECT_THAT(text, HasSubstr(" " + cut + " | "));
  layout.columns = 64;
  layout.labels.assign(64, umlauts);
  EXPECT_FALSE(RenderAsked("", layout).empty());
}

TEST(BciText, UnderstandsKeys) {
  EXPECT_EQ(ParseKey("s"), Key::kStop);
  EXPECT_EQ(ParseKey(" STOP\r"), Key::kStop);
  EXPECT_EQ(ParseKey(""), Key::kNew);
  EXPECT_EQ(ParseKey("r"), Key::kResume);
  EXPECT_EQ(ParseKey("u"), Key::kUndo);
  EXPECT_EQ(ParseKey("p"), Key::kPause);
  EXPECT_EQ(ParseKey("q"), Key::kQuit);
  EXPECT_EQ(ParseKey("sx"), Key::kUnknown);
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
