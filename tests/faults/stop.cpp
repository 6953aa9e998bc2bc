// Stop pressed on the page until the robot's host hears it, across the relay, while the camera's
// images and everything made of them cross it too.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <random>

#include "tests/faults/lab_system.h"
#include "tests/ui_bridge/web/http_client.h"

namespace beckon::faults {
namespace {

namespace web = ui_bridge::web;

constexpr double kMostToWait_s = 2;
constexpr double kMost_ms = 100;

/// The port that ui_bridge says in its log; 0 where it says none.
int PortOf(LabSystem& system) {
  int port = 0;
  system.RunUntil(
      [&] {
        std::ifstream log(system.config().run_dir + "/ui_bridge.log");
        for (std::string line; std::getline(log, line);) {
          if (const size_t at = line.find("http://127.0.0.1:"); at != std::string::npos)
            port = std::atoi(line.c_str() + at + 17);
        }
        return port != 0;
      },
      20);
  return port;
}

/// When the robot heard a stop that was made at or after `pressed` [ms later]; -1: not in time.
class StopWatch {
 public:
  explicit StopWatch(LabSystem& system) : system_(system) {
    system.bus().Subscribe<msg::Session>([this](const msg::Session& session) {
      if (session.kind == msg::SessionKind::kRequestStop && session.utime >= pressed_ &&
          heard_ == 0)
        heard_ = clock_.Now();
    });
  }
  double Press(const std::function<void()>& press) {
    heard_ = 0;
    pressed_ = clock_.Now();
    press();
    if (!system_.RunUntil([this] { return heard_ != 0; }, kMostToWait_s)) return -1;
    return static_cast<double>(heard_ - pressed_) / 1000;
  }

 private:
  LabSystem& system_;
  const SystemClock clock_;
  Utime pressed_ = 0, heard_ = 0;
};

}  // namespace

Result<Verdict> RunStop(const TrialOptions& options) {
  auto lab = Lab::Make(SeparateHosts(), options.seed);
  if (!lab) return lab.error();
  LabSystem system(**lab, options);
  if (auto started = system.StartServices(); !started) return started.error();
  if (auto started = system.StartPage(); !started) return started.error();
  const int port = PortOf(system);
  if (port == 0) return Error{"beckon-ui-bridge serves no page\n" + system.Logs()};
  if (!system.AllAnswer(30)) return Error{"not all services answer\n" + system.Logs()};

  StopWatch watch(system);
  const Placement at;
  std::mt19937 random(static_cast<unsigned>(options.seed));
  std::vector<double> times_ms;
  int never = 0;
  const int64_t frames = system.Counter("capture", "frames");
  const Stopwatch all;
  for (int i = 0; i < options.n; ++i) {
    system.Run(1e-3 * (10 + static_cast<double>(random() % 20)));
    const double ms = watch.Press([&] {
      (*lab)->In(at.bedside, [&] {
        web::Send(port, "POST", "/api/request", {{"request", "stop"}});
      });
    });
    ms < 0 ? ++never : (times_ms.push_back(ms), 0);
  }
  system.AllAnswer();
  Verdict verdict;
  if (times_ms.empty()) return Error{"no stop was ever heard\n" + system.Logs()};
  std::ranges::sort(times_ms);
  const auto quantile = [&](double share) {
    return times_ms[std::min(times_ms.size() - 1,
                             static_cast<size_t>(share * static_cast<double>(times_ms.size())))];
  };
  const double frames_per_s = static_cast<double>(system.Counter("capture", "frames") - frames) /
                              (all.Milliseconds() * 1e-3);
  verdict.details = {
      {"stops", options.n},           {"never_heard", never},
      {"p50_ms", quantile(0.5)},      {"p99_ms", quantile(0.99)},
      {"p999_ms", quantile(0.999)},   {"max_ms", times_ms.back()},
      {"frames_per_s", frames_per_s}, {"frame_bytes", system.Counter("capture", "frame_bytes")}};
  if (never > 0) verdict.Breach(std::to_string(never) + " stops were not heard within 2 s");
  if (quantile(0.999) > kMost_ms)
    verdict.Breach("p99.9 is " + std::to_string(quantile(0.999)) + " ms");
  if (verdict.holds) {
    char text[160];
    std::snprintf(text, sizeof text, "p50 %.1f, p99 %.1f, p99.9 %.1f ms of %d stops, %.0f frames/s",
                  quantile(0.5), quantile(0.99), quantile(0.999), options.n, frames_per_s);
    verdict.found = text;
  }
  return verdict;
}

}  // namespace beckon::faults
