#include "services/base/trust/guard.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "lcmtypes/codec.h"
#include "tests/base/trust/temporary_keys.h"

namespace beckon::trust {
namespace {

constexpr Utime kNow = 1'700'000'000 * kSecond;

/// A sender and a receiver that trusts it.
class GuardTest : public ::testing::Test {
 protected:
  GuardTest() {
    EXPECT_TRUE(room_.folder().Trust(kitchen_.public_file(), std::nullopt).ok());
    receiver_ = Make(room_, clock_, steady_);
  }

  static std::unique_ptr<Guard> Make(const TemporaryKeys& keys, const Clock& clock,
                                     const Clock& steady, const std::string& counter_file = "") {
    return std::make_unique<Guard>(keys.folder(), *std::move(*keys.folder().Own()), counter_file,
                                   clock, steady);
  }

  template <typename T>
  static std::vector<uint8_t> Sealed(Guard& guard, T message) {
    message.seal.sender = "kitchen/test";
    guard.Stamp(message.seal, DemandOf(message).may_last);
    auto bytes = *Codec<T>::Encode(message);
    guard.Sign(bytes);
    return bytes;
  }

  /// The reason why the room does not believe it; empty where it does.
  template <typename T>
  std::string Hear(const std::vector<uint8_t>& bytes) {
    const auto message = Codec<T>::Decode(bytes);
    if (!message) return "malformed";
    const auto rejection =
        receiver_->Check(Codec<T>::kChannel, message->seal, DemandOf(*message), bytes);
    return rejection ? rejection->reason : "";
  }

  static msg::Answer ExampleAnswer() {
    return {.utime = 5, .query_id = 7, .session_id = "s", .device = "d", .likelihoods = {1, 0}};
  }
  static msg::Session Request(msg::SessionKind kind) {
    return {.utime = 5, .session_id = "s", .user = "ann", .device = "d", .kind = kind};
  }

