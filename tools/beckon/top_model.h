// What `beckon top` knows of each process: STATUS messages in, rows of the table out. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "lcmtypes/messages.h"

namespace beckon::tool {

struct RefusedFor {
  std::string reason;
  int64_t total = 0;
  double per_s = 0;
};

/// One process. What it does not tell is empty; rates are between its last two STATUSes.
struct TopRow {
  std::string service;
  std::string host;
  int pid = 0;
  std::string build;
  std::string state;
  int64_t uptime_s = 0;
  std::optional<int64_t> cpu_percent;  // of one core
  std::optional<int64_t> rss_kb;
  std::optional<int64_t> in_per_s, out_per_s;  // messages
  std::optional<double> frames_per_s;          // of the stream it sends: FRAME, SCENE or POSES
  std::optional<double> drops_per_s;           // left out as too late, or lost on the way
  int64_t drops = 0;
  std::optional<int64_t> age_us;  // of the oldest message handled in the last second
  std::optional<int64_t> handler_us;
  double refused_per_s = 0;
  std::vector<RefusedFor> refused;  // most first
  bool silent = false;
  Utime heard_us = 0;  // since its last STATUS
};

enum class TopSort { kService, kHost, kCpu, kMemory, kTraffic, kAge, kDrops, kRefused };

/// The key that sorts so; nothing for other keys.
std::optional<TopSort> SortOfKey(char key);
/// "s service, h host, ..".
inline constexpr char kSortKeysHelp[] =
    "s service, h host, c CPU, m memory, i messages, a age, d drops, r refused";

class TopModel {
 public:
  /// Without a STATUS for so long a process is silent, and forgotten.
  static constexpr Utime kSilent_us = 3 * kSecond;
  static constexpr Utime kForgotten_us = 300 * kSecond;

  /// `now`: of a clock that only counts up.
  void OnStatus(const msg::Status& status, Utime now);
  std::vector<TopRow> Rows(Utime now, TopSort sort) const;

 private:
  using Key = std::tuple<std::string, std::string, int>;  // host, service, pid
  struct Process {
    msg::Status latest;
    std::optional<msg::Status> before;
    Utime heard = 0;
  };

  void Forget(const msg::Status& successor, Utime now);

  std::map<Key, Process> processes_;
};

}  // namespace beckon::tool
