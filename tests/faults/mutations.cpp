// Damaged datagrams, hostile fragments and floods of junk at the live system, all on one host.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "tests/faults/datagram_socket.h"
#include "tests/faults/lab_system.h"
#include "tests/faults/mutator.h"

namespace beckon::faults {
namespace {

constexpr size_t kHub = 0, kRobot = 1;
constexpr Placement kOnOneHost = {.camera = kHub, .hub = kHub, .bedside = kHub, .robot = kRobot};
constexpr size_t kRecorded = 400;
constexpr int kBurst = 10;  // each 2 ms
constexpr double kFloodSeconds = 5;
constexpr int kFloodPerSecond = 50'000;

/// What of `deaths` came since `before`, for people.
std::string DeathsSince(const LabSystem& system, size_t before) {
  std::string text;
  for (size_t i = before; i < system.deaths().size(); ++i) {
    const auto& death = system.deaths()[i];
    text +=
        (text.empty() ? "" : "; ") + death.name + ": " + death.exit.Text() + " " + death.last_line;
  }
  return text;
}

/// As they pass while a session runs.
std::vector<Datagram> Record(LabSystem& system, DatagramSocket& socket) {
  std::vector<Datagram> real;
  system.loop().AddFd(socket.fd(), [&] {
    for (int i = 0; i < 50; ++i) {
      auto datagram = socket.Hear();
      if (datagram.empty()) return;
      if (real.size() < kRecorded && !IsFragment(datagram)) real.push_back(std::move(datagram));
    }
  });
  system.ASessionEnds(60);
  system.RunUntil([&] { return real.size() >= kRecorded / 2; }, 20);
  system.loop().RemoveFd(socket.fd());
  return real;
}

/// Says `n` datagrams; a conversation runs meanwhile.
void SayAll(LabSystem& system, DatagramSocket& socket, int n,
            const std::function<Datagram()>& make) {
  int said = 0;
  const auto timer = system.loop().Every(2'000, [&] {
    for (int i = 0; i < kBurst && said < n; ++i) said += socket.Say(make()) ? 1 : 0;
  });
  system.RunUntil([&] { return said >= n; }, 30 + n * 1e-3);
  system.loop().Cancel(timer);
}

/// The system lives, answers, and its conversation goes on.
void MustConverse(LabSystem& system, const std::string& after, Verdict& verdict) {
  if (!system.AllAnswer(15))
    verdict.Breach("a service went silent after " + after + "\n" + system.Logs());
  if (!system.ASessionEnds())
    verdict.Breach("no session ended after " + after + "\n" + system.Logs());
  if (system.WrongTasks() > 0)
    verdict.Breach(std::to_string(system.WrongTasks()) + " tasks nobody wanted after " + after);
}

void SayDamaged(LabSystem& system, DatagramSocket& socket, const TrialOptions& options,
                const std::vector<Datagram>& real, Verdict& verdict) {
  Mutator mutator(options.seed);
  SayAll(system, socket, options.n, [&] { return mutator.Mutate(real); });
  MustConverse(system, "damaged datagrams", verdict);
  if (const auto deaths = DeathsSince(system, 0); !deaths.empty())
    verdict.Breach("damaged datagrams killed " + deaths);
}

/// As fast as told, in a thread of its own.
int64_t Flood(LabSystem& system, DatagramSocket& socket, uint64_t seed) {
  std::atomic<bool> goes_on = true;
  std::atomic<int64_t> said = 0;
  std::thread flood([&] {
    Mutator mutator(seed);
    std::vector<Datagram> junk(1000);
    std::ranges::generate(junk, [&] { return mutator.Junk(); });
    const auto begin = std::chrono::steady_clock::now();
    for (int64_t tick = 1; goes_on; ++tick) {
      const std::span<const Datagram> part(&junk[static_cast<size_t>(tick % 20) * 50], 50);
      said += static_cast<int64_t>(socket.Say(part));
      std::this_thread::sleep_until(
          begin + tick * std::chrono::microseconds(1'000'000LL * 50 / kFloodPerSecond));
    }
  });
  system.Run(kFloodSeconds);
  goes_on = false;
  flood.join();
  return said;
}

void SayJunk(LabSystem& system, DatagramSocket& socket, uint64_t seed, Verdict& verdict) {
  const size_t deaths = system.deaths().size();
  const auto& observer = system.watch().observer();
  const int questions = observer.questions();
  const int64_t said = Flood(system, socket, seed);
  const int meanwhile = observer.questions() - questions;
  const Stopwatch watch;
  const int then = observer.questions();
  const bool resumed = system.RunUntil([&] { return observer.questions() > then; }, 10);
  const double resumed_s = watch.Milliseconds() * 1e-3;
  verdict.details["flood"] = {{"seconds", kFloodSeconds},
                              {"datagrams_per_s", static_cast<double>(said) / kFloodSeconds},
                              {"questions_meanwhile", meanwhile},
                              {"next_question_after_s", resumed ? resumed_s : -1}};
  if (!resumed || resumed_s > 1)
    verdict.Breach("after a flood the next question took " + std::to_string(resumed_s) + " s");
  if (system.deaths().size() > deaths)
    verdict.Breach("a flood killed " + DeathsSince(system, deaths));
  MustConverse(system, "a flood", verdict);
}

/// They crash LCM's library itself, now and then; what counts is that everything comes back. This
/// program uses that library too, so the robot's host is cut off meanwhile.
void SayFragments(Lab& lab, LabSystem& system, DatagramSocket& socket, const TrialOptions& options,
                  Verdict& verdict) {
  const size_t before = system.deaths().size();
  lab.relay().Change([](LinkFaults& faults) { faults.Cut({0, 1}); });
  system.ExpectUnheardRequests();
  Mutator mutator(options.seed + 1);
  const int n = std::max(100, options.n / 20);
  SayAll(system, socket, n, [&] { return mutator.HostileFragment(); });
  lab.relay().Change([](LinkFaults& faults) { faults.Heal(); });
  const Stopwatch watch;
  MustConverse(system, "hostile fragments", verdict);
  std::map<std::string, int> crashes;
  for (size_t i = before; i < system.deaths().size(); ++i) {
    const auto& death = system.deaths()[i];
    ++crashes[death.name + ": " + death.exit.Text()];
  }
  verdict.details["hostile_fragments"] = {{"said", n},
                                          {"deaths", system.deaths().size() - before},
                                          {"by", crashes},
                                          {"converses_after_s", watch.Milliseconds() * 1e-3}};
}

}  // namespace

