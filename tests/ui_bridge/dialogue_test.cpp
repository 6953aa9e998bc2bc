// The rules of the conversation, as one front end keeps them.
#include "services/ui_bridge/dialogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace beckon::ui_bridge {
namespace {

using msg::SessionKind;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class Recorder final : public DialogueOutput {
 public:
  void Send(const msg::Answer& answer) override { answers.push_back(answer); }
  void Send(const msg::Session& request) override { requests.push_back(request); }
  void Present(const msg::Query& query) override { presented.push_back(query.id); }
  void Withdraw() override { ++withdrawn; }
  void ShowSession(const msg::Session& event) override { shown.push_back(event.kind); }
  void ShowNotice(const std::string& text) override { notices.push_back(text); }
  void ShowUser(const std::string& user) override { users.push_back(user); }

  int Count(SessionKind kind) const {
    return static_cast<int>(std::ranges::count(requests, kind, &msg::Session::kind));
  }

  std::vector<msg::Answer> answers;
  std::vector<msg::Session> requests;
  std::vector<int64_t> presented;
  std::vector<SessionKind> shown;
  std::vector<std::string> notices;
  std::vector<std::string> users;
  int withdrawn = 0;
};

class DialogueTest : public ::testing::Test {
 protected:
  void Pass(Utime duration_us) {
    for (Utime t = 0; t < duration_us; t += 50'000) {
      clock_.Advance(50'000);
      dialogue_.Tick();
    }
  }

  void Hear(SessionKind kind, const std::string& id, int questions = 0,
            const std::string& user = "ann") {
    msg::Session event;
    event.utime = clock_.Now();
    event.kind = kind;
    event.session_id = id;
    event.user = user;
    event.questions = questions;
    event.seal.sender = sender_;
    dialogue_.OnSession(event);
  }

  void Ask(int64_t query_id, const std::string& session_id, int asked = 0,
           const std::string& user = "ann") {
    msg::Query query;
    query.id = query_id;
    query.session_id = session_id;
    query.user = user;
    query.questions_asked = asked;
    query.options = {{.text = "Yes"}, {.text = "No"}};
    query.seal.sender = sender_;
    dialogue_.OnQuery(query);
  }

  /// Of intention's IDLE, which names nobody.
  void HearIdle() { Hear(SessionKind::kIdle, "", 0, ""); }

  /// A session of our own, begun.
  std::string Begin() {
    dialogue_.Start();
    Pass(2 * kSecond);
    Hear(SessionKind::kBegun, dialogue_.session_id());
    return dialogue_.session_id();
  }

  ManualClock clock_{1'700'000'000 * kSecond};
  Recorder out_;
  std::string sender_ = "kitchen/intention";  // of what is heard
  int ids_ = 0;
  Dialogue dialogue_{{.user = "ann", .device = "test@here"},
                     clock_,
                     clock_,
                     [this] { return "session-" + std::to_string(++ids_); },
                     out_};
};

TEST_F(DialogueTest, ListensBeforeItAsksForASession) {
  dialogue_.Start();
  Pass(1'400'000);
  EXPECT_THAT(out_.requests, IsEmpty());
  Pass(200'000);
  ASSERT_EQ(out_.requests.size(), 1u);
  EXPECT_EQ(out_.requests[0].kind, SessionKind::kRequestStart);
  EXPECT_EQ(out_.requests[0].user, "ann");
  EXPECT_EQ(out_.requests[0].device, "test@here");
  EXPECT_EQ(out_.requests[0].session_id, "session-1");
}

TEST_F(DialogueTest, RepeatsTheRequestWithOneIdUntilTheSessionBegins) {
  dialogue_.Start();
  Pass(4 * kSecond);
  const int sent = out_.Count(SessionKind::kRequestStart);
  EXPECT_GE(sent, 5);
  EXPECT_LE(sent, 6);
  for (const auto& request : out_.requests) EXPECT_EQ(request.session_id, "session-1");
  Hear(SessionKind::kBegun, "session-1");
  Pass(2 * kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestStart), sent);
}

TEST_F(DialogueTest, IdleAnnouncementsDoNotEndTheRequest) {
  dialogue_.Start();
  Pass(2 * kSecond);
  Hear(SessionKind::kIdle, "", 0, "");
  Pass(kSecond);
  EXPECT_GE(out_.Count(SessionKind::kRequestStart), 3);
  EXPECT_EQ(ids_, 1);
}

TEST_F(DialogueTest, JoinsARunningSessionInsteadOfAskingForOne) {
  dialogue_.Start();
  Hear(SessionKind::kBegun, "theirs", 2);
  Ask(7, "theirs", 2);
  Pass(3 * kSecond);
  EXPECT_THAT(out_.requests, IsEmpty());
  EXPECT_THAT(out_.presented, ElementsAre(7));
  EXPECT_EQ(dialogue_.session_id(), "theirs");
}

TEST_F(DialogueTest, JoinsTheSessionThatAQueryTellsOf) {
  dialogue_.Start();
  Ask(7, "theirs", 2);
  Pass(3 * kSecond);
  EXPECT_THAT(out_.requests, IsEmpty());
  EXPECT_THAT(out_.presented, ElementsAre(7));
}

TEST_F(DialogueTest, PresentsEachQueryOnce) {
  const auto id = Begin();
  Ask(1, id);
  Ask(1, id);
  Ask(2, id, 1);
  Ask(1, id);  // late
  Ask(2, id, 1);
  EXPECT_THAT(out_.presented, ElementsAre(1, 2));
  EXPECT_EQ(dialogue_.query()->id, 2);
}

TEST_F(DialogueTest, LeavesOtherUsersAlone) {
  const auto id = Begin();
  Ask(1, "other", 0, "bob");
  Hear(SessionKind::kConfirmed, id, 0, "bob");
  EXPECT_THAT(out_.presented, IsEmpty());
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kRunning);
}

TEST_F(DialogueTest, RepeatsTheAnswerUntilTheNextQuestion) {
  const auto id = Begin();
  Ask(1, id);
  dialogue_.Answer(1, {1, 0});
  Ask(1, id);  // repeated by intention: the answer was not heard yet
  Pass(1'200'000);
  EXPECT_EQ(out_.answers.size(), 3u);
  EXPECT_EQ(out_.answers[0].utime, out_.answers[2].utime) << "a repetition is the same answer";
  EXPECT_EQ(out_.answers[0].session_id, id);
  Ask(2, id, 1);
  Pass(2 * kSecond);
  EXPECT_EQ(out_.answers.size(), 3u);
}

TEST_F(DialogueTest, StopsRepeatingTheAnswerWhenTheSessionCountsIt) {
  const auto id = Begin();
  Ask(1, id, 0);
  dialogue_.Answer(1, {1, 0});
  Hear(SessionKind::kBegun, id, 0);
  Pass(600'000);
  EXPECT_EQ(out_.answers.size(), 2u);
  Hear(SessionKind::kBegun, id, 1);
  Pass(2 * kSecond);
  EXPECT_EQ(out_.answers.size(), 2u);
}

TEST_F(DialogueTest, AnswersOnlyTheQuestionThatStands) {
  const auto id = Begin();
  Ask(1, id);
  Ask(2, id, 1);
  dialogue_.Answer(1, {1, 0});
  EXPECT_THAT(out_.answers, IsEmpty());
  Hear(SessionKind::kConfirmed, id, 2);
  dialogue_.Answer(2, {1, 0});
  EXPECT_THAT(out_.answers, IsEmpty());
}

TEST_F(DialogueTest, EndsWithTheConfirmationAndShowsItOnce) {
  const auto id = Begin();
  Ask(1, id);
  dialogue_.Answer(1, {1, 0});
  Hear(SessionKind::kConfirmed, id, 1);
  Hear(SessionKind::kConfirmed, id, 1);
  Pass(3 * kSecond);
  EXPECT_EQ(out_.answers.size(), 1u);
  EXPECT_EQ(out_.withdrawn, 1);
  EXPECT_THAT(out_.shown, ElementsAre(SessionKind::kBegun, SessionKind::kConfirmed));
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kIdle);
}

TEST_F(DialogueTest, IgnoresLateMessagesOfASessionThatIsOver) {
  const auto id = Begin();
  Hear(SessionKind::kConfirmed, id, 1);
  Ask(9, id, 1);
  Hear(SessionKind::kBegun, id, 1);
  EXPECT_THAT(out_.presented, IsEmpty());
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kIdle);
}

TEST_F(DialogueTest, StartsTheNextSessionWithANewId) {
  const auto first = Begin();
  Hear(SessionKind::kConfirmed, first, 1);
  dialogue_.Start();
  EXPECT_EQ(out_.requests.back().kind, SessionKind::kRequestStart);
  EXPECT_NE(out_.requests.back().session_id, first);
  Hear(SessionKind::kConfirmed, first, 1);  // still the latest event
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kRequesting);
}

