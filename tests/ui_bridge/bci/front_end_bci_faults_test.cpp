// The front end bci when others do not do as they should.
#include <random>

#include "tests/ui_bridge/bci/front_end_fixture.h"

namespace beckon::ui_bridge::bci {
namespace {

using Kind = msg::SessionKind;
using ::testing::SizeIs;

class BciFaultsTest : public FrontEndTest {};

TEST_F(BciFaultsTest, WrongDecodingsAreRefusedCountedAndDoNotCount) {
  on_begun_ = [this] { Ask(1); };
  int right = 0;
  decode_ = [&](const msg::Stimulus& stimulus) {
    if (stimulus.query_id == 0) return;
    auto foreign = Decoding(stimulus, 0, 0.99);
    foreign.device = "bci@elsewhere";
    auto stale = Decoding(stimulus, 0, 0.99);
    stale.trial -= 1;
    auto short_of = Decoding(stimulus, 0, 0.99);
    short_of.probabilities = {0.99, 0.01};
    for (const auto& wrong : {foreign, stale, short_of}) ASSERT_TRUE(bus_->Publish(wrong));
    Decode(stimulus, 1);
    Decode(stimulus, 0, 0.99);  // the same trial again
    ++right;
  };
  ASSERT_TRUE(Start(Quick()));
  Until([this] { return !answers_.empty(); });
  EXPECT_GT(answers_[0].likelihoods[1], 0.9);
  Until([&] { return RefusedDecodings() >= 4 * right; });
  EXPECT_EQ(RefusedDecodings(), 4 * right);
}

TEST_F(BciFaultsTest, WhatIsNoMessageIsRefusedBeforeItIsRead) {
  auto decoding = Decoding({.device = "bci@test", .trial = 1, .labels = {"a", "b"}}, 0);
  decoding.probabilities = {NAN, 1};
  EXPECT_FALSE(bus_->Publish(decoding));
  decoding.probabilities = {0.7, 0.7};
  EXPECT_FALSE(bus_->Publish(decoding));
}

TEST_F(BciFaultsTest, ADecoderThatVanishesAndReturnsGoesOnWhereItWas) {
  on_begun_ = [this] { Ask(1); };
  bool there = true;
  int64_t vanished_at = 0;
  decode_ = [&](const msg::Stimulus& stimulus) {
    if (stimulus.query_id == 0) return;
    if (stimulus.repetition == 2 && vanished_at == 0) {
      there = false;
      vanished_at = stimulus.trial;
    }
    if (stimulus.trial >= vanished_at + 3) there = true;
    if (there) Decode(stimulus, 1, 0.6);
  };
  ASSERT_TRUE(Start(Quick()));
  Until([this] { return !answers_.empty(); });
  EXPECT_GT(answers_[0].likelihoods[1], 0.9);
  EXPECT_GE(stimuli_.size(), 6u);
}

TEST_F(BciFaultsTest, AQuestionThatIsReplacedMidTrialIsNotAnswered) {
  on_begun_ = [this] { Ask(1); };
  decode_ = [this](const msg::Stimulus& stimulus) {
    if (stimulus.query_id == 1) {
      const auto late = Decoding(stimulus, 0, 0.99);
      Ask(2);
      ASSERT_TRUE(bus_->Publish(late));
    } else if (stimulus.query_id == 2) {
      Decode(stimulus, 2);
    }
  };
  ASSERT_TRUE(Start(Quick()));
  Until([this] { return !answers_.empty(); });
  EXPECT_EQ(answers_[0].query_id, 2);
  EXPECT_GT(answers_[0].likelihoods[2], 0.9);
  EXPECT_EQ(times_answered_.count(1), 0u);
  EXPECT_EQ(RefusedDecodings(), 1);
}

TEST_F(BciFaultsTest, IntentionThatRestartsMidTrialIsAnsweredAnew) {
  on_begun_ = [this] { Ask(1); };
  bool restarted = false;
  decode_ = [&](const msg::Stimulus& stimulus) {
    if (stimulus.query_id == 0) return;
    if (!restarted) {
      restarted = true;
      session_.clear();
      Tell(Kind::kIdle);  // it knows nothing of the session
      return;
    }
    Decode(stimulus, 1);
  };
  ASSERT_TRUE(Start(Quick()));
  Until([this] { return !answers_.empty(); });
  EXPECT_TRUE(restarted);
  EXPECT_GT(answers_[0].likelihoods[1], 0.9);
}

TEST_F(BciFaultsTest, AFloodOfHostileDecodingsLeavesItAlive) {
  std::mt19937_64 random(6);
  on_begun_ = [this] { Ask(1); };
  int sent = 0;
  decode_ = [&](const msg::Stimulus& stimulus) {
    if (stimulus.query_id == 0) return;
    for (int i = 0; i < 20; ++i, ++sent) {  // all of the wrong size, trial or device
      auto decoding = Decoding(stimulus, random() % 4, 0.99);
      const auto kind = random() % 3;
      if (kind == 0) decoding.trial = 1 + static_cast<int64_t>(random() >> 2);
      if (kind == 1) decoding.device = "x" + std::to_string(random());
      if (kind == 2) {
        decoding.probabilities.assign(5 + random() % 60, 0.0);
        decoding.probabilities[random() % 5] = 1;
      }
      ASSERT_TRUE(bus_->Publish(decoding));
    }
    Decode(stimulus, 2, 0.5);
  };
  ASSERT_TRUE(Start(Quick()));
  Until([this] { return !answers_.empty(); });
  EXPECT_EQ(RefusedDecodings(), sent);
  EXPECT_GE(sent, 60);
  EXPECT_GT(answers_[0].likelihoods[2], 0.9);
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
