#include "services/base/trust/guard.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "services/base/refusal.h"

namespace beckon::trust {
namespace {

constexpr Utime kLookEvery = kSecond;
/// A message that no sender gave a shorter or longer life.
constexpr Utime kLifetime = 10 * kSecond;

std::string Seconds(Utime us) { return std::to_string(us / kSecond) + " s"; }

}  // namespace

Guard::Guard(KeyFolder folder, OwnKey own, const std::string& counter_file, const Clock& clock,
             const Clock& steady)
    : folder_(std::move(folder)),
      own_(std::move(own)),
      counter_(counter_file),
      clock_(clock),
      steady_(steady),
      looked_at_(steady.Now() - kLookEvery) {
  LookForChanges();
}

void Guard::Stamp(msg::Seal& seal, bool may_last) {
  const Utime now = clock_.Now();
  if (seal.sender.empty()) seal.sender = own_.node.name;
  seal.counter = counter_.Next(now);
  if (seal.expires_utime == 0 && !may_last) seal.expires_utime = now + kLifetime;
  seal.key_id = IdOf(own_.node.key);
}

void Guard::LookForChanges() {
  const Utime now = steady_.Now();
  if (now - looked_at_ < kLookEvery) return;
  looked_at_ = now;
  const uint64_t version = folder_.Version();
  if (version == version_) return;
  version_ = version;
  const auto others = folder_.Others();
  for (const auto& fault : others.faults) spdlog::error("a key that cannot be used: {}", fault);
  trusted_.clear();
  revoked_.clear();
  for (const auto& node : others.trusted) trusted_.emplace(IdOf(node.key), node);
  for (const auto& node : others.revoked) revoked_.emplace(IdOf(node.key), node.name);
  std::erase_if(windows_, [&](const auto& entry) { return !trusted_.contains(entry.first); });
  spdlog::info("{}: signing as {}, {} keys are trusted, {} revoked", folder_.path(), own_.node.name,
               trusted_.size(), revoked_.size());
}

ReplayWindow* Guard::WindowOf(const std::string& channel, const msg::Seal& seal) {
  auto& windows = windows_[seal.key_id];
  const auto key = std::make_pair(seal.sender, channel);
  if (!windows.contains(key) && windows.size() >= kMostSenders) return nullptr;
  return &windows[key];
}

std::optional<Rejection> Guard::Check(const std::string& channel, const msg::Seal& seal,
                                      const Demand& demand, std::span<const uint8_t> encoded) {
  LookForChanges();
  if (std::ranges::all_of(seal.key_id, [](uint8_t byte) { return byte == 0; }))
    return Rejection{refusal::kUnsigned,
                     "from '" + seal.sender + "'; this machine believes signed messages only"};
  const auto known = trusted_.find(seal.key_id);
  if (known == trusted_.end()) {
    const auto revoked = revoked_.find(seal.key_id);
    if (revoked != revoked_.end())
      return Rejection{refusal::kRevoked, "by the revoked key of " + revoked->second};
    return Rejection{refusal::kUnknownKey, "key " + ToText(seal.key_id) + " of '" + seal.sender +
                                               "' is not trusted here; see beckon keys trust"};
  }
  const Node& node = known->second;
  if (!node.may.HasAnyOf(demand.one_of))
    return Rejection{refusal::kNotAllowed, node.name + " may not say this; see beckon keys list"};
  const Utime now = clock_.Now();
  if (!demand.may_last && seal.expires_utime < now) {
    return Rejection{refusal::kExpired, "from '" + seal.sender + "', " +
                                            Seconds(now - seal.expires_utime) +
                                            " ago; if it is new the machines' clocks differ"};
  }
  if (!IsSignedBy(encoded, node.key))
    return Rejection{refusal::kForged,
                     "the signature is not that of " + node.name + ", or it was altered"};
  ReplayWindow* window = WindowOf(channel, seal);
  if (window == nullptr)
    return Rejection{refusal::kTooManySenders, node.name + " speaks under more than " +
                                                   std::to_string(kMostSenders) + " names"};
  if (!demand.may_repeat && !window->IsFresh(seal.counter))
    return Rejection{refusal::kReplayed,
                     "from '" + seal.sender + "': seen before, or overtaken by many"};
  window->Note(seal.counter);
  return std::nullopt;
}

}  // namespace beckon::trust