TEST_F(DialogueTest, StartsOverWithTheSameIdWhenIntentionComesBackIdle) {
  const auto id = Begin();
  Ask(1, id);
  Hear(SessionKind::kIdle, "", 0, "");
  EXPECT_EQ(out_.withdrawn, 1);
  EXPECT_EQ(out_.notices.size(), 1u);
  EXPECT_EQ(out_.requests.back().kind, SessionKind::kRequestStart);
  EXPECT_EQ(out_.requests.back().session_id, id);
  Hear(SessionKind::kBegun, id);
  Ask(1, id);  // ids may come again after a restart
  EXPECT_THAT(out_.presented, ElementsAre(1, 1));
}

TEST_F(DialogueTest, StartsOverWithTheSameIdWhenIntentionSpeaksOfOtherSessionsOnly) {
  const std::string id = Begin();
  Ask(7, id);
  dialogue_.Answer(7, {1, 0});
  const int before = out_.Count(SessionKind::kRequestStart);
  // Intention was killed; what it comes back with is the task before, and another user's session.
  for (int i = 0; i < 5; ++i) {
    Pass(kSecond);
    Hear(SessionKind::kConfirmed, "earlier");
    Hear(SessionKind::kBegun, "another", 0, "bob");
  }
  EXPECT_GT(out_.Count(SessionKind::kRequestStart), before);
  EXPECT_EQ(out_.requests.back().session_id, id);
  EXPECT_EQ(out_.withdrawn, 1);
  Hear(SessionKind::kBegun, id);
  Ask(8, id);
  EXPECT_THAT(out_.presented, ElementsAre(7, 8));
}

