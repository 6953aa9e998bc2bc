// Frames and sessions for a long time: memory stays flat, and every frame is handled or counted as
// dropped.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/faults/lab_system.h"

namespace beckon::faults {
namespace {

constexpr double kFlat = 0.03;     // of the memory, over the whole time after warm-up
constexpr double kFlat_kb = 4096;  // or this, whichever is more
constexpr int64_t kInFlight = 75;  // frames between two statuses of two processes, and one more

struct Samples {
  std::vector<double> time_s, rss_kb;

  /// By which a straight line through them rises from first to last.
  double Growth() const {
    const auto n = static_cast<double>(time_s.size());
    if (n < 3) return 0;
    const double t = std::accumulate(time_s.begin(), time_s.end(), 0.0) / n;
    const double m = std::accumulate(rss_kb.begin(), rss_kb.end(), 0.0) / n;
    double covariance = 0, variance = 0;
    for (size_t i = 0; i < time_s.size(); ++i) {
      covariance += (time_s[i] - t) * (rss_kb[i] - m);
      variance += (time_s[i] - t) * (time_s[i] - t);
    }
    return variance > 0 ? covariance / variance * (time_s.back() - time_s.front()) : 0;
  }
};

void JudgeMemory(const std::map<std::string, Samples>& memory, Verdict& verdict) {
  for (const auto& [service, samples] : memory) {
    if (samples.rss_kb.empty()) continue;
    const double growth = samples.Growth(), rss = samples.rss_kb.front();
    verdict.details["memory"][service] = {{"rss_kb", rss}, {"growth_kb", growth}};
    if (growth > std::max(kFlat_kb, kFlat * rss))
      verdict.Breach(service + " grew by " + std::to_string(static_cast<int>(growth)) + " kB");
  }
}

/// Sent = received + lost by gaps; received = computed + repeated + dropped + refused + failed.
void JudgeFrames(const LabSystem& system, Verdict& verdict) {
  const auto of = [&](const char* name) { return system.Counter("perception", name); };
  const int64_t sent = system.Counter("capture", "sent.BECKON_FRAME");
  const int64_t received = of("received.BECKON_FRAME"), lost = of("lost.BECKON_FRAME");
  const int64_t handled = of("computed") + of("repeated");
  const int64_t dropped = of("dropped") + of("damaged") + of("failed");
  const int64_t refused = of("refused.BECKON_FRAME.malformed");
  verdict.details["frames"] = {{"sent", sent},       {"received", received}, {"lost", lost},
                               {"handled", handled}, {"dropped", dropped},   {"refused", refused}};
  if (const int64_t missing = sent - received - lost; std::abs(missing) > kInFlight)
    verdict.Breach(std::to_string(missing) + " of " + std::to_string(sent) +
                   " frames sent are unaccounted for");
  if (const int64_t missing = received - handled - dropped - refused; std::abs(missing) > 2)
    verdict.Breach(std::to_string(missing) + " of " + std::to_string(received) +
                   " frames received are unaccounted for");
}

}  // namespace

Result<Verdict> RunSoak(const TrialOptions& options) {
  auto lab = Lab::Make(SeparateHosts(), options.seed, 65'535);
  if (!lab) return lab.error();
  LabSystem system(**lab, options);
  system.config().think_s = 0.05;
  if (auto started = system.StartServices(); !started) return started.error();
  if (auto started = system.StartUser(); !started) return started.error();
  if (!system.ASessionEnds(60)) return Error{"no session\n" + system.Logs()};
  const double warm_up_s = std::min(120.0, 0.4 * options.n);
  system.Run(warm_up_s);
  std::map<std::string, Samples> memory;
  const Stopwatch watch;
  while (watch.Milliseconds() * 1e-3 < options.n - warm_up_s) {
    system.Run(std::clamp(options.n / 600.0, 0.5, 5.0));
    for (const char* service : kServices) {
      memory[service].time_s.push_back(watch.Milliseconds() * 1e-3);
      memory[service].rss_kb.push_back(static_cast<double>(system.Counter(service, "rss_kb")));
    }
  }
  Verdict verdict;
  if (!system.AllAnswer()) verdict.Breach("a service went silent\n" + system.Logs());
  JudgeMemory(memory, verdict);
  JudgeFrames(system, verdict);
  if (!system.deaths().empty()) verdict.Breach(system.deaths()[0].name + " died");
  if (system.WrongTasks() > 0)
    verdict.Breach(std::to_string(system.WrongTasks()) + " tasks nobody wanted");
  system.CheckDatabase(verdict);
  verdict.details["sessions"] = system.sessions().size();
  if (verdict.holds) {
    double most = 0;
    for (const auto& [service, samples] : memory) most = std::max(most, samples.Growth());
    char text[200];
    std::snprintf(
        text, sizeof text,
        "%d s, %zu sessions, %lld frames, each handled or counted; memory grew by %.1f MB "
        "at most after warm-up",
        options.n, system.sessions().size(),
        static_cast<long long>(verdict.details["frames"]["sent"].get<int64_t>()), most / 1024);
    verdict.found = text;
  }
  return verdict;
}

}  // namespace beckon::faults
