#include "services/intention/core/lease.h"

#include <algorithm>
#include <utility>

namespace beckon::intention {
namespace {

constexpr size_t kMostUsers = 256;
/// A claim's rank is the lowest digit of its term: who deserves the lease more claims a higher
/// term.
constexpr int64_t kRanks = 4;
constexpr int64_t kRankLedLast = 2;
constexpr int64_t kRankHasScene = 1;
/// Nobody gets there by claiming.
constexpr int64_t kMostTerm = int64_t{1} << 60;

}  // namespace

Leases::Leases(LeaseHolder self, Utime now, const LeaseConfig& config)
    : self_(std::move(self)),
      config_(config),
      ticked_(now),
      listening_since_(now),
      peer_heard_(now - config.peer_memory - 1) {}

bool Leases::IsMine(LeaseState state) const {
  return state == LeaseState::kClaiming || state == LeaseState::kHeld ||
         state == LeaseState::kLapsed;
}

bool Leases::HasRivals(Utime now) const {
  return now - peer_heard_ <= config_.peer_memory || now - listening_since_ < config_.peer_silence;
}

Leases::Entry* Leases::Make(const std::string& user) {
  if (const auto known = entries_.find(user); known != entries_.end()) return &known->second;
  if (entries_.size() >= kMostUsers) {
    const auto idle = std::ranges::find(entries_, LeaseState::kFree,
                                        [](const auto& entry) { return entry.second.state; });
    if (idle == entries_.end()) return nullptr;
    entries_.erase(idle);
  }
  return &entries_[user];
}

void Leases::Say(const std::string& user, const Entry& entry, Utime remaining) {
  msg::Lease lease;
  lease.user = user;
  lease.session_id = entry.session_id;
  lease.holder = self_.machine;
  lease.run = self_.run;
  lease.term = entry.term;
  lease.remaining_ms = static_cast<int>(remaining / 1000);
  news_.push_back(std::move(lease));
}

void Leases::BeginClaim(const std::string& user, Entry& entry, bool has_scene, Utime wait,
                        Utime now) {
  const int64_t rank =
      (entry.holder.machine == self_.machine ? kRankLedLast : 0) + (has_scene ? kRankHasScene : 0);
  entry.term = (entry.term / kRanks + 1) * kRanks + rank;
  entry.holder = self_;
  entry.state = LeaseState::kClaiming;
  entry.until = now + wait;
  entry.say_at = now + config_.claim_repeat;
  if (wait == 0) return Win(user, entry, now);
  Say(user, entry, config_.duration);
}

void Leases::Win(const std::string& user, Entry& entry, Utime now) {
  entry.state = LeaseState::kHeld;
  entry.until = now + config_.duration;
  entry.say_at = now + config_.repeat;
  term_ = std::max(term_, entry.term);
  Say(user, entry, config_.duration);
  news_.push_back(LeaseWon{user, entry.session_id});
}

void Leases::Claim(const std::string& user, const std::string& session_id, bool has_scene,
                   Utime now) {
  Entry* entry = Make(user);
  if (entry == nullptr || entry->state != LeaseState::kFree) return;
  entry->session_id = session_id;
  BeginClaim(user, *entry, has_scene, HasRivals(now) ? config_.claim_window : 0, now);
}

void Leases::GiveBack(const std::string& user, Utime now) {
  const auto found = entries_.find(user);
  if (found == entries_.end() || !IsMine(found->second.state)) return;
  Entry& entry = found->second;
  entry.state = LeaseState::kFree;
  entry.say_at = now + config_.repeat;
  entry.say_until = now + config_.duration;  // by then it has run out for those who missed it
  Say(user, entry, 0);
}

void Leases::Tick(Utime now) {
  const Utime gap = now - std::exchange(ticked_, now);
  const bool deaf = gap > config_.deaf;
  if (deaf) listening_since_ = now;
  for (auto& [user, entry] : entries_) {
    // What was sent meanwhile is read first: nothing is taken for silence, nor for consent.
    if (deaf && entry.state == LeaseState::kElsewhere)
      entry.until = std::max(entry.until, now + 2 * config_.repeat);
    const bool waits = entry.state == LeaseState::kClaiming || entry.state == LeaseState::kLapsed;
    if (waits && gap > config_.claim_window) entry.until = now + config_.claim_window;
    TickOne(user, entry, now);
  }
}

void Leases::TickOne(const std::string& user, Entry& entry, Utime now) {
  switch (entry.state) {
    case LeaseState::kFree:
      if (now >= entry.say_until || now < entry.say_at) return;
      entry.say_at = now + config_.repeat;
      return Say(user, entry, 0);
    case LeaseState::kClaiming:
      if (now >= entry.until) return Win(user, entry, now);
      if (now < entry.say_at) return;
      entry.say_at = now + config_.claim_repeat;
      return Say(user, entry, config_.duration);
    case LeaseState::kHeld:
      if (now >= entry.until) {
        entry.state = LeaseState::kLapsed;
        entry.until = now + config_.claim_window;
        return;
      }
      if (now < entry.say_at) return;
      entry.say_at = now + config_.repeat;
      entry.until = now + config_.duration;
      return Say(user, entry, config_.duration);
    case LeaseState::kLapsed:
      // Whether there are rivals is not known after a pause. It led last, and has a table.
      if (now >= entry.until) BeginClaim(user, entry, true, config_.claim_window, now);
      return;
    case LeaseState::kElsewhere:
      if (now < entry.until) return;
      entry.state = LeaseState::kFree;
      entry.say_until = 0;
      news_.push_back(LeaseOrphaned{user, entry.session_id});
  }
}

bool Leases::OnLease(const msg::Lease& lease, Utime now) {
  if (lease.holder == self_.machine && lease.run == self_.run) return true;  // our own
  if (lease.term >= kMostTerm) return false;
  HearPeer(now);
  if (Entry* entry = Make(lease.user)) {
    IsMine(entry->state) ? HearRival(lease, *entry, now) : Hear(lease, *entry, now);
  }
  return true;
}

void Leases::HearRival(const msg::Lease& lease, Entry& entry, Utime now) {
  if (lease.remaining_ms == 0) return;
  const Order theirs{lease.term, {lease.holder, lease.run}};
  if (entry.state == LeaseState::kLapsed || theirs > Order{entry.term, self_}) {
    Follow(lease, entry, now);
    news_.push_back(LeaseLost{lease.user});
  } else {  // it does not know of ours
    Say(lease.user, entry, entry.state == LeaseState::kHeld ? entry.until - now : config_.duration);
  }
}

void Leases::Hear(const msg::Lease& lease, Entry& entry, Utime now) {
  const LeaseHolder theirs{lease.holder, lease.run};
  const bool elsewhere = entry.state == LeaseState::kElsewhere;
  if (lease.remaining_ms == 0) {
    if (!elsewhere) {
      entry.term = std::max(entry.term, lease.term);
    } else if (theirs == entry.holder && lease.term >= entry.term) {
      entry.state = LeaseState::kFree;
      entry.say_until = 0;
    }
    return;
  }
  // What is no news of a lease that is over, or of one that was replaced, came late.
  if (theirs == entry.holder && (elsewhere ? lease.term < entry.term : lease.term <= entry.term))
    return;
  // Another run of a machine tells that the one before is dead, whatever its term.
  const bool successor = elsewhere && theirs.machine == entry.holder.machine;
  if (!elsewhere || successor || Order{lease.term, theirs} >= Order{entry.term, entry.holder})
    Follow(lease, entry, now);
}

void Leases::Follow(const msg::Lease& lease, Entry& entry, Utime now) {
  entry.state = LeaseState::kElsewhere;
  entry.term = lease.term;
  entry.holder = {lease.holder, lease.run};
  entry.session_id = lease.session_id;
  entry.until = now + Utime{lease.remaining_ms} * 1000;
}

LeaseState Leases::StateOf(const std::string& user) const {
  const auto found = entries_.find(user);
  return found == entries_.end() ? LeaseState::kFree : found->second.state;
}

bool Leases::Holds(const std::string& user, Utime now) const {
  const auto found = entries_.find(user);
  return found != entries_.end() && found->second.state == LeaseState::kHeld &&
         now < found->second.until;
}

bool Leases::Claims(const std::string& user, const std::string& session_id) const {
  const auto found = entries_.find(user);
  return found != entries_.end() && found->second.state == LeaseState::kClaiming &&
         found->second.session_id == session_id;
}

bool Leases::IsElsewhere(const std::string& user, const std::string& session_id) const {
  const auto found = entries_.find(user);
  if (found == entries_.end() || IsMine(found->second.state)) return false;
  const Entry& entry = found->second;
  return entry.session_id == session_id && !entry.holder.machine.empty() && entry.holder != self_;
}

bool Leases::IsElsewhere(const std::string& session_id) const {
  return std::ranges::any_of(entries_, [&](const auto& entry) {
    return entry.second.session_id == session_id && IsElsewhere(entry.first, session_id);
  });
}

std::vector<std::string> Leases::Held() const {
  std::vector<std::string> users;
  for (const auto& [user, entry] : entries_) {
    if (entry.state == LeaseState::kHeld) users.push_back(user);
  }
  return users;
}

}  // namespace beckon::intention