TEST_F(DialogueTest, WhileIntentionSpeaksOfTheSessionOrNotAtAllItIsNotStartedOver) {
  const std::string id = Begin();
  const int before = out_.Count(SessionKind::kRequestStart);
  for (int i = 0; i < 10; ++i) {
    Pass(kSecond);
    Hear(SessionKind::kConfirmed, "earlier");
    Hear(SessionKind::kBegun, id);
  }
  Pass(20 * kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestStart), before);
}

TEST_F(DialogueTest, ACancelledSessionThatIntentionForgotIsOver) {
  Begin();
  dialogue_.Cancel();
  for (int i = 0; i < 5; ++i) {
    Pass(kSecond);
    Hear(SessionKind::kConfirmed, "earlier");
  }
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kIdle);
  EXPECT_EQ(out_.shown.back(), SessionKind::kIdle);
}

TEST_F(DialogueTest, TakesAConfirmationForARepeatedRequest) {
  const auto id = Begin();
  Hear(SessionKind::kIdle, "", 0, "");
  Hear(SessionKind::kConfirmed, id, 3);
  Pass(2 * kSecond);
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kIdle);
  EXPECT_EQ(out_.shown.back(), SessionKind::kConfirmed);
}

TEST_F(DialogueTest, RepeatsCancelUntilItIsHeard) {
  const auto id = Begin();
  Ask(1, id);
  dialogue_.Cancel();
  Pass(kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestCancel), 3);
  Ask(2, id, 1);
  EXPECT_THAT(out_.presented, ElementsAre(1));
  Hear(SessionKind::kAbandoned, id);
  Pass(kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestCancel), 3);
}

