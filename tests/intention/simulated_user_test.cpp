// Simulated users have the habits they are named for.
#include "services/intention/core/simulated_user.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

using Want = std::tuple<int, int, int>;  // category, rank, action

Want WantOf(const ScenarioSession& session) {
  return {session.want_category, session.want_rank, session.want_action};
}
bool SameTable(const ScenarioSession& a, const ScenarioSession& b) {
  return std::equal(a.scene.begin(), a.scene.end(), b.scene.begin(), b.scene.end(),
                    [](const Thing& x, const Thing& y) {
                      return x.category == y.category && x.distance_m == y.distance_m &&
                             x.lateral_m == y.lateral_m;
                    });
}

class SimulatedUserTest : public testing::Test {
 protected:
  std::vector<ScenarioSession> Live(const std::string& kind, int sessions = 400, int users = 1,
                                    double repeat = 0, uint64_t seed = 5) const {
    const auto lived = Simulate(affordances, {kind, users, sessions, repeat, seed});
    EXPECT_TRUE(lived.ok());
    return *lived;
  }
  /// Share of successive sessions of one user for which `same` holds.
  template <typename Same>
  static double ShareOfSuccessors(const std::vector<ScenarioSession>& lived, Same same) {
    int held = 0;
    for (size_t i = 1; i < lived.size(); ++i) held += same(lived[i - 1], lived[i]);
    return static_cast<double>(held) / static_cast<double>(lived.size() - 1);
  }
  static std::map<Want, double> Frequencies(const std::vector<ScenarioSession>& lived, size_t from,
                                            size_t to) {
    std::map<Want, double> frequencies;
    for (size_t i = from; i < to; ++i) {
      frequencies[WantOf(lived[i])] += 1 / static_cast<double>(to - from);
    }
    return frequencies;
  }
  /// Probability that both sessions of a pair of stretches would agree.
  static double Agreement(const std::map<Want, double>& a, const std::map<Want, double>& b) {
    double sum = 0;
    for (const auto& [want, share] : a) sum += b.contains(want) ? share * b.at(want) : 0;
    return sum;
  }
  const Affordances affordances = TestAffordances();
};

TEST_F(SimulatedUserTest, EveryKindWantsWhatIsOnItsTable) {
  for (const SimulatedKind& kind : SimulatedKinds()) {
    SCOPED_TRACE(kind.name);
    for (const ScenarioSession& session : Live(kind.name, 100, 3, 0.3)) {
      const Situation table = MakeSituation(affordances, session.scene);
      ASSERT_GE(table.Find(session.want_category, session.want_rank, session.want_action), 0);
      EXPECT_GE(table.pair_count(), 24);
      EXPECT_LE(table.pair_count(), 63);
      for (const Thing& thing : session.scene) {
        EXPECT_GE(thing.distance_m, 0.2);
        EXPECT_LE(thing.distance_m, 1.0);
        EXPECT_LE(std::abs(thing.lateral_m), 0.5);
      }
    }
  }
}

TEST_F(SimulatedUserTest, TheSameSeedMakesTheSameSessions) {
  for (const SimulatedKind& kind : SimulatedKinds()) {
    SCOPED_TRACE(kind.name);
    const auto first = Live(kind.name, 50, 2), second = Live(kind.name, 50, 2);
    ASSERT_EQ(first.size(), 100u);
    ASSERT_EQ(second.size(), 100u);
    for (size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].user, second[i].user);
      EXPECT_EQ(WantOf(first[i]), WantOf(second[i]));
      EXPECT_EQ(first[i].utime, second[i].utime);
      EXPECT_TRUE(SameTable(first[i], second[i]));
    }
    EXPECT_FALSE(SameTable(first[0], Live(kind.name, 1, 1, 0, 6)[0]));
  }
}

