// Whole services that share their histories over LCM's memory bus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/codec.h"
#include "services/intention/service.h"
#include "services/intention/store.h"
#include "tests/intention/store_records.h"
#include "tests/intention/temporary_folder.h"

namespace beckon::intention {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

class HistoryServiceTest : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = Bus::Open("memq://");
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    bus = *std::move(opened);
    loop.AddFd(bus->fd(), [this] { bus->HandleReadable(); });
  }
  void Write(const std::string& machine, const std::string& id) {
    auto store = Store::Open(Path(machine), machine);
    ASSERT_TRUE(store.ok()) << store.error().message;
    const auto session = Session(id, "ann", clock.Now());
    ASSERT_TRUE(*(*store)->Commit(session, {}, TaskOf(session)));
  }
  void Start(const std::string& machine, const std::string& db = "", bool share = true) {
    ServiceConfig config;
    config.db = Path(db.empty() ? machine : db);
    config.machine = machine;
    config.share_history = share;
    config.affordances = std::string(BECKON_SOURCE_DIR) + "/services/intention/affordances.toml";
    auto started = Service::Start(config, *bus, loop, clock);
    ASSERT_TRUE(started.ok()) << started.error().message;
    services.push_back(*std::move(started));
  }
  std::vector<std::string> Sessions(const std::string& machine) {
    auto store = Store::Open(Path(machine), machine, Store::Mode::kRead);
    EXPECT_TRUE(store.ok());
    std::vector<std::string> ids;
    const auto sessions = (*store)->SessionsOf("ann");
    for (const auto& session : *sessions) ids.push_back(session.session_id);
    return ids;
  }
  static int64_t Counter(const msg::Status& status, const std::string& name) {
    for (const auto& counter : status.counters) {
      if (counter.name == name) return counter.value;
    }
    return -1;
  }
  /// Until a status fulfils it.
  void RunUntil(std::function<bool(const msg::Status&)> holds) {
    bus->Subscribe<msg::Status>([this, holds](const msg::Status& status) {
      if (!holds(status)) return;
      found = status;
      loop.Stop();
    });
    const auto timeout = loop.After(20 * kSecond, [this] {
      ADD_FAILURE() << "timeout";
      loop.Stop();
    });
    loop.Run();
    loop.Cancel(timeout);
  }
  std::string Path(const std::string& name) const { return folder / (name + ".db"); }

  TemporaryFolder folder;
  SystemClock clock;
  RunLoop loop;
  std::unique_ptr<Bus> bus;
  std::vector<std::unique_ptr<Service>> services;
  msg::Status found;
};

TEST_F(HistoryServiceTest, WhatOneLearntAnotherKnows) {
  Write("kitchen", "s1");
  Write("kitchen", "s2");
  Write("bedroom", "s3");
  Start("kitchen");
  Start("bedroom");
  int both = 0;
  RunUntil([&](const msg::Status& s) {
    both += Counter(s, "history.rows") == 3 ? 1 : 0;
    return both >= 4;
  });
  EXPECT_THAT(Sessions("bedroom"), UnorderedElementsAre("s1", "s2", "s3"));
  EXPECT_THAT(Sessions("kitchen"), UnorderedElementsAre("s1", "s2", "s3"));
  EXPECT_EQ(Counter(found, "history.origins"), 2);
  EXPECT_EQ(Counter(found, "history.behind_by"), 0);
}

TEST_F(HistoryServiceTest, ForgettingFromTheCommandLineTravels) {
  Write("kitchen", "s1");
  Start("kitchen");
  Start("bedroom");
  RunUntil([&](const msg::Status&) { return Sessions("bedroom").size() == 1; });
  ASSERT_TRUE((*Store::Open(Path("kitchen"), "kitchen"))->ForgetUser("ann", clock.Now()).ok());
  RunUntil([&](const msg::Status&) { return Sessions("bedroom").empty(); });
}

TEST_F(HistoryServiceTest, SharesNothingWhereItMustNot) {
  Write("kitchen", "s1");
  bus->Subscribe<msg::History>([](const msg::History&) { ADD_FAILURE() << "shared"; });
  Start("kitchen", "", false);
  int statuses = 0;
  RunUntil([&](const msg::Status& s) {
    EXPECT_EQ(Counter(s, "history.rows"), -1);
    return ++statuses == 3;
  });
}

TEST_F(HistoryServiceTest, TwoOfOneNameSaySoAndPart) {
  Write("kitchen", "s1");
  std::filesystem::copy(Path("kitchen"), Path("copy"));
  Write("kitchen", "s2");
  Start("kitchen");
  Start("kitchen", "copy");
  RunUntil([](const msg::Status& s) { return s.state.find("kitchen~") != std::string::npos; });
  EXPECT_THAT(found.state, HasSubstr("writes as kitchen~"));
  RunUntil([&](const msg::Status&) { return Sessions("copy").size() == 2; });
}

}  // namespace
}  // namespace beckon::intention