TEST_F(DialogueTest, ACancelledSessionIsNotStartedOver) {
  Begin();
  dialogue_.Cancel();
  const int starts = out_.Count(SessionKind::kRequestStart);
  Hear(SessionKind::kIdle, "", 0, "");
  Pass(kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestStart), starts);
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kIdle);
}

TEST_F(DialogueTest, StopIsSentAtOnceAndUntilItHolds) {
  dialogue_.Stop();  // no session, still listening: all the same
  EXPECT_EQ(out_.Count(SessionKind::kRequestStop), 1);
  Pass(600'000);
  EXPECT_EQ(out_.Count(SessionKind::kRequestStop), 2);
  Hear(SessionKind::kStopped, "", 0, "");
  Pass(kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestStop), 2);
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kStopped);
}

TEST_F(DialogueTest, WhileStoppedNothingIsAskedUntilResumed) {
  const auto id = Begin();
  Ask(1, id);
  Hear(SessionKind::kStopped, id, 0, "bob");  // anybody's stop
  EXPECT_EQ(out_.withdrawn, 1);
  Ask(2, id, 1);
  EXPECT_THAT(out_.presented, ElementsAre(1));
  dialogue_.Resume();
  Pass(600'000);
  EXPECT_EQ(out_.Count(SessionKind::kRequestResume), 2);
  Hear(SessionKind::kIdle, "", 0, "");
  Pass(kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestResume), 2);
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kIdle);
  dialogue_.Start();
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kRequesting);
}

TEST_F(DialogueTest, RepeatsUndoUntilTheCountOfAnswersTellsThatItArrived) {
  const auto id = Begin();
  Ask(1, id);
  Ask(2, id, 1);
  dialogue_.Undo();
  Pass(1'200'000);
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 3);
  EXPECT_EQ(out_.requests.back().utime, out_.requests[out_.requests.size() - 2].utime)
      << "a repetition is the same request";
  Ask(3, id, 1);  // the table changed meanwhile
  Hear(SessionKind::kBegun, id, 1);
  Pass(600'000);
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 4);
  Ask(4, id, 0);
  Pass(3 * kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 4);
}

TEST_F(DialogueTest, RepeatsNoneOfTheseUntilItIsCounted) {
  const auto id = Begin();
  Ask(1, id);
  dialogue_.NoneOfThese();
  Pass(600'000);
  EXPECT_EQ(out_.Count(SessionKind::kRequestNoneOfThese), 2);
  Hear(SessionKind::kBegun, id, 1);
  Pass(3 * kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestNoneOfThese), 2);
}

TEST_F(DialogueTest, TwoUndosAreSaidOneAfterTheOther) {
  const auto id = Begin();
  Ask(1, id, 3);
  dialogue_.Undo();
  dialogue_.Undo();
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 1);
  const Utime first = out_.requests.back().utime;
  Pass(100'000);
  Ask(2, id, 2);
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 2);
  EXPECT_NE(out_.requests.back().utime, first) << "another request";
  Ask(3, id, 1);
  Pass(3 * kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 2);
}

TEST_F(DialogueTest, UndoWaitsForTheAnswerThatItTakesBack) {
  const auto id = Begin();
  Ask(1, id);
  dialogue_.Answer(1, {1, 0});
  dialogue_.Undo();
  Pass(600'000);
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 0);
  Ask(2, id, 1);
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 1);
  dialogue_.Answer(2, {1, 0});
  EXPECT_EQ(out_.answers.size(), 2u) << "the question that is about to go is not answered";
  Ask(3, id, 0);
  dialogue_.Answer(3, {0, 1});
  EXPECT_EQ(out_.answers.back().query_id, 3);
}