Result<Verdict> RunMutations(const TrialOptions& options) {
  auto lab = Lab::Make({{"hub"}, {"robot"}}, options.seed, 65'535);
  if (!lab) return lab.error();
  LabSystem system(**lab, options, kOnOneHost);
  system.config().think_s = 0.02;
  DatagramSocket socket(**lab, kHub, /*stays=*/true);
  if (auto started = system.StartServices(); !started) return started.error();
  if (auto started = system.StartUser(); !started) return started.error();
  const auto real = Record(system, socket);
  if (real.size() < kRecorded / 2) return Error{"too little was recorded\n" + system.Logs()};
  Verdict verdict;
  SayDamaged(system, socket, options, real, verdict);
  if (verdict.holds) SayJunk(system, socket, options.seed, verdict);
  if (verdict.holds) SayFragments(**lab, system, socket, options, verdict);
  system.CheckDatabase(verdict);
  if (verdict.holds) {
    const auto& flood = verdict.details["flood"];
    const auto& fragments = verdict.details["hostile_fragments"];
    verdict.found =
        std::to_string(options.n) +
        " damaged datagrams: no crash, no hang, no task nobody wanted; " +
        std::to_string(flood["datagrams_per_s"].get<int>()) +
        " junk datagrams/s: " + std::to_string(flood["questions_meanwhile"].get<int>()) +
        " questions meanwhile, the next " +
        std::to_string(static_cast<int>(1000 * flood["next_question_after_s"].get<double>())) +
        " ms after; apart from this, " + std::to_string(fragments["said"].get<int>()) +
        " hostile fragments crashed liblcm in services " +
        std::to_string(fragments["deaths"].get<int>()) + " times, all came back";
  }
  return verdict;
}

}  // namespace beckon::faults
