// Leases one by one: who gets them, keeps them, loses them.
#include "services/intention/core/lease.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace beckon::intention {
namespace {

constexpr Utime kMs = 1000;

/// One service's leases on a clock of its own, and what came of them.
struct Node {
  explicit Node(const std::string& machine, const std::string& run = "1")
      : self{machine, run}, leases(self, now) {
    Wait(2 * kSecond);  // no peer was heard
  }

  void Wait(Utime duration) {
    for (const Utime end = now + duration; now < end;) {
      now += 50 * kMs;
      leases.Tick(now);
      Take();
    }
  }
  /// As a process that was stopped.
  void StandStill(Utime duration) {
    now += duration;
    leases.Tick(now);
    Take();
  }
  void Claim(bool has_scene = true, const std::string& session = "s1") {
    leases.Claim("ann", session, has_scene, now);
    Take();
  }
  void Hear(const msg::Lease& lease) {
    EXPECT_TRUE(leases.OnLease(lease, now));
    Take();
  }
  void Take() {
    for (const LeaseNews& news : leases.Taken()) {
      if (const auto* lease = std::get_if<msg::Lease>(&news)) said.push_back(*lease);
      won += std::holds_alternative<LeaseWon>(news) ? 1 : 0;
      lost += std::holds_alternative<LeaseLost>(news) ? 1 : 0;
      if (const auto* orphan = std::get_if<LeaseOrphaned>(&news)) orphan_of = orphan->session_id;
    }
  }
  LeaseState state() const { return leases.StateOf("ann"); }
  bool holds() const { return leases.Holds("ann", now); }