TEST_F(DialogueTest, WithNothingToTakeBackUndoIsSaidOnce) {
  const auto id = Begin();
  Ask(1, id);
  dialogue_.Undo();
  Pass(3 * kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 1);
}

TEST_F(DialogueTest, ChangesEndWithTheSession) {
  const auto id = Begin();
  Ask(1, id, 2);
  dialogue_.Undo();
  dialogue_.NoneOfThese();
  Hear(SessionKind::kConfirmed, id, 2);
  Pass(3 * kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 1);
  EXPECT_EQ(out_.Count(SessionKind::kRequestNoneOfThese), 0);
}

TEST_F(DialogueTest, AQuestionIsWithdrawnWhenIntentionWaitsForSomething) {
  const auto id = Begin();
  Ask(1, id);
  dialogue_.Answer(1, {1, 0});
  msg::Session waits;
  waits.utime = clock_.Now();
  waits.kind = SessionKind::kBegun;
  waits.session_id = id;
  waits.user = "ann";
  waits.questions = 1;
  waits.text = "Making sure that the carton is still there.";
  dialogue_.OnSession(waits);
  EXPECT_EQ(out_.withdrawn, 1);
  EXPECT_EQ(dialogue_.query(), nullptr);
  Pass(kSecond);
  EXPECT_EQ(out_.answers.size(), 1u);
  Ask(2, id, 1);
  EXPECT_THAT(out_.presented, ElementsAre(1, 2));
}

TEST_F(DialogueTest, NoneOfTheseIsTheLastOptionWhereAnObjectIsAskedAbout) {
  const auto id = Begin();
  msg::Query query;
  query.id = 1;
  query.session_id = id;
  query.user = "ann";
  query.kind = msg::QueryKind::kWhatIsIt;
  query.options = {{.text = "a box"}, {.text = "a cup"}, {.text = "None of these"}};
  dialogue_.OnQuery(query);
  dialogue_.NoneOfThese();
  EXPECT_EQ(out_.Count(SessionKind::kRequestNoneOfThese), 0);
  ASSERT_EQ(out_.answers.size(), 1u);
  EXPECT_THAT(out_.answers[0].likelihoods, ElementsAre(0, 0, 1));
}

TEST_F(DialogueTest, OnceStopIsPressedNothingIsAnsweredOrAskedAnyMore) {
  const auto id = Begin();
  Ask(1, id);
  dialogue_.Stop();
  EXPECT_EQ(out_.withdrawn, 1);
  dialogue_.Answer(1, {1, 0});
  dialogue_.Undo();
  dialogue_.Start();
  Ask(2, id);
  Hear(SessionKind::kBegun, id);
  EXPECT_THAT(out_.answers, IsEmpty());
  EXPECT_THAT(out_.presented, ElementsAre(1));
  EXPECT_EQ(out_.Count(SessionKind::kRequestUndo), 0);
}

TEST_F(DialogueTest, AStopThatWasNotHeardIsNotGivenUpForAnythingElse) {
  Begin();
  dialogue_.Stop();
  dialogue_.Resume();
  dialogue_.Cancel();
  Pass(2 * kSecond);
  EXPECT_EQ(out_.Count(SessionKind::kRequestResume), 0);
  EXPECT_EQ(out_.Count(SessionKind::kRequestCancel), 0);
  EXPECT_GE(out_.Count(SessionKind::kRequestStop), 4);
}

