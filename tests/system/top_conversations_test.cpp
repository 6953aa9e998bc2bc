// From what passes on the bus to what `beckon top` says of the conversations.
#include "tools/beckon/top_conversations.h"

#include <gtest/gtest.h>

namespace beckon::tool {
namespace {

msg::Session Event(msg::SessionKind kind, const std::string& text = {},
                   const std::string& user = "ann") {
  msg::Session event;
  event.session_id = "s1";
  event.user = user;
  event.kind = kind;
  event.text = text;
  return event;
}

msg::Query Ask(int64_t id, const std::string& text) {
  msg::Query query;
  query.id = id;
  query.session_id = "s1";
  query.user = "ann";
  query.text = text;
  query.questions_asked = static_cast<int>(id) - 1;
  return query;
}

TEST(TopConversations, TellsWhoIsAskedWhatAndForHowLong) {
  TopConversations talks;
  talks.OnSession(Event(msg::SessionKind::kBegun, "looking at the table"), kSecond);
  EXPECT_EQ(talks.View(kSecond).talks.at(0).state, "waiting");
  EXPECT_EQ(talks.View(kSecond).talks.at(0).text, "looking at the table");
  for (Utime now : {2, 3, 4}) talks.OnQuery(Ask(1, "open the carton?"), now * kSecond);
  talks.OnSession(Event(msg::SessionKind::kBegun), 4 * kSecond);
  auto talk = talks.View(5 * kSecond).talks.at(0);
  EXPECT_EQ(talk.state, "asked");
  EXPECT_EQ(talk.text, "open the carton?");
  EXPECT_EQ(talk.kind, "full");
  EXPECT_EQ(talk.since_us, 3 * kSecond);
  talks.OnQuery(Ask(2, "open the carton?"), 6 * kSecond);
  EXPECT_EQ(talks.View(6 * kSecond).talks.at(0).since_us, 0) << "asked anew";
}

TEST(TopConversations, TellsTheLastTaskAndWhatTheRobotSays) {
  TopConversations talks;
  EXPECT_FALSE(talks.View(0).last_task);
  msg::Task task;
  task.task_id = "s1";
  task.user = "ann";
  task.action = "Open";
  task.object = {4, "Carton", 1};
  talks.OnTask(task, kSecond);
  EXPECT_EQ(talks.View(kSecond).last_task->state, "published");
  msg::TaskStatus other;
  other.task_id = "s0";
  other.state = msg::TaskState::kFailed;
  talks.OnTaskStatus(other, kSecond);
  EXPECT_EQ(talks.View(kSecond).last_task->state, "published");
  other.task_id = "s1";
  talks.OnTaskStatus(other, kSecond);
  talks.OnTask(task, 2 * kSecond);
  const auto last = talks.View(3 * kSecond).last_task.value();
  EXPECT_EQ(last.task, "Open Carton 1");
  EXPECT_EQ(last.state, "failed");
  EXPECT_EQ(last.since_us, 2 * kSecond);
}

TEST(TopConversations, IsStoppedUntilIntentionSaysOtherwise) {
  TopConversations talks;
  talks.OnQuery(Ask(1, "open the carton?"), 1);
  talks.OnSession(Event(msg::SessionKind::kRequestStop, "", "bob"), 2);
  EXPECT_TRUE(talks.View(2).stopped) << "from the request on, whoever makes it";
  EXPECT_EQ(talks.View(2).talks.at(0).state, "over");
  talks.OnQuery(Ask(1, "open the carton?"), 3);
  EXPECT_EQ(talks.View(3).talks.at(0).state, "over");
  talks.OnSession(Event(msg::SessionKind::kRequestResume), 4);
  EXPECT_TRUE(talks.View(4).stopped);
  talks.OnSession(Event(msg::SessionKind::kIdle), 5);
  EXPECT_FALSE(talks.View(5).stopped);
}

TEST(TopConversations, SaysHowAConversationEndedAndWhenItFellSilent) {
  TopConversations talks;
  talks.OnQuery(Ask(1, "open the carton?"), 0);
  EXPECT_TRUE(talks.View(TopConversations::kSilent_us + 1).talks.at(0).silent);
  talks.OnSession(Event(msg::SessionKind::kAbandoned, "cancelled"), 0);
  const auto talk = talks.View(100 * kSecond).talks.at(0);
  EXPECT_EQ(talk.state, "over");
  EXPECT_EQ(talk.text, "cancelled");
  EXPECT_FALSE(talk.silent);
}

TEST(TopConversations, IsBoundedOnABusOfStrangers) {
  TopConversations talks;
  for (int i = 0; i < 5000; ++i)
    talks.OnSession(Event(msg::SessionKind::kBegun, "", "user" + std::to_string(i)), 0);
  EXPECT_LE(talks.View(0).talks.size(), 64u);
}

}  // namespace
}  // namespace beckon::tool
