// Which option a confirmed task makes right.
#include "services/ui_bridge/bci/session_trials.h"

#include <gtest/gtest.h>

namespace beckon::ui_bridge::bci {
namespace {

msg::Task OpenTheCarton() {
  msg::Task task;
  task.task_id = "s";
  task.action = "Open";
  task.object = {7, "Carton", 1};
  return task;
}

msg::Query YesNo(msg::QueryKind kind, const std::vector<std::string>& actions,
                 const std::vector<msg::ObjectRef>& objects) {
  msg::Query query;
  query.session_id = "s";
  query.kind = kind;
  query.any_action = actions.empty();
  query.actions = actions;
  query.any_object = objects.empty();
  query.objects = objects;
  query.options = {{.text = "Yes"}, {.text = "No"}};
  return query;
}

msg::Query Choice() {
  msg::Query query;
  query.session_id = "s";
  query.kind = msg::QueryKind::kChoice;
  query.objects = {{7, "Carton", 1}, {8, "Mug", 1}};
  query.options = {{.text = "Pour", .actions = {"Pour"}},
                   {.text = "Open the carton", .actions = {"Open"}, .objects = {7}},
                   {.text = "Open something", .actions = {"Open"}},
                   {.text = "None of these"}};
  return query;
}

msg::Query WhatIsIt(int object) {
  msg::Query query;
  query.session_id = "s";
  query.kind = msg::QueryKind::kWhatIsIt;
  query.any_object = false;
  query.objects = {{object, "Box", 1}};
  query.options = {{.text = "a box", .category = "Box"},
                   {.text = "a carton", .category = "Carton"},
                   {.text = "None of these", .category = "Unknown"}};
  return query;
}

TEST(RightOption, OfAYesNoQuestionIsWhetherActionAndObjectHold) {
  using Kind = msg::QueryKind;
  const auto task = OpenTheCarton();
  EXPECT_EQ(RightOption(YesNo(Kind::kAction, {"Open"}, {}), task), 0u);
  EXPECT_EQ(RightOption(YesNo(Kind::kAction, {"Pour", "Open"}, {}), task), 0u);
  EXPECT_EQ(RightOption(YesNo(Kind::kAction, {"Pour"}, {}), task), 1u);
  EXPECT_EQ(RightOption(YesNo(Kind::kObject, {}, {{8, "Mug", 1}}), task), 1u);
  EXPECT_EQ(RightOption(YesNo(Kind::kSet, {}, {{8, "Mug", 1}, {7, "Carton", 1}}), task), 0u);
  EXPECT_EQ(RightOption(YesNo(Kind::kFull, {"Pour"}, {{7, "Carton", 1}}), task), 1u);
  EXPECT_EQ(RightOption(YesNo(Kind::kFull, {"Open"}, {{7, "Carton", 1}}), task), 0u);
}

TEST(RightOption, AnObjectCalledWrongIsNotTheOneWanted) {
  EXPECT_EQ(RightOption(YesNo(msg::QueryKind::kFull, {"Open"}, {{7, "Box", 1}}), OpenTheCarton()),
            1u);
}

TEST(RightOption, OfAChoiceIsTheFirstThatHolds) {
  auto task = OpenTheCarton();
  EXPECT_EQ(RightOption(Choice(), task), 1u);
  task.object = {8, "Mug", 1};
  EXPECT_EQ(RightOption(Choice(), task), 2u);
  task.action = "Drink";
  EXPECT_EQ(RightOption(Choice(), task), 3u);
  auto without_none = Choice();
  without_none.options.pop_back();
  EXPECT_EQ(RightOption(without_none, task), std::nullopt);
}

TEST(RightOption, OfWhatAnObjectIsKnownOnlyForTheWantedOne) {
  auto task = OpenTheCarton();
  EXPECT_EQ(RightOption(WhatIsIt(7), task), 1u);
  EXPECT_EQ(RightOption(WhatIsIt(8), task), std::nullopt);
  task.object.category = "Tin";  // not on offer
  EXPECT_EQ(RightOption(WhatIsIt(7), task), 2u);
}

TEST(SessionTrials, ConfirmTellsEveryTrialOfEveryAnswerAlsoOfOnesTakenBack) {
  SessionTrials trials;
  trials.Add(Choice(), {{0.1, 0.6, 0.2, 0.1}, {0.3, 0.3, 0.3, 0.1}});
  trials.Add(Choice(), {{0.9, 0.05, 0.03, 0.02}});  // a slip, taken back and asked again
  trials.Add(WhatIsIt(8), {{0.2, 0.3, 0.5, 0}});    // not known
  const auto known = trials.Confirm(OpenTheCarton());
  ASSERT_EQ(known.size(), 3u);
  for (const auto& trial : known) EXPECT_EQ(trial.meant, 1u);
  EXPECT_EQ(known[2].probabilities[0], 0.9);
  EXPECT_TRUE(trials.Confirm(OpenTheCarton()).empty());
}

TEST(SessionTrials, OtherSessionsAndOtherNumbersOfObjectsTellNothing) {
  SessionTrials trials;
  auto other = Choice();
  other.session_id = "another";
  trials.Add(other, {{0.1, 0.6, 0.2, 0.1}});
  EXPECT_TRUE(trials.Confirm(OpenTheCarton()).empty());
  trials.Add(Choice(), {{0.1, 0.6, 0.2, 0.1}});
  trials.Renumbered();
  trials.Add(Choice(), {{0.4, 0.4, 0.1, 0.1}});
  EXPECT_EQ(trials.Confirm(OpenTheCarton()).size(), 1u);
}

TEST(RunWatch, SeesThatPerceptionBeganAnew) {
  RunWatch run;
  const auto scene = [](int64_t seq, Utime utime) {
    msg::Scene made;
    made.seq = seq;
    made.utime = utime;
    return made;
  };
  EXPECT_FALSE(run.IsAnother(scene(10, 1000)));
  EXPECT_FALSE(run.IsAnother(scene(11, 1100)));
  EXPECT_FALSE(run.IsAnother(scene(10, 1000)));  // a late copy
  EXPECT_FALSE(run.IsAnother(scene(12, 1200)));
  EXPECT_TRUE(run.IsAnother(scene(1, 1300)));
  EXPECT_FALSE(run.IsAnother(scene(2, 1400)));
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
