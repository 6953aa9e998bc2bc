// The learner and its parts: distributions that stay distributions, and what they learn.
#include "services/intention/core/learner.h"

#include <cmath>
#include <numeric>

#include "services/intention/core/instance_habit.h"
#include "tests/intention/fixtures.h"

namespace beckon::intention {
namespace {

double Sum(const std::vector<double>& p) { return std::accumulate(p.begin(), p.end(), 0.0); }

/// A learner that knows every task; all categories are there unless told otherwise.
class LearnerTest : public testing::Test {
 protected:
  static std::vector<Thing> OneOfEach(const Affordances& affordances) {
    std::vector<Thing> things;
    for (size_t c = 0; c < affordances.categories().size(); ++c) {
      things.push_back({static_cast<int>(c), 0.5, 0});
    }
    return things;
  }
  int Task(const char* category, const char* action) const {
    return tasks.Find(a.FindCategory(category), a.FindAction(action));
  }
  double Of(const Learner& who, int task, Utime utime = 0) const {
    return who.Predict(everything, utime)[static_cast<size_t>(task)];
  }
  static Utime At(int day, double hour) {
    return (20'000 + day) * kDay + static_cast<Utime>(hour * 3'600) * kSecond;
  }
  std::vector<double> Without(const char* category) const {
    std::vector<double> there = everything;
    there[static_cast<size_t>(a.FindCategory(category))] = 0;
    return there;
  }
  /// Any of what is there, to be lived through.
  void LiveAtRandom(int sessions, uint64_t seed, Learner& who) const {
    std::mt19937_64 random(seed);
    for (int i = 0; i < sessions; ++i) {
      std::vector<double> there(everything.size());
      for (double& x : there) x = random() % 3 == 0 ? 0 : 1;
      const int task = static_cast<int>(random() % static_cast<uint64_t>(tasks.count()));
      there[static_cast<size_t>(tasks.category(task))] = 1;
      who.Learn(task, there);
    }
  }