  ManualClock clock_{kNow}, steady_{0};
  TemporaryKeys kitchen_{"kitchen"}, room_{"room"}, stranger_{"stranger"};
  std::unique_ptr<Guard> sender_ = Make(kitchen_, clock_, steady_);
  std::unique_ptr<Guard> receiver_;
};

TEST_F(GuardTest, BelievesWhatATrustedKeySigned) {
  for (int i = 0; i < 100; ++i) EXPECT_EQ(Hear<msg::Answer>(Sealed(*sender_, ExampleAnswer())), "");
}

TEST_F(GuardTest, BelievesItOnce) {
  const auto bytes = Sealed(*sender_, ExampleAnswer());
  EXPECT_EQ(Hear<msg::Answer>(bytes), "");
  EXPECT_EQ(Hear<msg::Answer>(bytes), "replayed");
}

TEST_F(GuardTest, MessagesMayOvertakeOneAnother) {
  const auto first = Sealed(*sender_, ExampleAnswer());
  const auto second = Sealed(*sender_, ExampleAnswer());
  EXPECT_EQ(Hear<msg::Answer>(second), "");
  EXPECT_EQ(Hear<msg::Answer>(first), "");
}

TEST_F(GuardTest, NothingUnsignedUnknownOrRevokedIsBelieved) {
  EXPECT_EQ(Hear<msg::Answer>(*Codec<msg::Answer>::Encode(ExampleAnswer())), "unsigned");
  EXPECT_EQ(Hear<msg::Answer>(Sealed(*Make(stranger_, clock_, steady_), ExampleAnswer())),
            "unknown_key");
  ASSERT_TRUE(room_.folder().Revoke("kitchen").ok());
  steady_.Advance(2 * kSecond);
  EXPECT_EQ(Hear<msg::Answer>(Sealed(*sender_, ExampleAnswer())), "revoked");
}

TEST_F(GuardTest, AKeyThatIsTrustedLaterIsBelievedWithoutARestart) {
  const auto stranger = Make(stranger_, clock_, steady_);
  EXPECT_EQ(Hear<msg::Answer>(Sealed(*stranger, ExampleAnswer())), "unknown_key");
  ASSERT_TRUE(room_.folder().Trust(stranger_.public_file(), std::nullopt).ok());
  steady_.Advance(2 * kSecond);
  EXPECT_EQ(Hear<msg::Answer>(Sealed(*stranger, ExampleAnswer())), "");
}

TEST_F(GuardTest, AKeySaysWhatItsRolesAllow) {
  ASSERT_TRUE(
      room_.folder().Trust(stranger_.public_file(), Roles::FromNames({"front-end"}).value()).ok());
  steady_.Advance(2 * kSecond);
  const auto stranger = Make(stranger_, clock_, steady_);
  EXPECT_EQ(Hear<msg::Answer>(Sealed(*stranger, ExampleAnswer())), "");
  EXPECT_EQ(Hear<msg::Session>(Sealed(*stranger, Request(msg::SessionKind::kRequestStart))), "");
  EXPECT_EQ(Hear<msg::Session>(Sealed(*stranger, Request(msg::SessionKind::kConfirmed))),
            "not_allowed");
  EXPECT_EQ(
      Hear<msg::TaskStatus>(Sealed(
          *stranger, msg::TaskStatus{.utime = 5, .task_id = "t", .state = msg::TaskState::kDone})),
      "not_allowed");
}

TEST_F(GuardTest, WhatExpiredIsRefusedButForAStop) {
  const auto answer = Sealed(*sender_, ExampleAnswer());
  const auto resume = Sealed(*sender_, Request(msg::SessionKind::kRequestResume));
  const auto stop = Sealed(*sender_, Request(msg::SessionKind::kRequestStop));
  const auto history = Sealed(*sender_, msg::History{.utime = 5, .machine = "kitchen", .run = "r"});
  clock_.Advance(3600 * kSecond);
  EXPECT_EQ(Hear<msg::Answer>(answer), "expired");
  EXPECT_EQ(Hear<msg::Session>(resume), "expired");
  EXPECT_EQ(Hear<msg::Session>(stop), "");
  EXPECT_EQ(Hear<msg::Session>(stop), "");
  EXPECT_EQ(Hear<msg::History>(history), "");
}

TEST_F(GuardTest, NoMutationIsBelieved) {
  const auto good = Sealed(*sender_, ExampleAnswer());
  std::mt19937 random(11);
  std::map<std::string, int> reasons;
  for (int i = 0; i < 2000; ++i) {
    auto bytes = good;
    bytes[random() % bytes.size()] ^= static_cast<uint8_t>(1 + random() % 255);
    const std::string reason = Hear<msg::Answer>(bytes);
    EXPECT_NE(reason, "") << "mutation " << i;
    ++reasons[reason];
  }
  EXPECT_GT(reasons["forged"], 1000);
  EXPECT_EQ(Hear<msg::Answer>(good), "") << "what was refused must not spoil the original";
}

TEST_F(GuardTest, AClockThatIsPutBackSilencesNobody) {
  ManualClock yesterday(kNow - 86'400 * kSecond);
  const std::string file = kitchen_.path() + "/counter";
  const auto before = Make(kitchen_, clock_, steady_, file);
  for (int i = 0; i < 300; ++i)
    EXPECT_EQ(Hear<msg::History>(
                  Sealed(*before, msg::History{.utime = 5, .machine = "kitchen", .run = "r"})),
              "");
  const auto after = Make(kitchen_, yesterday, steady_, file);
  EXPECT_EQ(Hear<msg::History>(
                Sealed(*after, msg::History{.utime = 5, .machine = "kitchen", .run = "r"})),
            "");
}

TEST_F(GuardTest, ATrustedMachineCannotFillTheMemory) {
  std::string reason;
  for (size_t i = 0; i <= Guard::kMostSenders && reason.empty(); ++i) {
    auto answer = ExampleAnswer();
    answer.seal.sender = "kitchen/" + std::to_string(i);
    sender_->Stamp(answer.seal, false);
    auto bytes = *Codec<msg::Answer>::Encode(answer);
    sender_->Sign(bytes);
    reason = Hear<msg::Answer>(bytes);
  }
  EXPECT_EQ(reason, "too_many_senders");
}

}  // namespace
}  // namespace beckon::trust