TEST_F(SimulatedUserTest, TablesOfAnyVocabularyCanBeDrawn) {
  std::vector<Action> actions;
  std::vector<Affordances::Entry> entries;
  for (int i = 0; i < kMaxCategories; ++i) {
    actions.push_back({"A" + std::to_string(i), "do"});
    entries.push_back({"C" + std::to_string(i), {"A0", "A" + std::to_string(i)}});
  }
  entries[0].actions = {"A0"};
  const auto large = Affordances::Make(actions, entries);
  ASSERT_TRUE(large.ok()) << large.error().message;
  const auto tiny = Affordances::Make({{"Open", "open"}}, {{"Box", {"Open"}}});
  ASSERT_TRUE(tiny.ok());
  for (const SimulatedKind& kind : SimulatedKinds()) {
    EXPECT_TRUE(Simulate(*large, {kind.name, 1, 20, 0, 1}).ok());
    EXPECT_TRUE(Simulate(*tiny, {kind.name, 1, 20, 0, 1}).ok());
  }
}

TEST_F(SimulatedUserTest, SparseUsersChangeTheirWantsHalfWay) {
  double within = 0, across = 0;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const auto lived = Live("sparse", 400, 1, 0, seed);
    const auto early = Frequencies(lived, 0, 100), before = Frequencies(lived, 100, 200);
    const auto after = Frequencies(lived, 200, 300);
    within += Agreement(early, before) / 10;
    across += Agreement(before, after) / 10;
    EXPECT_GE(early.size(), 5u);
    EXPECT_LE(early.size(), 15u);
  }
  EXPECT_GT(within, 0.15);
  EXPECT_LT(across, within / 3);
}

TEST_F(SimulatedUserTest, DriftingUsersForgetLittleByLittle) {
  double near = 0, far = 0;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const auto lived = Live("drift", 240, 1, 0, seed);
    const auto now = Frequencies(lived, 0, 40);
    near += Agreement(now, Frequencies(lived, 40, 80));
    far += Agreement(now, Frequencies(lived, 160, 200));
  }
  EXPECT_GT(near, 2 * far);
}

TEST_F(SimulatedUserTest, RepeatMakesUsersRepeat) {
  const auto same = [](const auto& a, const auto& b) { return WantOf(a) == WantOf(b); };
  const double never = ShareOfSuccessors(Live("sparse", 400, 1, 0), same);
  const double often = ShareOfSuccessors(Live("sparse", 400, 1, 0.6), same);
  EXPECT_LT(never, 0.4);
  EXPECT_GT(often, never + 0.3);
}