  static constexpr Utime kDay = Utime{86'400} * kSecond;
  const Affordances a = TestAffordances();
  const Situation s = MakeSituation(a, OneOfEach(a));
  const Tasks tasks{s, {}};
  const std::vector<double> everything = tasks.Look(s).there;
  Learner learner{tasks};
};

TEST_F(LearnerTest, PredictsADistributionOverWhatIsThere) {
  for (int round = 0; round < 40; ++round) {
    const auto there = Without(round % 2 == 0 ? "Bottle" : "Tube");
    const auto p = learner.Predict(there);
    EXPECT_NEAR(Sum(p), 1, 1e-9) << round;
    for (int t = 0; t < tasks.count(); ++t) {
      const bool is_there = there[static_cast<size_t>(tasks.category(t))] > 0;
      EXPECT_EQ(p[static_cast<size_t>(t)] > 0, is_there);
    }
    LiveAtRandom(7, static_cast<uint64_t>(round), learner);
  }
}

TEST_F(LearnerTest, HabitSaysOfOneTaskWhatItSaysOfAll) {
  Habit habit(tasks);
  for (int i = 0; i < 200; ++i) {
    const auto there = Without(i % 3 == 0 ? "Mug" : "Can");
    const int task = i < 100 ? Task("Carton", i % 4 == 0 ? "Open" : "Pour") : i % tasks.count();
    if (there[static_cast<size_t>(tasks.category(task))] == 0) continue;
    const auto p = habit.Predict(there);
    EXPECT_NEAR(Sum(p), 1, 1e-9);
    EXPECT_NEAR(habit.Probability(task, there), p[static_cast<size_t>(task)], 1e-12);
    habit.Learn(task, there, i % 5 == 0 ? 0.3 : 1, i % 5 == 0 ? 0.4 : 0);
  }
}

TEST_F(LearnerTest, KnowsNothingAtFirst) {
  for (const double p : learner.Predict(everything)) EXPECT_NEAR(p, 1.0 / tasks.count(), 1e-12);
}

TEST_F(LearnerTest, TrustsWhatWasWantedOnce) {
  learner.Learn(Task("Tin", "Open"), everything);
  EXPECT_GT(Of(learner, Task("Tin", "Open")), 0.5);
}

TEST_F(LearnerTest, PaysLittleForNotKnowingAFairCoin) {
  std::mt19937_64 random(3);
  const std::array<int, 2> two = {Task("Cup", "Drink"), Task("Box", "Push")};
  double bits = 0;
  for (int i = 0; i < 400; ++i) {
    const int task = two[random() % 2];
    if (i >= 100) bits -= std::log2(Of(learner, task));
    learner.Learn(task, everything);
  }
  EXPECT_LT(bits / 300, 1.15);  // 1 is what a fair coin costs
}

TEST_F(LearnerTest, GetsOverAChangeOfHabits) {
  for (int i = 0; i < 150; ++i)
    learner.Learn(Task("Cup", i % 3 == 0 ? "Grasp" : "Drink"), everything);
  // Three tasks in an order that is not a cycle.
  const char* const actions[] = {"Open", "Pour",  "Grasp", "Pour", "Open", "Grasp", "Open", "Open",
                                 "Pour", "Grasp", "Grasp", "Pour", "Open", "Grasp", "Pour"};
  for (const char* action : actions) learner.Learn(Task("Tin", action), everything);
  EXPECT_LT(Of(learner, Task("Cup", "Drink")) + Of(learner, Task("Cup", "Grasp")), 0.1);
}

TEST_F(LearnerTest, LearnsWhatFollows) {
  const std::array<int, 3> routine = {Task("Mug", "Drink"), Task("Bottle", "Open"),
                                      Task("Tub", "Push")};
  for (size_t i = 0; i < 30; ++i) learner.Learn(routine[i % 3], everything);
  EXPECT_GT(Of(learner, routine[0]), 0.9);
  // Something else in between: nothing is known to follow it.
  learner.Learn(Task("Can", "Pour"), everything);
  EXPECT_LT(Of(learner, routine[0]), 0.6);
}

TEST_F(LearnerTest, LearnsWhatIsWantedAtWhichTimeOfDay) {
  const std::array<int, 3> tasks_of_day = {Task("Carton", "Pour"), Task("Mug", "Drink"),
                                           Task("Tub", "Push")};
  const std::array<double, 3> hours = {7.5, 16, 23.8};
  Learner timeless(tasks);
  std::mt19937_64 random(4);
  for (int day = 0; day < 40; ++day) {
    for (size_t i = 0; i < 3; ++i) {
      if (random() % 3 == 0) continue;  // not every day: what follows what changes
      const double late = static_cast<double>(random() % 100) / 200;
      learner.Learn(tasks_of_day[i], everything, At(day, hours[i] + late));
      timeless.Learn(tasks_of_day[i], everything);
    }
  }
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_GT(Of(learner, tasks_of_day[i], At(50, hours[i] + 0.3)), 0.85) << i;
    EXPECT_LT(Of(learner, tasks_of_day[i], At(50, hours[(i + 1) % 3])), 0.1) << i;
    EXPECT_LT(Of(timeless, tasks_of_day[i]), 0.75) << i;
  }
  EXPECT_NEAR(Sum(learner.Predict(Without("Mug"), At(50, 16))), 1, 1e-9);
}

TEST_F(LearnerTest, PaysLittleForTimesThatMeanNothing) {
  const std::array<int, 3> wants = {Task("Carton", "Pour"), Task("Mug", "Drink"),
                                    Task("Tub", "Push")};
  Learner timeless(tasks);
  std::mt19937_64 random(6);
  double bits = 0, bits_timeless = 0;
  for (int i = 0; i < 300; ++i) {
    const int task = wants[random() % 3];
    const Utime now = At(i, static_cast<double>(random() % 24));
    bits -= std::log2(Of(learner, task, now));
    bits_timeless -= std::log2(Of(timeless, task));
    learner.Learn(task, everything, now);
    timeless.Learn(task, everything);
  }
  EXPECT_LT(bits, 1.01 * bits_timeless);
}

TEST_F(LearnerTest, DoesWithoutATimeWhatItDidWithout) {
  Learner timeless(tasks);
  for (int i = 0; i < 60; ++i) {
    const int task = (i * i) % tasks.count();
    learner.Learn(task, everything, At(i, i % 24));
    timeless.Learn(task, everything);
    EXPECT_EQ(timeless.Predict(everything), timeless.Predict(everything, At(i, i % 24)));
    EXPECT_NEAR(Sum(learner.Predict(everything)), 1, 1e-9);  // a time that is not known
    EXPECT_NEAR(Sum(learner.Predict(everything, -5 * kDay - 1)), 1, 1e-9);
  }
}

TEST_F(LearnerTest, DoesNotHoldItsAbsenceAgainstATask) {
  Habit recorded(tasks), not_recorded(tasks);
  const int mug = Task("Mug", "Drink"), box = Task("Box", "Push");
  std::mt19937_64 random(8);
  for (int i = 0; i < 60; ++i) {
    const bool mug_is_there = random() % 3 == 0;
    const int task = mug_is_there ? mug : box;  // the mug wherever it can be had
    const auto there = mug_is_there ? everything : Without("Mug");
    recorded.Probability(task, there);
    recorded.Learn(task, there, 1, 0);
    not_recorded.Probability(task, everything);
    not_recorded.Learn(task, everything, 1, 0);
  }
  EXPECT_GT(recorded.Probability(mug, everything), 0.6);
  EXPECT_LT(not_recorded.Probability(mug, everything), 0.45);
}

TEST_F(LearnerTest, ExpectsNewWantsToResembleOldOnes) {
  for (const char* action : {"Grasp", "Open", "Grasp", "Move", "Grasp", "Move"})
    learner.Learn(Task("Carton", action), everything);
  EXPECT_GT(Of(learner, Task("Carton", "Pour")), 1.5 * Of(learner, Task("Bottle", "Pour")));
}

TEST(InstanceHabit, TakesTheNearestAtFirst) {
  const InstanceHabit habit(1);
  const auto p = habit.Predict(0, 4);
  EXPECT_NEAR(Sum(p), 1, 1e-12);
  EXPECT_GT(p[0], 0.6);
  for (size_t i = 1; i < p.size(); ++i) EXPECT_LT(p[i], 0.2);
  EXPECT_TRUE(habit.Predict(0, 0).empty());
  EXPECT_NEAR(habit.Predict(0, 1)[0], 1, 1e-12);
}

TEST(InstanceHabit, PutsNoneOutOfReach) {
  const InstanceHabit habit(1);
  for (const double p : habit.Predict(0, 60)) EXPECT_GT(p, 1e-4);
}

TEST(InstanceHabit, KeepsFavouritesApart) {
  InstanceHabit habit(2);
  for (int i = 0; i < 12; ++i) {
    habit.Learn(0, 1, 3);
    habit.Learn(1, 2, 3);
  }
  EXPECT_GT(habit.Predict(0, 3)[0], 0.75);
  EXPECT_GT(habit.Predict(1, 3)[1], 0.75);
}

TEST(InstanceHabit, SeesThatTheFurthestIsMeantHoweverManyThereAre) {
  InstanceHabit habit(2);
  for (int i = 0; i < 12; ++i) habit.Learn(0, 2 + i % 3, 2 + i % 3);
  EXPECT_GT(habit.Predict(1, 6)[5], 0.6);
}

TEST(InstanceHabit, LearnsNothingFromAChoiceOfOne) {
  InstanceHabit habit(1);
  const auto before = habit.Predict(0, 3);
  for (int i = 0; i < 20; ++i) habit.Learn(0, 1, 1);
  EXPECT_EQ(habit.Predict(0, 3), before);
}

TEST(InstanceHabit, PassesOverRanksThatCannotBe) {
  InstanceHabit habit(1);
  const auto before = habit.Predict(0, 3);
  for (const int rank : {0, -5, 1'000'000'000}) habit.Learn(0, rank, -1);
  EXPECT_EQ(habit.Predict(0, 3), before);
  habit.Learn(0, 3, 2);  // more than were recorded: counted, the record is not believed
  EXPECT_GT(habit.Predict(0, 3)[2], before[2]);
}

}  // namespace
}  // namespace beckon::intention
