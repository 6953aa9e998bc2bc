// Forged, replayed, expired, altered messages, and such of the wrong role, at signed services in
// the middle of their conversations.
#include <algorithm>
#include <random>

#include "services/base/refusal.h"
#include "tests/faults/forger.h"
#include "tests/faults/lab_system.h"
#include "tests/faults/tap.h"

namespace beckon::faults {
namespace {

constexpr Utime kPace_us = 1000;  // between two of them
constexpr size_t kFormer = 5, kDecoder = 6;

constexpr const char* kSecurityReasons[] = {
    refusal::kUnsigned, refusal::kUnknownKey, refusal::kRevoked,  refusal::kNotAllowed,
    refusal::kExpired,  refusal::kForged,     refusal::kReplayed, refusal::kTooManySenders};

std::vector<HostSpec> Hosts() {
  auto hosts = SeparateHosts();
  hosts.push_back({"former", trust::Roles::All()});
  trust::Roles decoder;
  decoder.Add(trust::Role::kDecoder);
  hosts.push_back({"decoder", decoder});
  return hosts;
}

Forger::Keys KeysOf(const Lab& lab) {
  const auto own = [&](size_t host) { return **lab.keys(host).Own(); };
  Forger::Keys keys{own(kStranger), own(kFormer), own(kDecoder), {}};
  for (size_t host = 0; host < kStranger; ++host) keys.genuine.push_back(own(host));
  return keys;
}

class Attack {
 public:
  Attack(Lab& lab, LabSystem& system, const TrialOptions& options)
      : system_(system),
        tap_(lab, kStranger, system.loop()),
        forger_(KeysOf(lab), options.seed),
        random_(options.seed) {}

  /// One message each millisecond, until `n` were said.
  void Run(int n) {
    const auto timer = system_.loop().Every(kPace_us, [&] {
      if (said_ < n) SayOne();
    });
    system_.RunUntil([&] { return said_ >= n; }, 60 + n * 0.01);
    system_.loop().Cancel(timer);
  }

  int said() const { return said_; }
  const Tap& tap() const { return tap_; }

  /// What was refused by each reason, and how many were not, over all services.
  void Judge(Verdict& verdict) {
    std::map<std::string, int64_t> by_reason;
    int64_t arrived = 0, refused = 0, accepted = 0;
    for (const char* service : kServices) {
      for (const auto& [channel, traffic] : tap_.channels()) {
        const int64_t received = system_.Counter(service, "received." + channel);
        if (received == 0 || traffic.said == 0) continue;
        int64_t refused_here = 0;
        for (const char* reason : kSecurityReasons) {
          const int64_t count = system_.Counter(service, "refused." + channel + "." + reason);
          by_reason[reason] += count;
          refused_here += count;
        }
        // What was received and not refused can be no more than what was genuine.
        const int64_t genuine = traffic.heard - traffic.said;
        const int64_t believed = std::max<int64_t>(0, received - refused_here - genuine);
        if (believed > 0) {
          verdict.Breach(std::to_string(believed) + " of " + std::to_string(traffic.said) + " on " +
                         channel + " were believed by " + service);
        }
        arrived += traffic.said;
        refused += refused_here;
        accepted += believed;
        verdict.details["services"][service][channel] = {{"said", traffic.said},
                                                         {"received", received},
                                                         {"refused", refused_here},
                                                         {"genuine", genuine}};
      }
    }
    for (const auto& [kind, count] : made_) verdict.details["said"][kind] = count;
    for (const auto& [reason, count] : by_reason) verdict.details["refused"][reason] = count;
    verdict.details["sent_to_services"] = arrived;
    verdict.details["refused_by_services"] = refused;
    verdict.details["believed"] = accepted;
  }

 private:
  void SayOne() {
    const auto& [kind, name] = kForgeries[random_() % kForgeries.size()];
    const std::string& channel = channels_[random_() % channels_.size()];
    const auto heard = tap_.channels().find(channel);
    const bool real = heard != tap_.channels().end() && heard->second.heard > heard->second.said;
    if (kind == Forgery::kReplayed && !real) return;
    // Of its own words the tap hears copies too: those are no less forged.
    const auto& original = real ? heard->second.latest[random_() % heard->second.latest.size()]
                                : examples_.at(channel);
    const auto forged = forger_.Forge(kind, channel, original);
    if (!forged) return;
    tap_.Say(channel, *forged);
    ++made_[name];
    ++said_;
  }

  LabSystem& system_;
  Tap tap_;
  Forger forger_;
  std::mt19937_64 random_;
  const std::vector<std::string> channels_ = Forger::Channels();
  const std::map<std::string, std::vector<uint8_t>> examples_ = ExamplesByChannel();
  std::map<std::string, int> made_;
  int said_ = 0;
};

}  // namespace

Result<Verdict> RunForged(const TrialOptions& options) {
  auto lab = Lab::Make(Hosts(), options.seed, 65'535);
  if (!lab) return lab.error();
  for (size_t host = 0; host < kStranger; ++host) {
    if (auto revoked = (*lab)->keys(host).Revoke("former"); !revoked) return revoked.error();
  }
  LabSystem system(**lab, options);
  system.config().think_s = 0.02;
  Verdict verdict;
  Attack attack(**lab, system, options);
  if (auto started = system.StartServices(); !started) return started.error();
  if (auto started = system.StartUser(); !started) return started.error();
  if (!system.ASessionEnds(60)) return Error{"no session without any attack\n" + system.Logs()};
  attack.Run(options.n);
  if (attack.said() < options.n)
    return Error{"only " + std::to_string(attack.said()) + " could be said in time"};
  if (!system.ASessionEnds()) verdict.Breach("no session ended after the attack\n" + system.Logs());
  system.Run(0.5);
  if (!system.AllAnswer()) verdict.Breach("a service went silent\n" + system.Logs());
  attack.Judge(verdict);
  if (!system.deaths().empty()) verdict.Breach(system.deaths()[0].name + " died");
  if (system.WrongTasks() > 0)
    verdict.Breach(std::to_string(system.WrongTasks()) + " tasks nobody wanted");
  if (verdict.holds) {
    verdict.found = "0 of " + std::to_string(attack.said()) + " believed; the " +
                    std::to_string(system.sessions().size()) +
                    " sessions meanwhile ended in the user's task";
  }
  return verdict;
}

}  // namespace beckon::faults
