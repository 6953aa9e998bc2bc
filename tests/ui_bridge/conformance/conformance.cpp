// The rules that every front end keeps (docs/protocol.md, CONTRIBUTING.md).
#include "tests/ui_bridge/conformance/conformance.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "lcmtypes/codec.h"

namespace beckon::ui_bridge::conformance {
namespace {

using msg::QueryKind;
using msg::SessionKind;
using ::testing::Each;
using ::testing::Ge;

size_t Likeliest(const msg::Answer& answer) {
  return static_cast<size_t>(std::ranges::max_element(answer.likelihoods) -
                             answer.likelihoods.begin());
}

#define PRESS_STOP() \
  if (!hand_->Stop()) GTEST_SKIP() << "nobody can make " << hand_->front_end() << " stop"

TEST_P(FrontEndConformance, AnnouncesWhatItCanDoAndHowItErrs) {
  ASSERT_TRUE(Await([this] { return interface_.has_value(); })) << "no INTERFACE came";
  EXPECT_TRUE(Codec<msg::Interface>::Encode(*interface_).ok());
  EXPECT_GE(interface_->max_options, 2);
  EXPECT_GT(interface_->seconds_per_question, 0);
  EXPECT_LE(interface_->false_yes, 0.5f);
  EXPECT_LE(interface_->false_no, 0.5f);
}

TEST_P(FrontEndConformance, AsksForASessionUntilOneBegins) {
  hand_->Start();
  ASSERT_TRUE(Await([this] { return Count(SessionKind::kRequestStart) >= 2; }));
  BeginSession();
  Let(0.1);
  const int asked = Count(SessionKind::kRequestStart);
  Let(1.2);
  EXPECT_EQ(Count(SessionKind::kRequestStart), asked);
}

TEST_P(FrontEndConformance, AnswersEveryKindOfQuestion) {
  ASSERT_TRUE(Await([this] { return interface_.has_value(); }));
  BeginSession();
  for (const auto kind :
       {QueryKind::kAction, QueryKind::kObject, QueryKind::kFull, QueryKind::kCategory,
        QueryKind::kSet, QueryKind::kChoice, QueryKind::kWhatIsIt}) {
    SCOPED_TRACE(msg::Name(kind));
    if (kind == QueryKind::kChoice && interface_->kind == msg::InterfaceKind::kYesNo) continue;
    for (size_t option = 0; option < Question(kind).options.size(); ++option) {
      const msg::Query query = Ask(kind);
      const size_t chosen = hand_->Choose(query, option);
      const msg::Answer* answer = AnswerTo(query);
      ASSERT_NE(answer, nullptr) << "no answer by option " << chosen;
      EXPECT_EQ(answer->session_id, query.session_id);
      EXPECT_EQ(answer->device, device_);
      ASSERT_EQ(answer->likelihoods.size(), query.options.size());
      EXPECT_THAT(answer->likelihoods, Each(Ge(0)));
      EXPECT_EQ(Likeliest(*answer), chosen);
    }
  }
}

TEST_P(FrontEndConformance, AnswersAQuestionOnceHoweverOftenItIsRepeated) {
  BeginSession();
  const msg::Query query = Ask(QueryKind::kFull);
  hand_->Choose(query, 0);
  ASSERT_NE(AnswerTo(query), nullptr);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(bus_->Publish(query));
  Let(0.8);
  EXPECT_EQ(DistinctAnswers().size(), 1u);
}

TEST_P(FrontEndConformance, AnswersNoQuestionThatAnotherHasReplaced) {
  BeginSession();
  const msg::Query first = Ask(QueryKind::kAction);
  const msg::Query second = Ask(QueryKind::kFull);
  hand_->Choose(second, 0);
  ASSERT_NE(AnswerTo(second), nullptr);
  ASSERT_TRUE(bus_->Publish(first));  // a late copy
  Let(0.3);
  EXPECT_EQ(std::ranges::count(answers_, first.id, &msg::Answer::query_id), 0);
}

TEST_P(FrontEndConformance, AnswersNothingOnceTheSessionIsOver) {
  BeginSession();
  const msg::Query query = Ask(QueryKind::kFull);
  Announce(SessionKind::kConfirmed);
  Let(0.1);
  hand_->Choose(query, 0);
  Let(0.6);
  EXPECT_TRUE(answers_.empty());
}

TEST_P(FrontEndConformance, StopsWhileAQuestionStands) {
  BeginSession();
  Ask(QueryKind::kFull);
  PRESS_STOP();
  EXPECT_TRUE(Await([this] { return Count(SessionKind::kRequestStop) > 0; }));
  EXPECT_TRUE(answers_.empty());
}

TEST_P(FrontEndConformance, StopsAfterAnAnswerAndBeforeAnyQuestion) {
  BeginSession();
  Let(0.05);
  PRESS_STOP();
  ASSERT_TRUE(Await([this] { return Count(SessionKind::kRequestStop) > 0; }))
      << "before a question";
  Announce(SessionKind::kStopped);
  Let(0.05);
  hand_->Resume();
  ASSERT_TRUE(Await([this] { return Count(SessionKind::kRequestResume) > 0; }));
  Announce(SessionKind::kIdle);
  Let(0.05);
  requests_.clear();
  BeginSession();
  const msg::Query query = Ask(QueryKind::kFull);
  hand_->Choose(query, 0);
  ASSERT_NE(AnswerTo(query), nullptr);
  PRESS_STOP();
  EXPECT_TRUE(Await([this] { return Count(SessionKind::kRequestStop) > 0; })) << "after an answer";
}

TEST_P(FrontEndConformance, StopsAfterASessionToo) {
  BeginSession();
  const msg::Query query = Ask(QueryKind::kFull);
  hand_->Choose(query, 0);
  ASSERT_NE(AnswerTo(query), nullptr);
  Announce(SessionKind::kConfirmed, 1);
  Let(0.1);
  PRESS_STOP();
  EXPECT_TRUE(Await([this] { return Count(SessionKind::kRequestStop) > 0; }));
}

TEST_P(FrontEndConformance, RepeatsAStopUntilItWasHeardAndAnswersNothingMeanwhile) {
  BeginSession();
  const msg::Query query = Ask(QueryKind::kFull);
  silent_ = true;
  PRESS_STOP();
  ASSERT_TRUE(Await([this] { return Count(SessionKind::kRequestStop) >= 2; }));
  silent_ = false;
  Announce(SessionKind::kStopped);
  Let(0.1);
  const int stops = Count(SessionKind::kRequestStop);
  hand_->Choose(query, 0);
  Let(1.2);
  EXPECT_EQ(Count(SessionKind::kRequestStop), stops);
  EXPECT_TRUE(answers_.empty());
}

TEST_P(FrontEndConformance, NeverResumesByItself) {
  BeginSession();
  Ask(QueryKind::kFull);
  PRESS_STOP();
  ASSERT_TRUE(Await([this] { return Count(SessionKind::kRequestStop) > 0; }));
  Announce(SessionKind::kStopped);
  Let(1.5);
  EXPECT_EQ(Count(SessionKind::kRequestResume), 0);
  hand_->Resume();
  EXPECT_TRUE(Await([this] { return Count(SessionKind::kRequestResume) > 0; }));
}

TEST_P(FrontEndConformance, StopsWhenAnotherFrontEndStopped) {
  BeginSession();
  const msg::Query query = Ask(QueryKind::kFull);
  const int starts = Count(SessionKind::kRequestStart);
  Announce(SessionKind::kStopped);
  Let(0.1);
  hand_->Choose(query, 0);
  Let(1.2);
  EXPECT_TRUE(answers_.empty());
  EXPECT_EQ(Count(SessionKind::kRequestStart), starts);
}

TEST_P(FrontEndConformance, GoesOnWhereAnotherFrontEndAnswered) {
  BeginSession();
  Ask(QueryKind::kAction);
  const msg::Query next = Ask(QueryKind::kFull);  // somebody else was quicker
  hand_->Choose(next, 0);
  EXPECT_NE(AnswerTo(next), nullptr);
}

TEST_P(FrontEndConformance, StartsOverWithARestartedIntention) {
  BeginSession();
  Ask(QueryKind::kAction);
  const std::string before = session_id_;
  silent_ = true;
  query_.reset();
  announced_.reset();
  requests_.clear();
  Let(0.3);
  silent_ = false;
  Announce(SessionKind::kIdle);
  ASSERT_TRUE(Await([this] { return Count(SessionKind::kRequestStart) > 0; }));
  EXPECT_EQ(session_id_, before);
  Announce(SessionKind::kBegun);
  const msg::Query query = Ask(QueryKind::kFull);
  hand_->Choose(query, 0);
  EXPECT_NE(AnswerTo(query), nullptr);
}

TEST_P(FrontEndConformance, JoinsASessionThatRunsAlready) {
  session_id_ = "begun-elsewhere";
  const std::string running = session_id_;
  Announce(SessionKind::kBegun);
  const msg::Query query = Ask(QueryKind::kFull);
  hand_->Choose(query, 0);
  const msg::Answer* answer = AnswerTo(query);
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(answer->session_id, running);
}

TEST_P(FrontEndConformance, TakesAnAnswerBack) {
  BeginSession();
  const msg::Query query = Ask(QueryKind::kAction);
  hand_->Choose(query, 0);
  ASSERT_NE(AnswerTo(query), nullptr);
  Ask(QueryKind::kFull);
  if (!hand_->Undo()) GTEST_SKIP() << hand_->front_end() << " has no way to take an answer back";
  EXPECT_TRUE(Await([this] { return Count(SessionKind::kRequestUndo) > 0; }));
}

}  // namespace
}  // namespace beckon::ui_bridge::conformance
