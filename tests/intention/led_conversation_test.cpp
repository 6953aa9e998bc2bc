// Conversations that two services share: one of them speaks, the other follows, and goes on where
// it falls silent.
#include "services/intention/core/led_conversation.h"

#include "tests/intention/household.h"

namespace beckon::intention {
namespace {

using Kind = msg::SessionKind;

bool IsWord(const Outgoing& what) {
  return std::holds_alternative<msg::Query>(what) || std::holds_alternative<msg::Session>(what) ||
         std::holds_alternative<msg::Task>(what);
}
bool IsTask(const Outgoing& what) { return std::holds_alternative<msg::Task>(what); }
bool IsKind(const Outgoing& what, Kind kind) {
  const auto* event = std::get_if<msg::Session>(&what);
  return event != nullptr && event->kind == kind;
}

class LedConversationTest : public ::testing::Test {
 protected:
  /// Two services that know of each other, a user at two front ends; asked once, some answered.
  void BeginDialogue(int questions = 2) {
    home_.front_end(0).asks = home_.front_end(1).asks = false;
    home_.Run(2 * kSecond);
    home_.front_end(0).asks = true;
    ASSERT_TRUE(home_.RunUntil([&] { return Questions() >= questions; }));
    leader_ = static_cast<size_t>(home_.Leader());
    other_ = 1 - leader_;
  }
  int Questions() const {
    std::set<int64_t> ids;
    for (const auto& one : home_.All<msg::Query>()) ids.insert(std::get<msg::Query>(one.what).id);
    return static_cast<int>(ids.size());
  }
  void ExpectRight(size_t tasks = 1) {
    home_.Run(kSecond / 10);  // it is on its way
    EXPECT_EQ(home_.done.size(), tasks);
    for (const auto& [id, task] : home_.done) {
      EXPECT_EQ(task.action, Household::kAction);
      EXPECT_EQ(task.object.category, Household::kCategory);
      EXPECT_EQ(task.object.instance, Household::kInstance);
    }
  }

