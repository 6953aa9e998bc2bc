#include "services/base/status_reporter.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <utility>

#include "services/base/app.h"

namespace beckon {

std::string HostName() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name[0] == '\0' ? "unnamed" : name.data();
}

StatusReporter::StatusReporter(std::string service, Bus& bus, RunLoop& loop,
                               std::function<void(msg::Status&)> fill)
    : bus_(bus), loop_(loop), fill_(std::move(fill)), counters_(SteadyClock().Now()) {
  common_.service = std::move(service);
  common_.host = HostName();
  common_.pid = getpid();
  common_.started_utime = SystemClock().Now();
  common_.build = VersionString();
  timer_ = loop.Every(kSecond, [this] { Report(); });
}

StatusReporter::~StatusReporter() { loop_.Cancel(timer_); }

void StatusReporter::Report() {
  msg::Status status = common_;
  status.utime = SystemClock().Now();
  status.counters = counters_.Take(bus_.traffic(), ProcessUsage::Now(), SteadyClock().Now());
  bus_.ForgetPeaks();
  fill_(status);
  if (status.counters.size() > msg::kMaxCounters) status.counters.resize(msg::kMaxCounters);
  if (auto sent = bus_.Publish(status); !sent) spdlog::error("{}", sent.error().message);
}

}  // namespace beckon
