// What is made of what passes on the bus: records of conversations, their judgement, the robot's
// part.
#include "tools/beckon/session_observer.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/beckon/session_report.h"
#include "tools/beckon/simulated_robot.h"

namespace beckon::tool {
namespace {

msg::Query Ask(int64_t id, msg::QueryKind kind = msg::QueryKind::kFull) {
  msg::Query query;
  query.utime = 2000 * id;
  query.id = id;
  query.session_id = "s1";
  query.user = "ann";
  query.kind = kind;
  query.text = "question " + std::to_string(id);
  query.options = {{.text = "Yes"}, {.text = "No"}};
  return query;
}

msg::Answer Say(int64_t id, bool yes) {
  msg::Answer answer;
  answer.utime = 2000 * id + 500;
  answer.query_id = id;
  answer.session_id = "s1";
  answer.likelihoods = {yes ? 1.0 : 0.0, yes ? 0.0 : 1.0};
  return answer;
}

msg::Session Event(msg::SessionKind kind, const std::string& user = "ann") {
  msg::Session event;
  event.kind = kind;
  event.session_id = "s1";
  event.user = user;
  return event;
}

msg::Task Open(const std::string& category, double y) {
  msg::Task task;
  task.utime = 1;
  task.task_id = "s1";
  task.user = "ann";
  task.action = "Open";
  task.object = {4, category, 1};
  task.centroid_W = {0, y, 0};
  task.posterior = 0.995;
  task.expires_utime = 100;
  return task;
}

class SessionObserverTest : public ::testing::Test {
 protected:
  std::vector<SessionRecord> records_;
  SessionObserver observer_{"ann",
                            [this](const SessionRecord& record) { records_.push_back(record); }};
};

TEST_F(SessionObserverTest, CountsEachAnswerOnceHoweverOftenItIsRepeated) {
  observer_.OnSession(Event(msg::SessionKind::kRequestStart), 1000);
  observer_.OnSession(Event(msg::SessionKind::kBegun), 2000);
  for (int i = 0; i < 3; ++i) observer_.OnQuery(Ask(1, msg::QueryKind::kWhatIsIt), 5000);
  for (int i = 0; i < 3; ++i) observer_.OnAnswer(Say(1, false), 6000);
  observer_.OnQuery(Ask(2), 8000);
  observer_.OnAnswer(Say(7, true), 8500);  // to nothing that was asked
  observer_.OnAnswer(Say(2, true), 9000);
  observer_.OnTask(Open("Carton", 0.5), 11'000);
  observer_.OnTask(Open("Carton", 0.5), 12'000);
  ASSERT_EQ(records_.size(), 1u);
  const auto& record = records_[0];
  EXPECT_EQ(record.answers.size(), 2u);
  EXPECT_EQ(record.CategoryQuestions(), 1);
  EXPECT_EQ(record.answers[0].answer, "No");
  EXPECT_EQ(record.answers[1].question, "question 2");
  EXPECT_EQ(record.answer_to_query_ms, std::vector<double>{1.5});
  EXPECT_EQ(record.requested, 1000);
  EXPECT_EQ(record.first_query, 5000);
  EXPECT_EQ(record.ended, 11'000);
  EXPECT_EQ(observer_.ended(), 1);
}

TEST_F(SessionObserverTest, RecordsASessionThatEndsWithoutATask) {
  observer_.OnSession(Event(msg::SessionKind::kBegun, "bob"), 1);
  observer_.OnSession(Event(msg::SessionKind::kBegun), 2);
  auto abandoned = Event(msg::SessionKind::kAbandoned);
  abandoned.text = "cancelled";
  observer_.OnSession(abandoned, 3);
  observer_.OnSession(abandoned, 4);
  ASSERT_EQ(records_.size(), 1u);
  EXPECT_FALSE(records_[0].task);
  EXPECT_EQ(records_[0].outcome, "cancelled");
  EXPECT_FALSE(IsCorrect(records_[0], {"Open", "Carton"}, {}));
}

TEST(SessionReport, IsCorrectOnlyForTheNearestThatReallyStandsThere) {
  SessionRecord record;
  record.task = Open("Carton", 0.5);
  const Want want{"Open", "Carton"};
  EXPECT_TRUE(IsCorrect(record, want, {})) << "without truth the words decide";
  EXPECT_FALSE(IsCorrect(record, {"Pour", "Carton"}, {}));
  EXPECT_FALSE(IsCorrect(record, {"Open", "Tin"}, {}));
  EXPECT_TRUE(IsCorrect(record, want, {true, {{"Carton", {0, 0.52, 0}}, {"Carton", {0, 0.9, 0}}}}));
  EXPECT_FALSE(
      IsCorrect(record, want, {true, {{"Carton", {0, 0.52, 0}}, {"Carton", {0, 0.2, 0}}}}));
  EXPECT_FALSE(IsCorrect(record, want, {true, {{"Box", {0, 0.51, 0}}, {"Carton", {0, 0.54, 0}}}}));
  EXPECT_FALSE(IsCorrect(record, want, {true, {}}));
}

TEST(SessionReport, IsOneLineOfJson) {
  SessionRecord record;
  record.number = 2;
  record.requested = 1'000'000;
  record.first_query = 1'250'000;
  record.ended = 2'000'000;
  record.answers = {{1, msg::QueryKind::kFull, "Open \"the\" carton?\n", "Yes"}};
  record.answer_to_query_ms = {3, 1, 2};
  record.task = Open("Carton", 0.5);
  const Want want{"Open", "Carton"};
  const std::string line = ReportLine(record, &want, {});
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json["session"], 2);
  EXPECT_EQ(json["questions"], 1);
  EXPECT_EQ(json["correct"], true);
  EXPECT_EQ(json["task"]["action"], "Open");
  EXPECT_EQ(json["task"]["instance"], 1);
  EXPECT_EQ(json["task"]["position_W"][1], 0.5);
  EXPECT_EQ(json["ms"]["to_first_query"], 250.0);
  EXPECT_EQ(json["ms"]["session"], 1000.0);
  EXPECT_EQ(json["ms"]["answer_to_query_p50"], 2.0);
}

TEST(SimulatedRobot, DoesARepeatedTaskOnce) {
  SimulatedRobot robot;
  const auto first = robot.OnTask(Open("Carton", 0.5), 50);
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0].state, msg::TaskState::kAccepted);
  EXPECT_EQ(first[1].state, msg::TaskState::kDone);
  const auto again = robot.OnTask(Open("Carton", 0.5), 60);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].state, msg::TaskState::kDone);
  EXPECT_EQ(robot.tasks_done(), 1);
}

TEST(SimulatedRobot, DoesNothingLateOrStopped) {
  SimulatedRobot robot;
  EXPECT_EQ(robot.OnTask(Open("Carton", 0.5), 101)[0].state, msg::TaskState::kFailed);
  robot.OnSession(Event(msg::SessionKind::kRequestStop, "bob"));
  EXPECT_EQ(robot.OnTask(Open("Carton", 0.5), 50)[0].state, msg::TaskState::kFailed);
  EXPECT_EQ(robot.tasks_done(), 0);
  robot.OnSession(Event(msg::SessionKind::kRequestResume));
  EXPECT_EQ(robot.OnTask(Open("Carton", 0.5), 50)[0].state, msg::TaskState::kAccepted);
}

}  // namespace
}  // namespace beckon::tool