TEST_F(DialogueTest, AnotherUserIsServedOnceTheSessionThatRunsIsCancelled) {
  const auto id = Begin();
  dialogue_.ChangeUser("ben");
  EXPECT_GE(out_.Count(SessionKind::kRequestCancel), 1);
  EXPECT_THAT(out_.users, IsEmpty());
  Ask(1, id);
  EXPECT_THAT(out_.presented, IsEmpty());
  Hear(SessionKind::kAbandoned, id);
  EXPECT_THAT(out_.users, ElementsAre("ben"));
  Ask(2, "bens session", 0, "ben");
  EXPECT_THAT(out_.presented, ElementsAre(2));
  Ask(3, "anns session", 0, "ann");
  EXPECT_THAT(out_.presented, ElementsAre(2));
}

TEST_F(DialogueTest, AnotherUserIsServedAtOnceWhereNoSessionRuns) {
  dialogue_.ChangeUser("ben");
  EXPECT_THAT(out_.users, ElementsAre("ben"));
  dialogue_.ChangeUser("ben");
  EXPECT_THAT(out_.users, ElementsAre("ben"));
  dialogue_.Start();
  Pass(2 * kSecond);
  ASSERT_FALSE(out_.requests.empty());
  EXPECT_EQ(out_.requests.back().user, "ben");
}

TEST_F(DialogueTest, AServiceThatDoesNotLeadMayBeIdle) {
  const std::string id = Begin();
  Ask(7, id);
  sender_ = "bedroom/intention";
  HearIdle();
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kRunning);
  EXPECT_EQ(out_.withdrawn, 0);
  EXPECT_THAT(out_.notices, IsEmpty());
  sender_ = "kitchen/intention";
  Hear(SessionKind::kConfirmed, id);
  sender_ = "bedroom/intention";
  HearIdle();
  EXPECT_EQ(out_.shown.back(), SessionKind::kConfirmed) << "what was done stays in sight";
  sender_ = "kitchen/intention";
  HearIdle();
  EXPECT_EQ(out_.shown.back(), SessionKind::kIdle);
}

TEST_F(DialogueTest, AnotherThatTakesOverWithdrawsTheQuestionAndAsksAnew) {
  const std::string id = Begin();
  Ask(7, id, 3);
  dialogue_.Answer(7, {1, 0});
  sender_ = "bedroom/intention";
  clock_.Advance(-3600 * kSecond);  // its clock
  Hear(SessionKind::kBegun, id);
  EXPECT_EQ(out_.withdrawn, 1);
  EXPECT_FALSE(dialogue_.answered());
  Ask(8, id);
  EXPECT_THAT(out_.presented, ElementsAre(7, 8));
  dialogue_.Answer(8, {1, 0});
  EXPECT_EQ(out_.answers.back().query_id, 8);
  sender_ = "kitchen/intention";  // it comes back
  HearIdle();
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kRunning);
}

TEST_F(DialogueTest, WhenTheLeaderIsLostAnotherThatIsIdleIsAskedAfterAWhile) {
  const std::string id = Begin();
  sender_ = "bedroom/intention";
  for (int i = 0; i < 5; ++i) {
    Pass(kSecond);
    HearIdle();
  }
  Pass(kSecond);
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kRequesting);
  EXPECT_EQ(dialogue_.session_id(), id);
}

TEST_F(DialogueTest, StaysStoppedWhileTheServiceThatStoppedDoes) {
  Begin();
  Hear(SessionKind::kStopped, "");
  sender_ = "bedroom/intention";  // it has not heard of it
  HearIdle();
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kStopped);
  dialogue_.Resume();  // the service that stopped may be gone for good
  HearIdle();
  EXPECT_EQ(dialogue_.phase(), Dialogue::Phase::kIdle);
}

TEST_F(DialogueTest, SaysSoWhenIntentionFallsSilent) {
  Begin();
  Pass(6 * kSecond);
  EXPECT_EQ(out_.notices.size(), 1u);
  Hear(SessionKind::kBegun, dialogue_.session_id());
  Pass(kSecond);
  EXPECT_EQ(out_.notices.size(), 1u);
}

}  // namespace
}  // namespace beckon::ui_bridge
