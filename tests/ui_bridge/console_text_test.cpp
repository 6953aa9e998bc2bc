// What typed lines mean and how questions read.
#include "services/ui_bridge/console_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beckon::ui_bridge {
namespace {

using Kind = ConsoleInput::Kind;
using ::testing::HasSubstr;
using ::testing::Not;

msg::Query YesNo() {
  msg::Query query;
  query.text = "Open the carton?";
  query.questions_asked = 2;
  query.expected_questions = 3.2;
  query.options = {{.text = "Yes"}, {.text = "No"}};
  return query;
}

msg::Query WhatIsIt() {
  msg::Query query;
  query.kind = msg::QueryKind::kWhatIsIt;
  query.text = "What is this?";
  query.expected_questions = 1;
  query.options = {{.text = "a box", .category = "Box"},
                   {.text = "a tin", .category = "Tin"},
                   {.text = "None of these"}};
  return query;
}

TEST(ConsoleText, UnderstandsTheLanguageOfTheQuestion) {
  auto query = YesNo();
  query.options = {{.text = "Ja"}, {.text = "Nein"}};
  EXPECT_EQ(ParseLine("j", &query).option, 0u);
  EXPECT_EQ(ParseLine("NEIN", &query).option, 1u);
  EXPECT_EQ(ParseLine("y", &query).kind, Kind::kUnknown);
  EXPECT_NE(RenderQuestion(query, nullptr, {.brief = true}).find("j = ja, n = nein"),
            std::string::npos);
}

TEST(ConsoleText, NumbersTheOptionsOfAChoiceAndTakesTheirTexts) {
  msg::Query query;
  query.kind = msg::QueryKind::kChoice;
  query.text = "Which one?";
  query.options = {{.text = "Open the carton", .actions = {"Open"}, .objects = {1}},
                   {.text = "None of these"}};
  const std::string shown = RenderQuestion(query, nullptr, {.brief = true});
  EXPECT_NE(shown.find("  1  Open the carton\n  2  None of these\n"), std::string::npos) << shown;
  EXPECT_NE(shown.find("1 to 2 = that one"), std::string::npos) << shown;
  EXPECT_EQ(ParseLine("2", &query).option, 1u);
  EXPECT_EQ(ParseLine("open the carton", &query).option, 0u);
  EXPECT_EQ(ParseLine("o", &query).kind, Kind::kUnknown);
}

TEST(ConsoleText, UnderstandsYesAndNoInAnyCase) {
  const auto query = YesNo();
  for (const char* line : {"y", "Y", " yes ", "YES\r", "1"}) {
    const auto input = ParseLine(line, &query);
    EXPECT_EQ(input.kind, Kind::kOption) << line;
    EXPECT_EQ(input.option, 0u) << line;
  }
  for (const char* line : {"n", "No", "2"}) EXPECT_EQ(ParseLine(line, &query).option, 1u) << line;
}

TEST(ConsoleText, NumbersPickOptionsFromOne) {
  const auto query = WhatIsIt();
  EXPECT_EQ(ParseLine("3", &query).option, 2u);
  for (const char* line : {"4", "-1", "1x", "99999999999999999999", "y"}) {
    EXPECT_EQ(ParseLine(line, &query).kind, Kind::kUnknown) << line;
  }
}

TEST(ConsoleText, CommandsNeedNoQuestion) {
  EXPECT_EQ(ParseLine("s", nullptr).kind, Kind::kStop);
  EXPECT_EQ(ParseLine("STOP", nullptr).kind, Kind::kStop);
  EXPECT_EQ(ParseLine("r", nullptr).kind, Kind::kResume);
  EXPECT_EQ(ParseLine("u", nullptr).kind, Kind::kUndo);
  EXPECT_EQ(ParseLine("0", nullptr).kind, Kind::kNoneOfThese);
  EXPECT_EQ(ParseLine("none of these", nullptr).kind, Kind::kNoneOfThese);
  EXPECT_EQ(ParseLine("q", nullptr).kind, Kind::kQuit);
  EXPECT_EQ(ParseLine("", nullptr).kind, Kind::kNothing);
  EXPECT_EQ(ParseLine("y", nullptr).kind, Kind::kUnknown);
}

TEST(ConsoleText, SaysWhatMayBeTypedInstead) {
  const auto query = YesNo();
  EXPECT_THAT(ParseLine("maybe", &query).complaint, HasSubstr("y = yes, n = no"));
  EXPECT_LT(ParseLine(std::string(100'000, 'x'), &query).complaint.size(), 200u);
}

TEST(ConsoleText, ShowsQuestionProgressAndOptions) {
  const auto text = RenderQuestion(YesNo(), nullptr, {});
  EXPECT_THAT(text, HasSubstr("Question 3, about 2 more"));
  EXPECT_THAT(text, HasSubstr("Open the carton?"));
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  const auto list = RenderQuestion(WhatIsIt(), nullptr, {.terminal = true});
  EXPECT_THAT(list, HasSubstr("2  a tin"));
  EXPECT_THAT(list, Not(HasSubstr("more")));
  EXPECT_THAT(list, HasSubstr("\x1b[1mWhat is this?"));
}

TEST(ConsoleText, TellsWhereTheObjectStandsThatHasNoName) {
  msg::Scene scene;
  for (const double x : {0.3, -0.2, 0.0}) {
    msg::SceneObject object;
    object.id = static_cast<int>(scene.objects.size()) + 1;
    object.category = "Box";
    object.ask_user = x == 0;
    object.centroid_W = {x, 0.4, 0.1};
    scene.objects.push_back(object);
  }
  auto query = WhatIsIt();
  query.kind = msg::QueryKind::kWhatIsIt;
  query.objects = {{1, "Unknown", 1}};
  EXPECT_THAT(RenderQuestion(query, &scene, {}),
              HasSubstr("number 3 of 3 from the left, 50 cm away"));
  query.objects = {{9, "Unknown", 1}};
  EXPECT_THAT(RenderQuestion(query, &scene, {}), Not(HasSubstr("from the left")));
  EXPECT_THAT(RenderScene(scene, {}),
              HasSubstr("2. box, perhaps (40 cm away)\n  3. box (50 cm away)"));
  EXPECT_THAT(RenderScene(scene, {{3, "SprayCan"}}), HasSubstr("2. spray can (40 cm away)"));
  scene.objects[0].category = msg::kUnknownCategory;
  EXPECT_THAT(RenderScene(scene, {}), HasSubstr("3. something unknown"));
}

TEST(ConsoleText, PointsAtTheOneObjectOfAQuestion) {
  msg::Scene scene;
  scene.objects.resize(1);
  scene.objects[0].id = 4;
  scene.objects[0].centroid_W = {0, 0.5, 0.1};
  auto query = YesNo();
  query.any_object = false;
  query.objects = {{4, "Carton", 1}};
  EXPECT_THAT(RenderQuestion(query, &scene, {}), HasSubstr("-> number 1 of 1 from the left"));
  query.any_object = true;
  EXPECT_THAT(RenderQuestion(query, &scene, {}), Not(HasSubstr("->")));
}

TEST(ConsoleText, ShowsAllCommandsOnceAndThenOnRequest) {
  const auto query = YesNo();
  EXPECT_THAT(RenderQuestion(query, nullptr, {}), HasSubstr("u = undo"));
  const auto brief = RenderQuestion(query, nullptr, {.brief = true});
  EXPECT_THAT(brief, HasSubstr("y = yes, n = no, ? = help"));
  EXPECT_THAT(brief, Not(HasSubstr("undo")));
  for (const char* line : {"?", "h", "Help"}) EXPECT_EQ(ParseLine(line, &query).kind, Kind::kHelp);
  EXPECT_THAT(RenderHelp(nullptr), HasSubstr("s = stop"));
}

TEST(ConsoleText, TellsWhatASessionWaitsForAndHowItEnds) {
  msg::Session event;
  event.kind = msg::SessionKind::kBegun;
  event.text = "waiting for a scene";
  EXPECT_EQ(RenderSession(event), "waiting for a scene");
  event.kind = msg::SessionKind::kConfirmed;
  event.text = "open the carton";
  event.questions = 1;
  EXPECT_EQ(RenderSession(event), "\nThe robot was told: open the carton (1 question)");
  event.kind = msg::SessionKind::kStopped;
  EXPECT_THAT(RenderSession(event), HasSubstr("resume"));
}

}  // namespace
}  // namespace beckon::ui_bridge
