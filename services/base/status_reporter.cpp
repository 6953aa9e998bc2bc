#include "services/base/status_reporter.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <utility>

#include "services/base/app.h"

namespace beckon {
namespace {

int64_t ResidentKilobytes() {
  std::ifstream statm("/proc/self/statm");
  int64_t total_pages = 0, resident_pages = 0;
  statm >> total_pages >> resident_pages;
  return resident_pages * (sysconf(_SC_PAGESIZE) / 1024);
}

}  // namespace

std::string HostName() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name[0] == '\0' ? "unnamed" : name.data();
}

StatusReporter::StatusReporter(std::string service, Bus& bus, RunLoop& loop,
                               std::function<void(msg::Status&)> fill)
    : loop_(loop) {
  msg::Status common;
  common.service = std::move(service);
  common.host = HostName();
  common.pid = getpid();
  common.started_utime = SystemClock().Now();
  common.build = VersionString();
  timer_ = loop.Every(kSecond, [&bus, common = std::move(common), fill = std::move(fill)] {
    msg::Status status = common;
    status.utime = SystemClock().Now();
    status.counters = {
        {"received", bus.received()}, {"refused", bus.refused()}, {"rss_kb", ResidentKilobytes()}};
    for (const auto& [channel, count] : bus.refused_by_channel()) {
      status.counters.push_back({"refused." + channel, count});
    }
    fill(status);
    if (auto sent = bus.Publish(status); !sent) spdlog::error("{}", sent.error().message);
  });
}

StatusReporter::~StatusReporter() { loop_.Cancel(timer_); }

}  // namespace beckon
