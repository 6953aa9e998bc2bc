// What believing costs: CPU time to sign and to check a message, as the bus does it. Prints the
// figures; writes JSON.
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lcmtypes/codec.h"
#include "services/base/app.h"
#include "services/base/trust/guard.h"
#include "tests/base/trust/temporary_keys.h"

namespace beckon::trust {
namespace {

double CpuMicroseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

struct Times {
  std::vector<double> sign_us, check_us;
};

template <typename T>
Times Measure(Guard& guard, T message, int repeat) {
  Times times;
  for (int i = 0; i < repeat; ++i) {
    guard.Stamp(message.seal, DemandOf(message).may_last);
    auto bytes = *Codec<T>::Encode(message);
    const double before_us = CpuMicroseconds();
    guard.Sign(bytes);
    const double signed_us = CpuMicroseconds();
    const auto rejection =
        guard.Check(Codec<T>::kChannel, Codec<T>::Decode(bytes)->seal, DemandOf(message), bytes);
    const double checked_us = CpuMicroseconds();
    if (rejection) throw std::runtime_error("refused: " + rejection->detail);
    times.sign_us.push_back(signed_us - before_us);
    times.check_us.push_back(checked_us - signed_us);
  }
  std::ranges::sort(times.sign_us);
  std::ranges::sort(times.check_us);
  return times;
}

/// The largest control message there is.
msg::History FullHistory() {
  msg::History history{.utime = 5, .machine = "kitchen", .run = "r"};
  for (int i = 1; i <= 57; ++i)
    history.rows.push_back(
        {"kitchen", i, 5, "session", "{\"text\": \"" + std::string(950, 'x') + "\"}"});
  return history;
}

Status Run(int repeat, const std::string& json) {
  const TemporaryKeys keys("kitchen");
  const SystemClock clock;
  const SteadyClock steady;
  Guard guard(keys.folder(), **keys.folder().Own(), "", clock, steady);
  nlohmann::json out;
  std::printf("CPU us, median (p99)     sign              check\n");
  const auto report = [&](const char* name, const Times& times) {
    const size_t middle = times.sign_us.size() / 2;
    const size_t late = times.sign_us.size() * 99 / 100;
    std::printf("%-20s %7.1f (%6.1f)  %7.1f (%6.1f)\n", name, times.sign_us[middle],
                times.sign_us[late], times.check_us[middle], times.check_us[late]);
    out[name] = {{"sign_us", times.sign_us[middle]},
                 {"check_us", times.check_us[middle]},
                 {"sign_p99_us", times.sign_us[late]},
                 {"check_p99_us", times.check_us[late]}};
  };
  report(
      "answer",
      Measure(
          guard,
          msg::Answer{
              .utime = 5, .query_id = 7, .session_id = "s", .device = "d", .likelihoods = {1, 0}},
          repeat));
  report("history, 57 kB", Measure(guard, FullHistory(), repeat));
  if (!json.empty()) std::ofstream(json) << out.dump(2) << "\n";
  return {};
}

}  // namespace
}  // namespace beckon::trust

int main(int argc, char** argv) {
  CLI::App app("CPU time of signing and checking messages.", "beckon-bench-trust");
  int repeat = 5000;
  std::string json;
  app.add_option("--repeat", repeat, "Messages of each kind")->check(CLI::Range(10, 1'000'000));
  app.add_option("--json", json, "Write the figures")->type_name("FILE");
  CLI11_PARSE(app, argc, argv);
  if (auto done = beckon::trust::Run(repeat, json); !done) {
    std::fprintf(stderr, "beckon-bench-trust: %s\n", done.error().message.c_str());
    return 1;
  }
  return 0;
}