TEST_F(SimulatedUserTest, RoutineUsersLiveByTheClock) {
  const auto lived = Live("routine", 300);
  std::map<int, std::map<Want, int>> by_hour;
  for (size_t i = 0; i < lived.size(); ++i) {
    if (i > 0) {
      EXPECT_GT(lived[i].utime, lived[i - 1].utime);
    }
    const auto hour = static_cast<int>(lived[i].utime / (3'600 * kSecond) % 24);
    EXPECT_GE(hour, 7);
    EXPECT_LE(hour, 22);
    ++by_hour[hour][WantOf(lived[i])];
  }
  int usual = 0;  // the commonest want of each hour
  for (const auto& [hour, wants] : by_hour) {
    usual += std::max_element(wants.begin(), wants.end(), [](const auto& a, const auto& b) {
               return a.second < b.second;
             })->second;
  }
  EXPECT_GT(usual, 200);
  EXPECT_LT(usual, 300);
  EXPECT_EQ(Live("sparse", 1)[0].utime, 0);
}

TEST_F(SimulatedUserTest, TimetablesHaveTimesButNoOrder) {
  const auto lived = Live("timetable", 400);
  std::map<Utime, std::map<Want, int>> by_half_hour;
  std::map<Want, std::map<Want, int>> by_last;
  std::map<Utime, int> by_day;
  for (size_t i = 0; i < lived.size(); ++i) {
    const Utime half_hours = lived[i].utime / (1'800 * kSecond);
    ++by_half_hour[half_hours % 48][WantOf(lived[i])];
    ++by_day[half_hours / 48];
    if (i == 0) continue;
    EXPECT_GE(lived[i].utime, lived[i - 1].utime);
    ++by_last[WantOf(lived[i - 1])][WantOf(lived[i])];
  }
  const auto usual = [](const auto& groups) {  // how often the commonest want of a group
    int sum = 0;
    for (const auto& [group, wants] : groups) {
      int most = 0;
      for (const auto& [want, times] : wants) most = std::max(most, times);
      sum += most;
    }
    return sum;
  };
  EXPECT_GT(usual(by_half_hour), 240);
  EXPECT_GT(usual(by_half_hour), usual(by_last) + 30);
  std::set<int> sessions_a_day;
  for (const auto& [day, sessions] : by_day) sessions_a_day.insert(sessions);
  EXPECT_GE(sessions_a_day.size(), 4u);
}

TEST_F(SimulatedUserTest, DevotedUsersKeepToOneThing) {
  const auto same_category = [](const auto& a, const auto& b) {
    return a.want_category == b.want_category;
  };
  const auto same_action = [](const auto& a, const auto& b) {
    return a.want_action == b.want_action;
  };
  EXPECT_GT(ShareOfSuccessors(Live("object-first"), same_category), 0.55);
  EXPECT_GT(ShareOfSuccessors(Live("action-first"), same_action), 0.55);
}

TEST_F(SimulatedUserTest, SequencesGoOnWithTheSameObjectOnTheSameTable) {
  const auto lived = Live("sequence");
  std::set<std::pair<int, int>> steps;
  int continued = 0;
  for (size_t i = 1; i < lived.size(); ++i) {
    if (!SameTable(lived[i - 1], lived[i])) continue;
    ++continued;
    EXPECT_EQ(lived[i - 1].want_category, lived[i].want_category);
    EXPECT_EQ(lived[i - 1].want_rank, lived[i].want_rank);
    steps.insert({lived[i].want_category * 100 + lived[i - 1].want_action, lived[i].want_action});
  }
  EXPECT_GT(continued, 100);
  EXPECT_LE(steps.size(), 8u);  // four scripts of at most three steps
}

TEST_F(SimulatedUserTest, FavouriteInstanceIsTheSecondOfOneCategory) {
  std::map<int, int> seconds;
  for (const ScenarioSession& session : Live("favourite-instance")) {
    if (session.want_rank == 2) ++seconds[session.want_category];
  }
  ASSERT_EQ(seconds.size(), 1u);
  EXPECT_GT(seconds.begin()->second, 120);
}

TEST_F(SimulatedUserTest, HouseholdsAreInterleaved) {
  const auto lived = Live("household", 100, 3);
  const auto same = [](const auto& a, const auto& b) { return a.user == b.user; };
  std::map<std::string, int> sessions;
  for (const ScenarioSession& session : lived) ++sessions[session.user];
  EXPECT_EQ(sessions, (std::map<std::string, int>{
                          {"household-5-1", 100}, {"household-5-2", 100}, {"household-5-3", 100}}));
  EXPECT_LT(ShareOfSuccessors(lived, same), 0.5);
  EXPECT_GT(ShareOfSuccessors(Live("sparse", 100, 3), same), 0.98);
}

TEST_F(SimulatedUserTest, NewEveryTimeWantsAnythingAnyInstance) {
  std::map<Want, int> wants;
  int further = 0;
  for (const ScenarioSession& session : Live("new-every-time", 2'000)) {
    ++wants[WantOf(session)];
    further += session.want_rank > 1;
  }
  EXPECT_GT(wants.size(), 70u);
  EXPECT_GT(further, 400);
  for (const auto& [want, times] : wants) EXPECT_LT(times, 100);
}

TEST_F(SimulatedUserTest, UnknownKindsAreRefusedByName) {
  const auto lived = Simulate(affordances, {"wild", 1, 1, 0, 1});
  ASSERT_FALSE(lived.ok());
  EXPECT_NE(lived.error().message.find("wild"), std::string::npos);
  EXPECT_NE(lived.error().message.find("sparse, routine"), std::string::npos);
}

}  // namespace
}  // namespace beckon::intention
