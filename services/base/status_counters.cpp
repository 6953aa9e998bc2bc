#include "services/base/status_counters.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace beckon {
namespace {

int64_t Milliseconds(const timeval& time) { return time.tv_sec * 1000 + time.tv_usec / 1000; }

int64_t ResidentKilobytes() {
  std::ifstream statm("/proc/self/statm");
  int64_t total_pages = 0, resident_pages = 0;
  statm >> total_pages >> resident_pages;
  return resident_pages * (sysconf(_SC_PAGESIZE) / 1024);
}

void AddChannel(const std::string& channel, const ChannelTraffic& traffic,
                std::vector<msg::Counter>& counters) {
  if (traffic.received > 0) counters.push_back({"received." + channel, traffic.received});
  if (traffic.sent > 0) counters.push_back({"sent." + channel, traffic.sent});
  if (traffic.newest_seq > 0) {
    counters.push_back({"lost." + channel, traffic.lost});
    counters.push_back({"age_us." + channel, traffic.age_us_max});
  }
  for (const auto& [reason, count] : traffic.refused)
    counters.push_back({"refused." + channel + "." + reason, count});
}

}  // namespace

ProcessUsage ProcessUsage::Now() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {Milliseconds(usage.ru_utime) + Milliseconds(usage.ru_stime), ResidentKilobytes()};
}

StatusCounters::Sums StatusCounters::SumUp(const BusTraffic& traffic) {
  Sums sums;
  for (const auto& [name, channel] : traffic) {
    sums.received += channel.received;
    sums.received_bytes += channel.received_bytes;
    sums.sent += channel.sent;
    sums.sent_bytes += channel.sent_bytes;
    sums.refused += channel.Refused();
    sums.lost += channel.lost;
    sums.wait_us = std::max(sums.wait_us, channel.wait_us_max);
    sums.handler_us = std::max(sums.handler_us, channel.handler_us_max);
  }
  return sums;
}

std::vector<msg::Counter> StatusCounters::Take(const BusTraffic& traffic, ProcessUsage usage,
                                               Utime now) {
  const Sums sums = SumUp(traffic);
  const Utime passed_us = std::max<Utime>(now - last_, 1);
  const auto per_second = [passed_us](int64_t more) {
    return (more * kSecond + passed_us / 2) / passed_us;
  };
  std::vector<msg::Counter> counters = {
      {"uptime_s", (now - began_) / kSecond},
      {"cpu_ms", usage.cpu_ms},
      {"cpu_percent", per_second(usage.cpu_ms - last_usage_.cpu_ms) / 10},
      {"rss_kb", usage.rss_kb},
      {"received", sums.received},
      {"received_bytes", sums.received_bytes},
      {"received_per_s", per_second(sums.received - last_sums_.received)},
      {"sent", sums.sent},
      {"sent_bytes", sums.sent_bytes},
      {"sent_per_s", per_second(sums.sent - last_sums_.sent)},
      {"refused", sums.refused},
      {"lost", sums.lost},
      {"wait_us", sums.wait_us},
      {"handler_us", sums.handler_us}};
  for (const auto& [name, channel] : traffic) AddChannel(name, channel, counters);
  last_ = now;
  last_usage_ = usage;
  last_sums_ = sums;
  return counters;
}

}  // namespace beckon
