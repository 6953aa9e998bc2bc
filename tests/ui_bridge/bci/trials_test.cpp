// The course of trials.
#include "services/ui_bridge/bci/trials.h"

#include <algorithm>

#include "tests/ui_bridge/bci/trials_fixture.h"

namespace beckon::ui_bridge::bci {
namespace {

using Request = msg::SessionKind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST_F(TrialsTest, AQuestionIsReadThenTriedUntilSureThenAnsweredOnce) {
  Begin();
  trials_->Present(Question(5), now_);
  Pass(1.4);
  EXPECT_THAT(out_.stimuli, IsEmpty());
  Decode(1, 0.7);
  EXPECT_THAT(out_.answers, IsEmpty());
  while (out_.answers.empty()) Decode(1, 0.7);
  ASSERT_THAT(out_.answers, SizeIs(1));
  EXPECT_THAT(out_.answered, ElementsAre(5));
  EXPECT_THAT(out_.answers[0], SizeIs(3));
  EXPECT_EQ(std::ranges::max_element(out_.answers[0]) - out_.answers[0].begin(), 1);
  EXPECT_GT(*std::ranges::min_element(out_.answers[0]), 0);  // never only the likeliest
  EXPECT_EQ(out_.behind[0].size(), out_.stimuli.size());
  EXPECT_EQ(out_.stimuli[0].query_id, 5);
  EXPECT_THAT(out_.stimuli[0].labels, ElementsAre("Option 0", "Option 1", "Option 2", "STOP"));
  EXPECT_EQ(out_.stimuli[1].repetition, 2);
  for (int i = 0; i < 20; ++i) Decode(1);
  EXPECT_THAT(out_.answers, SizeIs(1));
}

TEST_F(TrialsTest, TheAnswerLeavesThePriorOutAndStoppingTakesItIn) {
  config_.layout.controls.clear();
  Begin();
  auto query = Question(5, 2);
  query.prospects = {{0.99f, 3, 0}, {0.01f, 3, 0}};
  trials_->Present(query, now_);
  Decode(0, 0.4);
  ASSERT_THAT(out_.answers, SizeIs(1));  // one weak trial is enough for what was sure before
  EXPECT_LT(out_.answers[0][0], 0.75);
  trials_->Present(Question(6, 2), now_);
  Decode(0, 0.4);
  EXPECT_THAT(out_.answers, SizeIs(1));
}

TEST_F(TrialsTest, TrialsAreRepeatedWithNewNumbersThatGrow) {
  Begin();
  trials_->Present(Question(5), now_);
  for (int i = 0; i < 5; ++i) Decode(static_cast<size_t>(i) % 2, 0.4);
  for (size_t i = 0; i < out_.stimuli.size(); ++i)
    EXPECT_EQ(out_.stimuli[i].trial, 1000 + static_cast<int64_t>(i));
}

TEST_F(TrialsTest, AStimulusIsRepeatedUntilDecoded) {
  Begin();
  trials_->Present(Question(5), now_);
  ASSERT_TRUE(AwaitTrial());
  Pass(1.05);
  EXPECT_GE(out_.repeated, 4);
  EXPECT_LE(out_.repeated, 6);
  EXPECT_THAT(out_.stimuli, SizeIs(1));
}

TEST_F(TrialsTest, AnAnswerComesAfterTheMostRepetitionsHoweverUnsure) {
  config_.stopping.max_repetitions = 4;
  Begin();
  trials_->Present(Question(5), now_);
  for (int i = 0; i < 4; ++i) Decode(static_cast<size_t>(i) % 3, 0.4);
  ASSERT_THAT(out_.answers, SizeIs(1));
  EXPECT_LT(*std::ranges::max_element(out_.answers[0]), 0.8);
}

TEST_F(TrialsTest, WhatIsNotForThisTrialIsRefused) {
  Begin();
  trials_->Present(Question(5), now_);
  ASSERT_TRUE(AwaitTrial());
  auto decoding = Decoding(0, 0.5);
  decoding.device = "bci@elsewhere";
  EXPECT_EQ(WhyRefused(decoding), Refusal::kForeign);
  for (const int64_t trial : {int64_t{0}, int64_t{999}, trials_->trial() + 1}) {
    decoding = Decoding(0, 0.5);
    decoding.trial = trial;
    EXPECT_EQ(WhyRefused(decoding), Refusal::kStale) << trial;
  }
  for (const auto& p : std::vector<std::vector<double>>{
           {}, {0.5, 0.5}, {0.2, 0.2, 0.2, 0.2, 0.2}, {NAN, 0.3, 0.3, 0.4}, {1, 1, -1, 0}}) {
    decoding = Decoding(0, 0.5);
    decoding.probabilities = p;
    EXPECT_EQ(WhyRefused(decoding), Refusal::kMalformed);
  }
  EXPECT_EQ(trials_->counters().decoded, 0);
  const auto right = Decoding(0, 0.5);
  EXPECT_FALSE(trials_->OnDecoding(right, now_));
  EXPECT_EQ(WhyRefused(right), Refusal::kDuplicate);
  ASSERT_TRUE(AwaitTrial());
  EXPECT_EQ(WhyRefused(right), Refusal::kDuplicate);
  EXPECT_EQ(trials_->counters().decoded, 1);
  EXPECT_EQ(trials_->counters().refused, 11);
}

TEST_F(TrialsTest, TheFirstDecoderCountsUntilItFallsSilent) {
  Begin();
  trials_->Present(Question(5), now_);
  Decode(0, 0.4);
  ASSERT_TRUE(AwaitTrial());
  auto other = Decoding(1, 0.5);
  other.decoder = "net";
  EXPECT_EQ(WhyRefused(other), Refusal::kOtherDecoder);
  Pass(11);  // silent
  other = Decoding(1, 0.5);
  other.decoder = "net";
  EXPECT_FALSE(trials_->OnDecoding(other, now_));
  EXPECT_THAT(out_.decoders, ElementsAre("cap", "net"));
}

TEST_F(TrialsTest, ANamedDecoderIsTheOnlyOneThatCounts) {
  config_.decoder = "net";
  Begin();
  trials_->Present(Question(5), now_);
  ASSERT_TRUE(AwaitTrial());
  EXPECT_EQ(WhyRefused(Decoding(0)), Refusal::kOtherDecoder);
  Pass(30);
  EXPECT_EQ(WhyRefused(Decoding(0)), Refusal::kOtherDecoder);
}

TEST_F(TrialsTest, ASilentDecoderIsToldOfOnceAndSoIsItsReturn) {
  Begin();
  trials_->Present(Question(5), now_);
  Pass(65);
  EXPECT_THAT(out_.notices, ElementsAre(HasSubstr("Nothing comes from the decoder")));
  EXPECT_GE(trials_->counters().lost, 5);
  Decode(1);
  EXPECT_THAT(out_.notices, ElementsAre(HasSubstr("Nothing"), HasSubstr("back")));
  while (out_.answers.empty()) Decode(1);
  Pass(60);
  EXPECT_THAT(out_.notices, SizeIs(3));
}

TEST_F(TrialsTest, AWithdrawnQuestionIsNeverAnswered) {
  Begin();
  trials_->Present(Question(5), now_);
  Decode(1, 0.6);
  ASSERT_TRUE(AwaitTrial());
  const auto late = Decoding(1, 0.99);
  trials_->Withdraw(now_);
  EXPECT_EQ(WhyRefused(late), Refusal::kStale);
  for (int i = 0; i < 20; ++i) Decode(1, 0.97);
  EXPECT_THAT(out_.answers, IsEmpty());
  trials_->Present(Question(6), now_);
  EXPECT_EQ(trials_->repetitions(), 0);
  while (out_.answers.empty()) Decode(2);
  EXPECT_THAT(out_.answered, ElementsAre(6));
}

TEST_F(TrialsTest, ANewQuestionTakesNoTrialsFromTheOneBefore) {
  Begin();
  trials_->Present(Question(5), now_);
  Decode(0, 0.8);
  trials_->Present(Question(6), now_);
  Decode(2, 0.6);
  EXPECT_THAT(out_.answers, IsEmpty());
  while (out_.answers.empty()) Decode(2, 0.6);
  EXPECT_GT(out_.answers[0][2], 0.9);
}

TEST_F(TrialsTest, StopByTheDecoderIsRequestedWithinTheTrialThatSaysSo) {
  Begin();
  trials_->Present(Question(5), now_);
  Decode(0, 0.6);
  for (int i = 0; i < 10 && out_.requests.empty(); ++i) Decode(3, 0.95);
  EXPECT_THAT(out_.requests, ElementsAre(Request::kRequestStop));
  EXPECT_EQ(trials_->trial(), 0);
  EXPECT_LE(trials_->counters().decoded, 4);
  EXPECT_EQ(trials_->counters().stops, 1);
  Pass(30);  // not announced yet: nothing is asked
  EXPECT_EQ(trials_->trial(), 0);
  EXPECT_THAT(out_.answers, IsEmpty());
}

TEST_F(TrialsTest, StopIsWatchedForWhenNoQuestionStands) {
  Begin();
  for (int i = 0; i < 10 && out_.requests.empty(); ++i) Decode(3, 0.95);
  EXPECT_THAT(out_.requests, ElementsAre(Request::kRequestStop));
  EXPECT_EQ(out_.stimuli[0].query_id, 0);
  EXPECT_THAT(out_.stimuli[0].labels, ElementsAre("", "", "", "STOP"));
}

TEST_F(TrialsTest, StopByHandIsAtOnceInEveryState) {
  for (int state = 0; state < 6; ++state) {
    out_ = {};
    Begin();
    if (state >= 1) trials_->Present(Question(5), now_);
    if (state == 2) {
      ASSERT_TRUE(AwaitTrial());
    }
    if (state == 3) Decode(0, 0.5);
    if (state == 4) trials_->TogglePause(now_);
    if (state == 5) trials_->OnSession(Request::kConfirmed, now_);
    trials_->Stop(now_);
    EXPECT_THAT(out_.requests, ElementsAre(Request::kRequestStop)) << state;
    EXPECT_EQ(trials_->trial(), 0);
  }
}

TEST_F(TrialsTest, AfterAStopOnlySayingSoTwiceInDifferentPlacesGoesOn) {
  Begin();
  trials_->OnSession(Request::kStopped, now_);
  const Utime stopped = now_;
  ASSERT_TRUE(AwaitTrial());
  EXPECT_GE(now_ - stopped, 10 * kSecond);
  EXPECT_THAT(out_.stimuli.back().labels[0], "Go on");
  while (trials_->Text() != "Really go on?") Decode(0);
  EXPECT_THAT(out_.requests, IsEmpty());
  ASSERT_TRUE(AwaitTrial());
  EXPECT_THAT(out_.stimuli.back().labels[0], "Stay stopped");
  while (out_.requests.empty()) Decode(1);
  EXPECT_THAT(out_.requests, ElementsAre(Request::kRequestResume));
}

TEST_F(TrialsTest, AClassThatIsAlwaysDecodedNeverGoesOn) {
  for (const size_t stuck : {size_t{0}, size_t{1}, size_t{2}, size_t{3}}) {
    out_ = {};
    Begin();
    trials_->OnSession(Request::kStopped, now_);
    for (int i = 0; i < 60; ++i) Decode(stuck, 0.99);
    EXPECT_THAT(out_.requests, IsEmpty()) << stuck;
  }
}

TEST_F(TrialsTest, PauseAsksNothingOfTheQuestionUntilGoneOn) {
  config_.layout = {.rows = 2, .columns = 3, .controls = {Control::kPause, Control::kStop}};
  Begin();
  trials_->Present(Question(5), now_);
  while (trials_->asking() != Asking::kPaused) Decode(4);
  trials_->Present(Question(6), now_);
  EXPECT_EQ(trials_->asking(), Asking::kPaused);
  ASSERT_TRUE(AwaitTrial());
  EXPECT_EQ(out_.stimuli.back().query_id, 0);
  while (trials_->asking() == Asking::kPaused) Decode(0);
  while (out_.answers.empty()) Decode(2);
  EXPECT_THAT(out_.answered, ElementsAre(6));
  EXPECT_THAT(out_.requests, IsEmpty());
}

TEST_F(TrialsTest, UndoIsRequestedAndTheQuestionAskedAgainWhereNothingFollows) {
  config_.layout = {.rows = 2, .columns = 2, .controls = {Control::kUndo}};
  Begin();
  trials_->Present(Question(5), now_);
  while (out_.requests.empty()) Decode(3);
  EXPECT_THAT(out_.requests, ElementsAre(Request::kRequestUndo));
  EXPECT_THAT(out_.answers, IsEmpty());
  while (out_.answers.empty()) Decode(1);
  EXPECT_THAT(out_.answered, ElementsAre(5));
}

TEST_F(TrialsTest, AQuestionThatDoesNotFitIsLeftToOthers) {
  Begin();
  trials_->Present(Question(5, 4), now_);
  EXPECT_THAT(out_.notices, ElementsAre(HasSubstr("4 answers")));
  for (int i = 0; i < 20; ++i) Decode(1);
  EXPECT_THAT(out_.answers, IsEmpty());
}

TEST_F(TrialsTest, TwoClassesAnswerYesAndNo) {
  config_.layout = {.mode = msg::StimulusMode::kBinary};
  Begin();
  EXPECT_EQ(trials_->asking(), Asking::kNothing);  // no class for stop
  trials_->Present(Question(5, 2), now_);
  while (out_.answers.empty()) Decode(1, 0.8);
  EXPECT_EQ(out_.stimuli[0].mode, msg::StimulusMode::kBinary);
  EXPECT_EQ(out_.stimuli[0].rows, 1);
  EXPECT_EQ(out_.stimuli[0].columns, 2);
  EXPECT_GT(out_.answers[0][1], 0.9);
}

TEST_F(TrialsTest, AnotherTaskIsOfferedAfterARestAndAskedForWhenWanted) {
  Begin();
  trials_->OnSession(Request::kConfirmed, now_);
  Pass(9);
  EXPECT_EQ(trials_->asking(), Asking::kWatch);
  Pass(2);
  EXPECT_EQ(trials_->Text(), "Another task?");
  while (trials_->Text() == "Another task?") Decode(1);  // not now
  EXPECT_THAT(out_.requests, IsEmpty());
  Pass(12);
  EXPECT_EQ(trials_->Text(), "Another task?");
  while (out_.requests.empty()) Decode(0);
  EXPECT_THAT(out_.requests, ElementsAre(Request::kRequestStart));
  EXPECT_EQ(trials_->asking(), Asking::kWatch);
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
