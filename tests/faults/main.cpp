// beckon-faults: real services in a lab of several hosts while everything goes wrong that may. One
// subcommand a property; prints a row for the table, and what it is made of as JSON.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "services/base/app.h"
#include "services/base/utime.h"
#include "tests/faults/lab.h"
#include "tests/faults/trial.h"

namespace {

using namespace beckon;
using namespace beckon::faults;

constexpr int kBroken = 1, kBadInput = 2, kNotPossibleHere = 77;

struct Property {
  const char* name;
  const char* what;
  const char* demanded;
  Trial run;
  int quick, full;
};

constexpr Property kProperties[] = {
    {"kills", "SIGKILL of any service at random points",
     "1,000 kills: no acknowledged session lost or doubled, integrity_check ok, the dialogue "
     "resumes",
     RunKills, 10, 1000},
    {"forged", "forged, replayed, expired, altered control messages", "0 of 100,000 accepted",
     RunForged, 2000, 100'000},
    {"mutations", "mutated datagrams at the live system",
     "1,000,000 datagrams: no crash, no hang, no task published; 50,000 junk datagrams/s: goes on, "
     "or "
     "resumes within 1 s of their end",
     RunMutations, 20'000, 1'000'000},
    {"partitions", "partitions, restarts, clock skew of +-1 h among 3 machines",
     "200 runs: all converge within 5 s of healing, the union exact", RunPartitions, 2, 200},
    {"loss", "control messages under image load with 1 % loss, duplicates, reordering",
     "no task lost, doubled or wrong in 100,000", RunLoss, 50, 100'000},
    {"stop", "stop pressed to robot told, under full load", "p99.9 <= 100 ms", RunStop, 50, 2000},
    {"soak", "soak: frames and simulated sessions", "an hour: flat memory, no drop unaccounted",
     RunSoak, 20, 3600},
    {"bad-inputs", "database damaged, disk full or read-only, clock off by a day",
     "a clear error or service; nothing promised that is not stored", RunBadInputs, 1, 1},
};

/// One line of a table; what was found may be long.
std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

int Judge(const Property& property, const TrialOptions& options, const std::string& json) {
  const Stopwatch watch;
  auto verdict = property.run(options);
  if (!verdict) {
    std::fprintf(stderr, "beckon-faults: %s\n", verdict.error().message.c_str());
    return kBadInput;
  }
  const double seconds = watch.Milliseconds() * 1e-3;
  std::printf("| %s | %s | %s%s | %llu | %.0f |\n", property.what, property.demanded,
              verdict->holds ? "" : "**broken**: ", FirstLine(verdict->found).c_str(),
              static_cast<unsigned long long>(options.seed), seconds);
  if (!verdict->holds) std::fprintf(stderr, "%s\n", verdict->found.c_str());
  const nlohmann::ordered_json line = {
      {"property", property.name},     {"what", property.what},
      {"demanded", property.demanded}, {"found", FirstLine(verdict->found)},
      {"holds", verdict->holds},       {"n", options.n},
      {"seed", options.seed},          {"seconds", seconds},
      {"version", VersionString()},    {"details", verdict->details}};
  if (!json.empty())
    std::ofstream(json, std::ios::app)
        << line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
  return verdict->holds ? 0 : kBroken;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Real services in a lab of several hosts, and faults of every kind; see "
      "docs/experiments/faults.\n"
      "Exit code: 0 holds, 1 broken, 2 could not be tried, 77 not possible on this machine.",
      "beckon-faults");
  TrialOptions options;
  bool quick = false;
  double scale = 1;
  std::string json;
  app.add_option("--seed", options.seed, "Decides every fault");
  app.add_flag("--quick", quick, "Seconds instead of hours");
  app.add_option("--scale", scale, "So much of the full count")->check(Within(1e-6, 1000));
  app.add_option("--n", options.n, "The count itself")->check(CLI::Range(1, 1'000'000'000));
  app.add_option("--json", json, "Append the counts to FILE, as a line")->type_name("FILE");
  app.add_option("--bin", options.bin_dir, "Folder of the programs")->capture_default_str();
  app.require_subcommand(1);
  app.fallthrough();
  for (const auto& property : kProperties) app.add_subcommand(property.name, property.what);
  CLI11_PARSE(app, argc, argv);
  if (auto entered = EnterLabNamespaces(argv); !entered) {
    std::fprintf(stderr, "beckon-faults: skipped: %s\n", entered.error().message.c_str());
    return kNotPossibleHere;
  }
  spdlog::set_level(spdlog::level::err);  // refusing is what is tested
  for (const auto& property : kProperties) {
    if (!app.got_subcommand(property.name)) continue;
    if (options.n == 0)
      options.n = quick ? property.quick : std::max(1, static_cast<int>(property.full * scale));
    try {
      return Judge(property, options, json);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "beckon-faults: %s\n", e.what());
      return kBadInput;
    }
  }
  return kBadInput;
}
