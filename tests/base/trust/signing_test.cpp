#include "services/base/trust/signing.h"

#include <gtest/gtest.h>

#include <random>

#include "lcmtypes/codec.h"
#include "services/base/trust/replay_window.h"
#include "services/base/trust/roles.h"

namespace beckon::trust {
namespace {

std::vector<uint8_t> Encoded() {
  return *Codec<msg::TaskStatus>::Encode(
      {.utime = 5, .task_id = "t", .state = msg::TaskState::kDone, .text = "done"});
}

TEST(Signing, IsOfThatKeyAndOfThoseBytesAlone) {
  const SecretKey key = SecretKey::Generate();
  auto bytes = Encoded();
  EXPECT_FALSE(IsSignedBy(bytes, key.public_key()));
  key.Sign(bytes);
  EXPECT_TRUE(IsSignedBy(bytes, key.public_key()));
  EXPECT_FALSE(IsSignedBy(bytes, SecretKey::Generate().public_key()));
  for (size_t i = 0; i < bytes.size(); ++i) {
    for (const uint8_t bit : {1, 128}) {
      bytes[i] ^= bit;
      EXPECT_FALSE(IsSignedBy(bytes, key.public_key())) << "byte " << i;
      bytes[i] ^= bit;
    }
  }
  bytes.push_back(0);
  EXPECT_FALSE(IsSignedBy(bytes, key.public_key()));
}

TEST(Signing, LeavesAMessageThatDecodesToTheSame) {
  auto bytes = Encoded();
  SecretKey::Generate().Sign(bytes);
  const auto status = Codec<msg::TaskStatus>::Decode(bytes);
  ASSERT_TRUE(status.ok()) << status.error().message;
  EXPECT_EQ(status->text, "done");
}

// RFC 8032, section 7.1, test 1: the public key of that secret.
TEST(Signing, MakesThePublicKeyOfThePublishedExample) {
  const auto key = SecretKey::FromText("nWGxne/9WmC6hEr0kuwsxERJxWl7MmkZcDusAxyuf2A=");
  ASSERT_TRUE(key.ok());
  EXPECT_EQ(ToText(IdOf(key->public_key())), "d75a980182b10ab7");
}

TEST(Signing, ReadsTheKeysItWrote) {
  const SecretKey key = SecretKey::Generate();
  EXPECT_EQ(SecretKey::FromText(key.ToText())->public_key(), key.public_key());
  EXPECT_EQ(*PublicKeyFromText(ToText(key.public_key())), key.public_key());
}

TEST(Signing, RefusesWhatIsNoKey) {
  for (const char* text : {"", "AAAA", "not base64 at all, but quite long enough..",
                           "nWGxne/9WmC6hEr0kuwsxERJxWl7MmkZcDusAxyuf2A"})
    EXPECT_FALSE(SecretKey::FromText(text).ok()) << text;
}

TEST(ReplayWindow, TakesEachCounterOnceInAnyOrderWithinItsReach) {
  ReplayWindow window;
  std::vector<int64_t> counters;
  for (int64_t i = 0; i < 5000; ++i) counters.push_back(1'000'000 + 977 * i);
  std::mt19937 random(3);
  for (size_t i = 0; i + 100 <= counters.size(); i += 100)
    std::shuffle(counters.begin() + static_cast<ptrdiff_t>(i),
                 counters.begin() + static_cast<ptrdiff_t>(i) + 100, random);
  for (const int64_t counter : counters) {
    EXPECT_TRUE(window.IsFresh(counter));
    window.Note(counter);
  }
  for (const int64_t counter : counters) EXPECT_FALSE(window.IsFresh(counter));
}

TEST(Roles, AreReadAndWrittenByName) {
  const auto roles = Roles::FromNames({"front-end", "robot"});
  ASSERT_TRUE(roles.ok());
  EXPECT_TRUE(roles->Has(Role::kFrontEnd));
  EXPECT_FALSE(roles->Has(Role::kIntention));
  EXPECT_EQ(roles->Names(), (std::vector<std::string>{"front-end", "robot"}));
  EXPECT_FALSE(Roles::FromNames({"cook"}).ok());
}

TEST(Roles, AFrontEndMayAnswerButNotPublishTasks) {
  const Roles front_end = *Roles::FromNames({"front-end"});
  EXPECT_TRUE(front_end.HasAnyOf(DemandOf(msg::Answer{}).one_of));
  EXPECT_TRUE(
      front_end.HasAnyOf(DemandOf(msg::Session{.kind = msg::SessionKind::kRequestStart}).one_of));
  EXPECT_FALSE(
      front_end.HasAnyOf(DemandOf(msg::Session{.kind = msg::SessionKind::kConfirmed}).one_of));
  EXPECT_FALSE(front_end.HasAnyOf(DemandOf(msg::Task{}).one_of));
  EXPECT_FALSE(front_end.HasAnyOf(DemandOf(msg::Query{}).one_of));
  EXPECT_FALSE(front_end.HasAnyOf(DemandOf(msg::History{}).one_of));
  EXPECT_FALSE(front_end.HasAnyOf(DemandOf(msg::Scene{}).one_of));
}

TEST(Roles, AnybodyMayStopTheRobotHoweverLate) {
  for (const auto& [role, name] : kRoleNames) {
    Roles one;
    one.Add(role);
    EXPECT_TRUE(
        one.HasAnyOf(DemandOf(msg::Session{.kind = msg::SessionKind::kRequestStop}).one_of));
  }
  EXPECT_TRUE(DemandOf(msg::Session{.kind = msg::SessionKind::kRequestStop}).may_last);
  EXPECT_FALSE(DemandOf(msg::Session{.kind = msg::SessionKind::kRequestResume}).may_last);
}

}  // namespace
}  // namespace beckon::trust
