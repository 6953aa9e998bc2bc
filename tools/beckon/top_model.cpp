#include "tools/beckon/top_model.h"

#include <algorithm>
#include <array>
#include <functional>
#include <string_view>
#include <tuple>

namespace beckon::tool {
namespace {

/// A hostile bus must not fill the memory.
constexpr size_t kMostProcesses = 256;

using Counters = std::map<std::string, int64_t>;

Counters CountersOf(const msg::Status& status) {
  Counters counters;
  for (const auto& counter : status.counters)
    counters.insert_or_assign(counter.name, counter.value);
  return counters;
}

std::optional<int64_t> Value(const Counters& counters, const std::string& name) {
  const auto found = counters.find(name);
  return found == counters.end() ? std::nullopt : std::optional(found->second);
}

/// Two moments of one process.
class Between {
 public:
  Between(const msg::Status& latest, const std::optional<msg::Status>& before)
      : now_(CountersOf(latest)) {
    if (!before || latest.utime <= before->utime) return;
    before_ = CountersOf(*before);
    seconds_ = static_cast<double>(latest.utime - before->utime) / kSecond;
  }

  const Counters& now() const { return now_; }
  /// Nothing where the counter is new, unknown, or was set back.
  std::optional<double> PerSecond(const std::string& name) const {
    const auto a = Value(before_, name), b = Value(now_, name);
    if (!a || !b || *b < *a) return std::nullopt;
    return (static_cast<double>(*b) - static_cast<double>(*a)) / seconds_;
  }