  Household home_{2, 2};
  size_t leader_ = 0;
  size_t other_ = 1;
};

TEST_F(LedConversationTest, OneAsksBothFrontEndsAndOneTaskComes) {
  BeginDialogue();
  const Utime begun = home_.All<msg::Query>().front().at;
  home_.front_end(1).asks = true;  // the user moves over, and joins
  ASSERT_TRUE(home_.RunUntil([&] { return home_.confirmed == 1; }));
  ExpectRight();
  EXPECT_EQ(home_.machine(leader_).memory.sessions.size(), 1u);
  EXPECT_EQ(home_.machine(other_).memory.sessions.size(), 0u);
  // What is over anyone may tell a front end that asks.
  const auto is_word = [](const auto& what) {
    return IsWord(what) && !IsKind(what, Kind::kConfirmed);
  };
  EXPECT_EQ(home_.Count(other_, begun, is_word), 0) << "it does not lead";
}

TEST_F(LedConversationTest, AloneItAsksAtOnce) {
  Household home(1, 1);
  home.front_end(0).asks = false;
  home.Run(5 * kSecond);
  msg::Session request;
  request.kind = Kind::kRequestStart;
  request.user = "ann";
  request.session_id = "s";
  auto& machine = home.machine(0);
  const Actions actions = machine.service->OnSession(request, machine.Wall());
  EXPECT_TRUE(std::ranges::any_of(
      actions, [](const auto& one) { return std::holds_alternative<msg::Query>(one); }));
}

TEST_F(LedConversationTest, AnotherFinishesWhatAKilledOneBegan) {
  BeginDialogue();
  const std::string session = home_.front_end(0).session_id;
  const int questions = Questions();
  home_.Kill(leader_);
  const Utime killed = home_.net.now();
  ASSERT_TRUE(home_.RunUntil([&] { return Questions() > questions; }));
  EXPECT_LE(home_.net.now() - killed, 2400'000) << "lease and claim";
  const auto query = std::get<msg::Query>(home_.All<msg::Query>().back().what);
  EXPECT_EQ(query.session_id, session);
  EXPECT_TRUE(query.text.starts_with("The machine that asked you fell silent.")) << query.text;
  ASSERT_TRUE(home_.RunUntil([&] { return home_.confirmed == 1; }));
  ExpectRight();
  EXPECT_TRUE(home_.done.contains(session));
  EXPECT_EQ(home_.machine(other_).service->counters().taken_over, 1);
  EXPECT_EQ(home_.machine(other_).memory.sessions.size(), 1u);
}

TEST_F(LedConversationTest, TheOneThatWasKilledComesBackAndLeavesItToTheOther) {
  BeginDialogue();
  home_.Kill(leader_);
  ASSERT_TRUE(home_.RunUntil([&] { return home_.Leader() == static_cast<int>(other_); }));
  home_.Revive(leader_);
  const Utime back = home_.net.now();
  ASSERT_TRUE(home_.RunUntil([&] { return home_.confirmed == 1; }));
  ExpectRight();
  const auto queries = home_.Count(
      leader_, back, [](const auto& what) { return std::holds_alternative<msg::Query>(what); });
  EXPECT_EQ(queries, 0);
}

TEST_F(LedConversationTest, WhatStoodStillForTenSecondsPublishesNothing) {
  BeginDialogue();
  // Its last question is answered "yes" as it stops, and again.
  ASSERT_TRUE(home_.RunUntil([&] {
    return home_.front_end(0).query.kind == msg::QueryKind::kFull &&
           home_.front_end(0).query.objects[0].instance == Household::kInstance;
  }));
  home_.net.Pause(leader_, 10 * kSecond);
  const Utime paused = home_.net.now();
  ASSERT_TRUE(home_.RunUntil([&] { return home_.confirmed == 1; }));
  ExpectRight();
  home_.front_end(0).asks = false;
  home_.Run(20 * kSecond);
  ExpectRight();
  EXPECT_EQ(home_.Count(leader_, paused, IsTask), 0);
  EXPECT_EQ(home_.machine(leader_).memory.sessions.size(), 0u);
  EXPECT_EQ(home_.machine(leader_).service->counters().yielded, 1);
}

TEST_F(LedConversationTest, ACommitThatTookTooLongIsNotPublishedWhereAnotherWentOn) {
  BeginDialogue();
  auto& machine = home_.machine(leader_);
  machine.memory.on_commit = [&] {
    machine.stalled += 10 * kSecond;
    home_.net.Pause(leader_, 10 * kSecond);
  };
  ASSERT_TRUE(home_.RunUntil([&] { return home_.confirmed == 1; }));
  home_.front_end(0).asks = false;
  home_.Run(20 * kSecond);
  ExpectRight();
  EXPECT_EQ(home_.Count(leader_, 0, IsTask), 0);
  EXPECT_GE(home_.Count(other_, 0, IsTask), 1);
  ASSERT_EQ(machine.memory.sessions.size(), 1u);
  EXPECT_TRUE(machine.memory.OpenTasks()->empty()) << "nor after a restart";
}

TEST_F(LedConversationTest, ACommitThatTookTooLongIsPublishedOnceTheLeaseIsHeldAgain) {
  Household home(1, 1);
  auto& machine = home.machine(0);
  bool stalled = false;
  machine.memory.on_commit = [&] {
    machine.stalled += 10 * kSecond;
    stalled = true;
  };
  ASSERT_TRUE(home.RunUntil([&] { return stalled; }));
  EXPECT_EQ(home.Count(0, 0, IsTask), 0);
  ASSERT_TRUE(home.RunUntil([&] { return home.confirmed == 1; }, 2 * kSecond));
  EXPECT_EQ(home.done.size(), 1u);
  EXPECT_TRUE(home.All<msg::Task>().front().held);
  EXPECT_EQ(machine.memory.sessions.size(), 1u);
}

TEST_F(LedConversationTest, AHealedCutLeavesOneConversation) {
  BeginDialogue(1);
  home_.front_end(0).answers = home_.front_end(1).answers = false;
  home_.net.Move(other_, 1);
  home_.net.Move(home_.EndpointOf(1), 1);
  home_.front_end(1).asks = true;
  ASSERT_TRUE(home_.RunUntil([&] { return home_.Holds(0) && home_.Holds(1); }));
  home_.Run(kSecond);
  home_.net.Move(other_, 0);
  home_.net.Move(home_.EndpointOf(1), 0);
  home_.Run(kSecond);
  EXPECT_NE(home_.Holds(0), home_.Holds(1));
  const auto loser = static_cast<size_t>(1 - home_.Leader());
  EXPECT_EQ(home_.Count(loser, home_.net.now() - kSecond / 4, IsWord), 0);
  EXPECT_EQ(home_.Count(loser, 0, [](const auto& what) { return IsKind(what, Kind::kAbandoned); }),
            0)
      << "it yields without a word";
  home_.front_end(0).answers = home_.front_end(1).answers = true;
  ASSERT_TRUE(home_.RunUntil([&] { return home_.confirmed == 1; }));
  ExpectRight();
}

TEST_F(LedConversationTest, StopStopsAllAndAlsoOneThatMissedIt) {
  BeginDialogue();
  home_.net.Move(other_, 1);
  home_.Request(1, Kind::kRequestStop, "");
  home_.front_end(0).asks = false;
  home_.Run(kSecond / 5);
  EXPECT_TRUE(home_.machine(leader_).service->conversation().stopped());
  EXPECT_FALSE(home_.machine(other_).service->conversation().stopped());
  home_.net.Move(other_, 0);
  home_.Run(3 * kSecond / 2);
  EXPECT_TRUE(home_.machine(other_).service->conversation().stopped());
  const Utime stopped = home_.net.now();
  home_.Run(10 * kSecond);
  for (const size_t i : {leader_, other_}) {
    EXPECT_EQ(
        home_.Count(i, stopped,
                    [](const auto& what) { return IsWord(what) && !IsKind(what, Kind::kStopped); }),
        0);
  }
  home_.Request(1, Kind::kRequestResume, "");
  home_.Run(5 * kSecond);
  for (const size_t i : {leader_, other_})
    EXPECT_FALSE(home_.machine(i).service->conversation().stopped());
  home_.front_end(0).asks = true;
  ASSERT_TRUE(home_.RunUntil([&] { return home_.confirmed == 1; }));
  ExpectRight();
}

TEST_F(LedConversationTest, ATaskOfAMachineThatComesBackEndsTheConversationThatWasTakenOver) {
  BeginDialogue();
  const std::string session = home_.front_end(0).session_id;
  auto& machine = home_.machine(leader_);
  bool committed = false;
  machine.memory.on_commit = [&] {  // killed between the commit and the task
    committed = true;
    machine.stalled += 10 * kSecond;
  };
  ASSERT_TRUE(home_.RunUntil([&] { return committed; }));
  home_.Kill(leader_);
  home_.front_end(0).answers = false;
  ASSERT_TRUE(home_.RunUntil([&] { return home_.Leader() == static_cast<int>(other_); }));
  EXPECT_TRUE(home_.machine(other_).service->conversation().Runs("ann"));
  home_.Revive(leader_);
  ASSERT_TRUE(home_.RunUntil([&] { return home_.confirmed == 1; }));
  ExpectRight();
  EXPECT_TRUE(home_.done.contains(session));
  home_.Run(kSecond);
  EXPECT_FALSE(home_.machine(other_).service->conversation().UserOf(session));
}

TEST_F(LedConversationTest, ACancelledClaimAsksNothing) {
  home_.front_end(0).asks = home_.front_end(1).asks = false;
  home_.Run(2 * kSecond);
  home_.Request(0, Kind::kRequestStart, "s");
  home_.Run(kSecond / 20);
  home_.Request(0, Kind::kRequestCancel, "s");
  home_.Run(5 * kSecond);
  EXPECT_EQ(Questions(), 0);
  EXPECT_EQ(home_.Leader(), -1);
}

TEST_F(LedConversationTest, AnImpossibleTermIsRefusedByName) {
  msg::Lease lease;
  lease.user = "ann";
  lease.session_id = "s";
  lease.holder = "x";
  lease.run = "1";
  lease.term = INT64_MAX;
  lease.remaining_ms = 2000;
  auto& machine = home_.machine(0);
  const Actions actions = machine.service->OnLease(lease, machine.Wall());
  ASSERT_EQ(actions.size(), 1u);
  EXPECT_EQ(std::get<Refused>(actions[0]).channel, "BECKON_LEASE");
}

}  // namespace
}  // namespace beckon::intention
