// Whole conversations of a user with two to four services that are killed, stand still, and lose
// sight of each other.
#include <set>

#include "tests/intention/household.h"

namespace beckon::intention {
namespace {

constexpr int kSeeds = 200;
constexpr Utime kLasts = 60 * kSecond;

class Life {
 public:
  explicit Life(uint64_t seed)
      : machines_(2 + seed % 3), home_(machines_, 2, seed, seed % 2 == 0 ? 0.0 : 0.1) {}

  void Run() {
    for (const Utime end = home_.net.now() + kLasts; home_.net.now() < end;) {
      home_.Run(static_cast<Utime>(home_.net.Below(4 * kSecond)));
      Check();
      if (testing::Test::HasFailure()) return;
      Disturb();
    }
    Calm();
    Check();
  }
  int64_t tasks() const { return static_cast<int64_t>(home_.done.size()); }
  int64_t taken_over() const { return taken_over_; }

 private:
  void Disturb() {
    const size_t i = home_.net.Below(machines_);
    switch (home_.net.Below(5)) {
      case 0:
        if (home_.net.Alive(i)) Kill(i);
        return;
      case 1:
        if (!home_.net.Alive(i)) home_.Revive(i);
        return;
      case 2:
        return home_.net.Pause(i, static_cast<Utime>(home_.net.Below(8 * kSecond)));
      case 3:
        for (size_t k = 0; k < machines_ + 2; ++k)
          home_.net.Move(k, static_cast<int>(home_.net.Below(2)));
        return;
      default:
        for (size_t k = 0; k < machines_ + 2; ++k) home_.net.Move(k, 0);
    }
  }

  void Kill(size_t i) {
    taken_over_ += home_.machine(i).service->counters().taken_over;
    home_.Kill(i);
  }

  void Calm() {
    for (size_t k = 0; k < machines_ + 2; ++k) {
      home_.net.Move(k, 0);
      home_.net.Pause(k, 0);
    }
    for (size_t i = 0; i < machines_; ++i) {
      if (!home_.net.Alive(i)) home_.Revive(i);
    }
    const int before = home_.confirmed;
    EXPECT_TRUE(home_.RunUntil([&] { return home_.confirmed > before; }, 40 * kSecond))
        << "undisturbed, and nothing is confirmed";
    for (size_t i = 0; i < machines_; ++i)
      taken_over_ += home_.machine(i).service->counters().taken_over;
  }

  void Check() {
    for (; checked_ < home_.said.size(); ++checked_) {
      const auto& said = home_.said[checked_];
      if (const auto* query = std::get_if<msg::Query>(&said.what)) {
        EXPECT_TRUE(said.held) << "machine " << said.machine << " asks '" << query->text
                               << "' and does not lead";
      }
      if (const auto* task = std::get_if<msg::Task>(&said.what)) CheckTask(said, *task);
    }
  }

  void CheckTask(const Household::Said& said, const msg::Task& task) {
    EXPECT_EQ(task.action, Household::kAction);
    EXPECT_EQ(task.object.category, Household::kCategory);
    EXPECT_EQ(task.object.instance, Household::kInstance);
    const auto& memory = home_.machine(said.machine).memory;
    const auto on_disk =
        std::ranges::count(memory.sessions, task.task_id, &SessionRecord::session_id);
    EXPECT_EQ(on_disk, 1) << "published where it is not on disk";
    // What is repeated was promised before; the first time it takes the lease, or an earlier run.
    const std::pair<size_t, std::string> promise{said.machine, task.task_id};
    if (told_.insert(promise).second && !home_.recovered.contains(promise)) {
      EXPECT_TRUE(said.held) << "machine " << said.machine << " acts and does not lead";
    }
  }

  const size_t machines_;
  Household home_;
  size_t checked_ = 0;
  std::set<std::pair<size_t, std::string>> told_;  // by machine and id
  int64_t taken_over_ = 0;
};

TEST(LedConversationFaults, EveryTaskIsRightAndTheLeaderAloneAsks) {
  int64_t tasks = 0, taken_over = 0;
  for (uint64_t seed = 1; seed <= kSeeds && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Life life(seed);
    life.Run();
    tasks += life.tasks();
    taken_over += life.taken_over();
  }
  EXPECT_GT(tasks, 2 * kSeeds) << "the lives say little";
  EXPECT_GT(taken_over, kSeeds / 10);
}

}  // namespace
}  // namespace beckon::intention
