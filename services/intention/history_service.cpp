#include "services/intention/history_service.h"

#include <spdlog/spdlog.h>

#include <array>
#include <cstdio>
#include <random>

namespace beckon::intention {
namespace {

constexpr Utime kTick = kSecond / 50;
/// How often rows are looked for that another process (import, forget) wrote into the file.
constexpr Utime kRefresh = kSecond;
/// Of the status.
constexpr size_t kMostPeers = 16;
constexpr size_t kMostCounterName = 64;

std::string RandomRun() {
  std::random_device random;
  std::array<char, 20> text{};
  std::snprintf(text.data(), text.size(), "%08x%08x", random(), random());
  return text.data();
}

}  // namespace

HistoryService::HistoryService(Store& store, Bus& bus, RunLoop& loop, const Clock& wall, Send send)
    : store_(store),
      loop_(loop),
      wall_(wall),
      send_(std::move(send)),
      run_(RandomRun()),
      sync_(store, {.run = run_, .seed = std::random_device()()}),
      watch_(run_, wall.Now()) {
  bus.Subscribe<msg::History>([this](msg::History message) { Hear(message); });
  timer_ = loop.Every(kTick, [this] { Tick(); });
}

HistoryService::~HistoryService() { loop_.Cancel(timer_); }

void HistoryService::Hear(const msg::History& message) {
  const std::string name = store_.WriteOrigin();
  if (watch_.IsAnother(message, name, Now())) {
    const Status left =
        store_.LeaveOrigin("another machine goes by the name of " + name, wall_.Now());
    if (!left) spdlog::error("{}", left.error().message);
  }
  SendAll(sync_.OnMessage(message, Now()));
  if (const std::string& now_name = store_.WriteOrigin(); now_name != name) {
    spdlog::error("history: {}: {}; this machine writes as {} from now on", name,
                  store_.origin_reason(), now_name);
  }
}

void HistoryService::Tick() {
  const Instant now = Now();
  if (now.steady >= next_refresh_) {
    next_refresh_ = now.steady + kRefresh;
    if (Status fresh = store_.Refresh(); !fresh) spdlog::error("{}", fresh.error().message);
  }
  SendAll(sync_.Tick(now));
  if (sync_.trouble() == logged_) return;
  logged_ = sync_.trouble();
  if (logged_.empty())
    spdlog::info("history: rows of other machines can be kept again");
  else
    spdlog::error("history: rows of other machines cannot be kept: {}", logged_);
}

void HistoryService::SendAll(std::vector<msg::History> messages) {
  for (msg::History& message : messages) send_(std::move(message));
}

std::string HistoryService::Notice() const {
  std::string notice;
  if (const std::string& why = store_.origin_reason(); !why.empty())
    notice = "writes as " + store_.WriteOrigin() + ": " + why;
  if (!sync_.trouble().empty())
    notice += (notice.empty() ? "" : "; ") + ("cannot keep others' rows: " + sync_.trouble());
  return notice;
}

void HistoryService::Fill(msg::Status& status) const {
  const auto add = [&](const std::string& name, int64_t value) {
    status.counters.push_back({("history." + name).substr(0, kMostCounterName), value});
  };
  int64_t rows = 0;
  for (const auto& [origin, head] : store_.Heads()) rows += head.seq;
  const HistorySyncCounters& c = sync_.counters();
  add("rows", rows);
  add("origins", static_cast<int64_t>(store_.Heads().size()));
  add("behind_by", sync_.BehindBy());
  add("rows_sent", c.rows_sent);
  add("rows_received", c.rows_received);
  add("rows_again", c.rows_again);
  add("rows_early", c.rows_early);
  add("far_future", c.far_future);
  add("yielded", c.yielded);
  add("errors", c.errors);
  for (const auto& [reason, count] : c.refused) add("refused." + reason, count);
  size_t peers = 0;
  for (const auto& [machine, heard] : sync_.peers()) {
    if (++peers > kMostPeers) break;
    add("heard_s." + machine, (steady_.Now() - heard) / kSecond);
  }
}

}  // namespace beckon::intention
