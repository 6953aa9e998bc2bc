// The user is asked what an object is once: not in the next frames, not in the next session, not
// after perception died, nor where intention has forgotten everything.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/system/live_system.h"

namespace beckon::system_test {
namespace {

namespace fs = std::filesystem;

class ToldTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Obstacle().empty()) GTEST_SKIP() << Obstacle();
    // Whatever the model that ships is sure of: here it asks about some of the objects.
    const std::string config = system.run_dir() + "/perception.toml";
    std::ofstream(config) << "[categoriser]\nask_at_or_below = 0.9\n";
    system.config().perception_config = config;
    system.config().think_s = 0.02;
    system.config().seed = 7;  // a table with things that it is not sure of
    system.bus().Subscribe<msg::Query>([this](const msg::Query& query) {
      if (query.kind == msg::QueryKind::kWhatIsIt) asked.insert(query.id);
    });
    system.bus().Subscribe<msg::Scene>([this](const msg::Scene& seen) { scene = seen; });
  }

  long InDoubt() const {
    return std::ranges::count(scene.objects, true, &msg::SceneObject::ask_user);
  }
  bool WaitForSessions(int more) {
    const int ended = system.watch().observer().ended();
    return system.RunUntil([&] { return system.watch().observer().ended() >= ended + more; }, 60);
  }
  int64_t Counter(const std::string& service, const std::string& name) const {
    const auto* status = system.watch().StatusOf(service);
    if (status == nullptr) return -1;
    const auto found = std::ranges::find(status->counters, name, &msg::Counter::name);
    return found == status->counters.end() ? -1 : found->value;
  }

  LiveSystem system;
  std::set<int64_t> asked;  // queries about what an object is
  msg::Scene scene;         // the newest
};

TEST_F(ToldTest, WhatAnObjectIsIsAskedOnce) {
  system.StartServices();
  ASSERT_TRUE(system.RunUntil([&] { return !scene.objects.empty(); })) << system.Logs();
  ASSERT_GT(InDoubt(), 0) << "the test needs objects that perception is not sure of";
  system.StartUser();
  ASSERT_TRUE(WaitForSessions(1)) << system.Logs();
  const size_t once = asked.size();
  ASSERT_GT(once, 0u);

  EXPECT_TRUE(system.RunUntil([&] { return InDoubt() == 0; }, 10)) << "the next frames\n"
                                                                   << system.Logs();
  const auto named = [](const msg::Scene& of) {
    std::multiset<std::string> names;
    for (const auto& object : of.objects) names.insert(object.category);
    return names;
  };
  const auto told = named(scene);
  ASSERT_TRUE(WaitForSessions(2)) << system.Logs();
  EXPECT_EQ(asked.size(), once) << "the next sessions";

  const size_t deaths = system.deaths().size();
  system.supervisor().Signal("perception", SIGKILL);
  const int64_t before = scene.seq;
  ASSERT_TRUE(system.RunUntil([&] {
    return system.deaths().size() > deaths && scene.seq < before && !scene.objects.empty();
  })) << system.Logs();
  EXPECT_EQ(InDoubt(), 0) << "perception begun anew";
  EXPECT_EQ(named(scene), told);
  ASSERT_TRUE(WaitForSessions(2)) << system.Logs();
  EXPECT_EQ(asked.size(), once) << "sessions after that";
  EXPECT_EQ(system.deaths().size(), deaths + 1);

  system.supervisor().Stop("intention", SIGTERM, 5000);
  for (const char* part : {"", "-wal", "-shm"}) fs::remove(system.config().db + part);
  system.Start(tool::IntentionSpec(system.config()), tool::Supervisor::Restart::kAlways);
  ASSERT_TRUE(WaitForSessions(2)) << system.Logs();
  EXPECT_EQ(asked.size(), once) << "intention that remembers nothing";
  EXPECT_TRUE(system.RunUntil([&] { return Counter("perception", "examples") > 0; }, 5))
      << system.Logs();
  EXPECT_EQ(Counter("perception", "examples_failed"), 0);
}

}  // namespace
}  // namespace beckon::system_test