  LeaseHolder self;
  Utime now = 77 * kSecond;
  Leases leases;
  std::vector<msg::Lease> said;
  int won = 0;
  int lost = 0;
  std::string orphan_of;
};

TEST(Lease, IsWonAtOnceByAServiceThatIsAlone) {
  Node kitchen("kitchen");
  kitchen.Claim();
  EXPECT_TRUE(kitchen.holds());
  EXPECT_EQ(kitchen.won, 1);
  ASSERT_EQ(kitchen.said.size(), 1u);
  EXPECT_EQ(kitchen.said[0].session_id, "s1");
  EXPECT_EQ(kitchen.said[0].remaining_ms, 2000);
  EXPECT_GE(kitchen.said[0].term, 1);
}

TEST(Lease, WaitsForRivalsWhereAPeerLivesOrMayNotHaveBeenHeardYet) {
  Node peer("kitchen");
  peer.leases.HearPeer(peer.now);
  peer.Claim();
  EXPECT_EQ(peer.state(), LeaseState::kClaiming);
  peer.Wait(100 * kMs);
  EXPECT_FALSE(peer.holds());
  peer.Wait(50 * kMs);
  EXPECT_TRUE(peer.holds());

  Leases fresh({"kitchen", "1"}, 0);
  fresh.Claim("ann", "s1", true, 0);
  EXPECT_EQ(fresh.StateOf("ann"), LeaseState::kClaiming);
}

TEST(Lease, IsRepeatedWhileItIsHeldAndGivenBackAtTheEnd) {
  Node kitchen("kitchen"), bedroom("bedroom");
  kitchen.Claim();
  kitchen.Wait(10 * kSecond);
  EXPECT_TRUE(kitchen.holds());
  EXPECT_GE(kitchen.said.size(), 20u);
  bedroom.Hear(kitchen.said.back());
  EXPECT_EQ(bedroom.state(), LeaseState::kElsewhere);
  kitchen.leases.GiveBack("ann", kitchen.now);
  kitchen.Take();
  EXPECT_EQ(kitchen.said.back().remaining_ms, 0);
  bedroom.Hear(kitchen.said.back());
  EXPECT_EQ(bedroom.state(), LeaseState::kFree);
  bedroom.Wait(5 * kSecond);
  EXPECT_EQ(bedroom.orphan_of, "") << "it ended, there is nothing to take over";
}

TEST(Lease, ThatItIsGivenBackIsSaidUntilItRanOutEverywhere) {
  Node kitchen("kitchen");
  kitchen.Claim();
  kitchen.leases.GiveBack("ann", kitchen.now);
  kitchen.Wait(10 * kSecond);
  const auto farewells = std::ranges::count(kitchen.said, 0, &msg::Lease::remaining_ms);
  EXPECT_EQ(farewells, 4) << "at once and every 0.5 s within 2 s";
  EXPECT_EQ(kitchen.said.back().remaining_ms, 0);
}

TEST(Lease, AClaimLosesToAHigherTermAndSpeaksUpAgainstALowerOne) {
  Node kitchen("kitchen"), bedroom("bedroom");
  for (Node* node : {&kitchen, &bedroom}) node->leases.HearPeer(node->now);
  kitchen.Claim(/*has_scene=*/true);
  bedroom.Claim(/*has_scene=*/false);
  EXPECT_GT(kitchen.said[0].term, bedroom.said[0].term) << "one that sees a table is better";
  kitchen.Hear(bedroom.said[0]);
  EXPECT_EQ(kitchen.state(), LeaseState::kClaiming);
  EXPECT_EQ(kitchen.said.size(), 2u) << "bedroom may not have heard it";
  bedroom.Hear(kitchen.said[0]);
  EXPECT_EQ(bedroom.lost, 1);
  kitchen.Wait(kSecond);
  bedroom.Wait(kSecond);
  EXPECT_TRUE(kitchen.holds());
  EXPECT_EQ(bedroom.state(), LeaseState::kElsewhere);
}

TEST(Lease, GoesToWhoeverLedLastThenToTheHigherName) {
  Node kitchen("kitchen"), bedroom("bedroom");
  bedroom.Claim(/*has_scene=*/false);
  bedroom.leases.GiveBack("ann", bedroom.now);
  bedroom.Take();
  for (const msg::Lease& lease : bedroom.said) kitchen.Hear(lease);
  kitchen.Claim(/*has_scene=*/true, "s2");
  const size_t before = bedroom.said.size();
  bedroom.Claim(/*has_scene=*/false, "s2");
  ASSERT_GT(bedroom.said.size(), before);
  EXPECT_GT(bedroom.said[before].term, kitchen.said.back().term);

  Node a("a"), b("b");
  for (Node* node : {&a, &b}) {
    node->leases.HearPeer(node->now);
    node->Claim();
  }
  EXPECT_EQ(a.said[0].term, b.said[0].term);
  a.Hear(b.said[0]);
  b.Hear(a.said[0]);
  EXPECT_EQ(a.lost, 1);
  EXPECT_EQ(b.lost, 0);
}

TEST(Lease, RunsOutWithTheHolderAndIsOrphaned) {
  Node kitchen("kitchen"), bedroom("bedroom");
  kitchen.Claim(true, "s7");
  bedroom.Hear(kitchen.said.back());
  bedroom.Wait(1900 * kMs);
  EXPECT_EQ(bedroom.orphan_of, "");
  bedroom.Claim();
  EXPECT_EQ(bedroom.state(), LeaseState::kElsewhere) << "nobody claims what another holds";
  bedroom.Wait(100 * kMs);
  EXPECT_EQ(bedroom.orphan_of, "s7");
  bedroom.Claim();
  bedroom.Wait(kSecond);
  EXPECT_TRUE(bedroom.holds());
  EXPECT_GT(bedroom.said.back().term, kitchen.said.back().term);
}

TEST(Lease, AHolderThatStoodStillHoldsNothingAndListensFirst) {
  Node kitchen("kitchen"), bedroom("bedroom");
  kitchen.Claim();
  bedroom.Hear(kitchen.said.back());
  bedroom.Wait(2 * kSecond);
  bedroom.Claim();
  bedroom.Wait(kSecond);
  ASSERT_TRUE(bedroom.holds());

  kitchen.now += 10 * kSecond;
  EXPECT_FALSE(kitchen.holds()) << "before anything told it";
  const size_t said = kitchen.said.size();
  kitchen.leases.Tick(kitchen.now);
  kitchen.Take();
  EXPECT_EQ(kitchen.said.size(), said);
  kitchen.Hear(bedroom.said.back());
  EXPECT_EQ(kitchen.lost, 1);
  EXPECT_EQ(kitchen.state(), LeaseState::kElsewhere);
}

TEST(Lease, AHolderThatStoodStillAloneHoldsItAgain) {
  Node kitchen("kitchen");
  kitchen.Claim();
  kitchen.StandStill(10 * kSecond);
  EXPECT_FALSE(kitchen.holds());
  kitchen.Wait(400 * kMs);
  EXPECT_TRUE(kitchen.holds());
  EXPECT_GT(kitchen.said.back().term, kitchen.said.front().term);
}

TEST(Lease, OneThatStoodStillDoesNotTakeTheLeaseOfOneThatLives) {
  Node kitchen("kitchen"), bedroom("bedroom");
  kitchen.Claim();
  bedroom.Hear(kitchen.said.back());
  bedroom.StandStill(10 * kSecond);
  EXPECT_EQ(bedroom.state(), LeaseState::kElsewhere) << "what was said meanwhile is still unread";
  EXPECT_EQ(bedroom.orphan_of, "");
  bedroom.Wait(2 * kSecond);
  EXPECT_EQ(bedroom.orphan_of, "s1");
}

TEST(Lease, AClaimThatStoodStillWaitsAnew) {
  Node kitchen("kitchen");
  kitchen.leases.HearPeer(kitchen.now);
  kitchen.Claim();
  kitchen.StandStill(kSecond);
  EXPECT_EQ(kitchen.state(), LeaseState::kClaiming);
}

TEST(Lease, AHealedCutLeavesTheHigherTerm) {
  Node kitchen("kitchen"), bedroom("bedroom");
  kitchen.Claim(true, "s1");
  bedroom.Claim(false, "s2");
  bedroom.Hear(kitchen.said.back());
  EXPECT_EQ(bedroom.lost, 1);
  kitchen.Hear(bedroom.said.front());
  EXPECT_EQ(kitchen.lost, 0);
  EXPECT_TRUE(kitchen.holds());
}

TEST(Lease, AnotherRunOfTheHolderReplacesItWhateverItsTerm) {
  Node kitchen("kitchen"), again("kitchen", "2"), bedroom("bedroom");
  for (int i = 0; i < 3; ++i) {
    kitchen.Claim();
    kitchen.leases.GiveBack("ann", kitchen.now);
  }
  kitchen.Claim();
  bedroom.Hear(kitchen.said.back());
  again.Claim(true, "s9");
  ASSERT_LT(again.said.back().term, kitchen.said.back().term);
  bedroom.Hear(again.said.back());
  EXPECT_TRUE(bedroom.leases.IsElsewhere("s9"));
}

TEST(Lease, LateRepetitionsOfALeaseThatIsOverSayNothing) {
  Node kitchen("kitchen"), bedroom("bedroom");
  kitchen.Claim();
  const msg::Lease held = kitchen.said.back();
  kitchen.leases.GiveBack("ann", kitchen.now);
  kitchen.Take();
  bedroom.Hear(held);
  bedroom.Hear(kitchen.said.back());
  bedroom.Hear(held);
  EXPECT_EQ(bedroom.state(), LeaseState::kFree);
}

TEST(Lease, RefusesATermThatNobodyClaimsAndBoundsItsMemory) {
  Node kitchen("kitchen");
  msg::Lease hostile;
  hostile.user = "ann";
  hostile.session_id = "s";
  hostile.holder = "x";
  hostile.run = "1";
  hostile.remaining_ms = 2000;
  hostile.term = INT64_MAX;
  EXPECT_FALSE(kitchen.leases.OnLease(hostile, kitchen.now));
  kitchen.Claim();
  EXPECT_TRUE(kitchen.holds());
  hostile.term = 1;
  for (int i = 0; i < 2000; ++i) {
    hostile.user = "u" + std::to_string(i);
    kitchen.Hear(hostile);
  }
  kitchen.Wait(kSecond);
  EXPECT_TRUE(kitchen.holds()) << "a flood of users drives out nobody who is served";
}

}  // namespace
}  // namespace beckon::intention