 private:
  Counters now_;
  Counters before_;
  double seconds_ = 1;
};

std::optional<double> FrameRate(const Between& between) {
  for (const char* stream : {"sent.BECKON_FRAME", "sent.BECKON_SCENE", "sent.BECKON_POSES"}) {
    if (const auto rate = between.PerSecond(stream)) return rate;
  }
  return std::nullopt;
}

void FillDrops(const Between& between, TopRow& row) {
  for (const char* name : {"dropped", "lost"}) {
    row.drops += Value(between.now(), name).value_or(0);
    if (const auto rate = between.PerSecond(name))
      row.drops_per_s = row.drops_per_s.value_or(0) + *rate;
  }
}

void FillAge(const Between& between, TopRow& row) {
  const auto wait_us = Value(between.now(), "wait_us");
  if (wait_us.value_or(0) > 0) row.age_us = wait_us;  // else it heard nothing
  for (const auto& [name, value] : between.now()) {
    if (name.starts_with("age_us.")) row.age_us = std::max(row.age_us.value_or(0), value);
  }
}

/// Over all channels.
void FillRefused(const Between& between, TopRow& row) {
  std::map<std::string, RefusedFor> reasons;
  constexpr std::string_view kPrefix = "refused.";
  for (const auto& [name, value] : between.now()) {
    const size_t dot = name.rfind('.');
    if (!name.starts_with(kPrefix) || dot < kPrefix.size()) continue;
    RefusedFor& refused = reasons[name.substr(dot + 1)];
    refused.reason = name.substr(dot + 1);
    refused.total += value;
    refused.per_s += between.PerSecond(name).value_or(0);
  }
  for (auto& [reason, refused] : reasons) {
    row.refused_per_s += refused.per_s;
    row.refused.push_back(std::move(refused));
  }
  std::ranges::stable_sort(row.refused, std::greater{}, &RefusedFor::total);
}

TopRow MakeRow(const msg::Status& latest, const std::optional<msg::Status>& before) {
  const Between between(latest, before);
  TopRow row;
  row.service = latest.service;
  row.host = latest.host;
  row.pid = latest.pid;
  row.build = latest.build;
  row.state = latest.state;
  const Utime up_us = std::max<Utime>(latest.utime - std::max<Utime>(latest.started_utime, 0), 0);
  row.uptime_s = Value(between.now(), "uptime_s").value_or(up_us / kSecond);
  row.cpu_percent = Value(between.now(), "cpu_percent");
  row.rss_kb = Value(between.now(), "rss_kb");
  row.in_per_s = Value(between.now(), "received_per_s");
  row.out_per_s = Value(between.now(), "sent_per_s");
  row.frames_per_s = FrameRate(between);
  row.handler_us = Value(between.now(), "handler_us");
  FillDrops(between, row);
  FillAge(between, row);
  FillRefused(between, row);
  return row;
}

/// The greater, the earlier it stands.
double Weight(const TopRow& row, TopSort sort) {
  switch (sort) {
    case TopSort::kCpu:
      return static_cast<double>(row.cpu_percent.value_or(-1));
    case TopSort::kMemory:
      return static_cast<double>(row.rss_kb.value_or(-1));
    case TopSort::kTraffic:
      return static_cast<double>(row.in_per_s.value_or(0)) +
             static_cast<double>(row.out_per_s.value_or(0));
    case TopSort::kAge:
      return static_cast<double>(row.age_us.value_or(-1));
    case TopSort::kDrops:
      return row.drops_per_s.value_or(-1);
    case TopSort::kRefused:
      return row.refused_per_s;
    case TopSort::kService:
    case TopSort::kHost:
      break;
  }
  return 0;
}

/// The way of the data; others behind, by name.
int Place(const std::string& service) {
  constexpr std::array kOrder{"capture", "perception", "pose", "intention", "ui_bridge"};
  return static_cast<int>(std::ranges::find(kOrder, service) - kOrder.begin());
}

bool Before(const TopRow& a, const TopRow& b, TopSort sort) {
  const double weight_a = Weight(a, sort), weight_b = Weight(b, sort);
  if (weight_a != weight_b) return weight_a > weight_b;
  if (sort == TopSort::kHost && a.host != b.host) return a.host < b.host;
  const int place_a = Place(a.service), place_b = Place(b.service);
  return std::tie(place_a, a.service, a.host, a.pid) < std::tie(place_b, b.service, b.host, b.pid);
}

}  // namespace

std::optional<TopSort> SortOfKey(char key) {
  switch (key) {
    case 's':
      return TopSort::kService;
    case 'h':
      return TopSort::kHost;
    case 'c':
      return TopSort::kCpu;
    case 'm':
      return TopSort::kMemory;
    case 'i':
      return TopSort::kTraffic;
    case 'a':
      return TopSort::kAge;
    case 'd':
      return TopSort::kDrops;
    case 'r':
      return TopSort::kRefused;
    default:
      return std::nullopt;
  }
}

void TopModel::OnStatus(const msg::Status& status, Utime now) {
  const Key key{status.host, status.service, status.pid};
  if (!processes_.contains(key)) {
    Forget(status, now);
    if (processes_.size() >= kMostProcesses) return;
  }
  const auto [entry, is_new] = processes_.try_emplace(key);
  Process& process = entry->second;
  if (!is_new) {
    if (status.utime <= process.latest.utime &&
        status.started_utime == process.latest.started_utime)
      return;  // a late copy
    process.before = std::move(process.latest);
    if (process.before->started_utime != status.started_utime) process.before.reset();
  }
  process.latest = status;
  process.heard = now;
}

/// Whom a process that is new replaces, and who was silent for too long.
void TopModel::Forget(const msg::Status& successor, Utime now) {
  std::erase_if(processes_, [&](const auto& entry) {
    const auto& [host, service, pid] = entry.first;
    const Utime since = now - entry.second.heard;
    const bool replaced = host == successor.host && service == successor.service &&
                          since > kSilent_us / 2 &&
                          entry.second.latest.started_utime < successor.started_utime;
    return replaced || since > kForgotten_us;
  });
}

std::vector<TopRow> TopModel::Rows(Utime now, TopSort sort) const {
  std::vector<TopRow> rows;
  for (const auto& [key, process] : processes_) {
    TopRow row = MakeRow(process.latest, process.before);
    row.heard_us = now - process.heard;
    row.silent = row.heard_us > kSilent_us;
    if (row.heard_us <= kForgotten_us) rows.push_back(std::move(row));
  }
  std::ranges::sort(rows, [sort](const auto& a, const auto& b) { return Before(a, b, sort); });
  return rows;
}

}  // namespace beckon::tool
