// Which of several intention services leads the conversation with a user: a lease with a term per
// user (after Gray and Cheriton's leases, 1989, and Raft's terms, Ongaro and Ousterhout 2014,
// without a quorum: a user who is cut off with one machine is served by that one). Leases in with
// the time, leases out; time is any clock of one's own that never goes back, durations alone cross
// the bus.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/utime.h"

namespace beckon::intention {

struct LeaseConfig {
  Utime duration = 2 * kSecond;          // that a lease holds without being repeated
  Utime repeat = kSecond / 2;            // of a lease that is held
  Utime claim_window = 150'000;          // most that rival claims are waited for
  Utime claim_repeat = 50'000;           // of a claim
  Utime peer_memory = 5 * kSecond;       // since a peer was heard: it may claim too
  Utime peer_silence = 6 * kSecond / 5;  // every peer is heard more often than that
  Utime deaf = kSecond / 2;              // without a tick: what was said meanwhile is not known yet
};

/// Who holds leases: a machine, and one run of its service.
struct LeaseHolder {
  std::string machine;
  std::string run;
  auto operator<=>(const LeaseHolder&) const = default;
};

/// What a service is to a user's conversation.
enum class LeaseState {
  kFree,      // nobody leads it
  kClaiming,  // it will, unless a better claim is heard
  kHeld,      // it does
  kLapsed,    // it did, and let it run out: listens before it claims again
  kElsewhere  // another does
};

/// It may speak for the user from now on.
struct LeaseWon {
  std::string user;
  std::string session_id;
};
/// It must be silent: another leads.
struct LeaseLost {
  std::string user;
};
/// Another led and fell silent without giving the lease back.
struct LeaseOrphaned {
  std::string user;
  std::string session_id;
};
/// What follows from what was heard, in order. A lease is to be sent (its utime is left open).
using LeaseNews = std::variant<msg::Lease, LeaseWon, LeaseLost, LeaseOrphaned>;

class Leases {
 public:
  Leases(LeaseHolder self, Utime now, const LeaseConfig& config = {});

  /// Call at least every 50 ms, and before anything else that happens.
  void Tick(Utime now);
  /// False: it is none that any service sends.
  [[nodiscard]] bool OnLease(const msg::Lease& lease, Utime now);
  /// Another intention service lives.
  void HearPeer(Utime now) { peer_heard_ = now; }

  /// Nothing unless the lease is free. Of several claims the one wins that led this user last, then
  /// one that has a scene, then the higher machine and run.
  void Claim(const std::string& user, const std::string& session_id, bool has_scene, Utime now);
  /// The conversation is over, or no longer wanted.
  void GiveBack(const std::string& user, Utime now);

  LeaseState StateOf(const std::string& user) const;
  /// Whether it may speak and act for the user at this very moment.
  bool Holds(const std::string& user, Utime now) const;
  /// Whether it claims the lease for this session, to begin or to go on.
  bool Claims(const std::string& user, const std::string& session_id) const;
  /// Whether another leads this session of the user, or did last.
  bool IsElsewhere(const std::string& user, const std::string& session_id) const;
  /// The same, of any user.
  bool IsElsewhere(const std::string& session_id) const;
  std::vector<std::string> Held() const;
  /// The highest that it ever held; 0: none.
  int64_t term() const { return term_; }

  std::vector<LeaseNews> Taken() { return std::exchange(news_, {}); }

 private:
  struct Entry {
    LeaseState state = LeaseState::kFree;
    int64_t term = 0;        // the highest heard of
    LeaseHolder holder;      // who leads, or did last
    std::string session_id;  // likewise
    Utime until = 0;         // the lease runs out, the claim or the listening is over
    Utime say_at = 0;        // again: held, claimed, or given back
    Utime say_until = 0;     // that it was given back
  };
  using Order = std::tuple<int64_t, LeaseHolder>;

  void TickOne(const std::string& user, Entry& entry, Utime now);
  void Hear(const msg::Lease& lease, Entry& entry, Utime now);
  void HearRival(const msg::Lease& lease, Entry& entry, Utime now);
  void Follow(const msg::Lease& lease, Entry& entry, Utime now);
  void BeginClaim(const std::string& user, Entry& entry, bool has_scene, Utime wait, Utime now);
  void Win(const std::string& user, Entry& entry, Utime now);
  void Say(const std::string& user, const Entry& entry, Utime remaining);
  /// Others may claim too.
  bool HasRivals(Utime now) const;
  bool IsMine(LeaseState state) const;
  Entry* Make(const std::string& user);

  const LeaseHolder self_;
  const LeaseConfig config_;
  std::map<std::string, Entry> entries_;  // by user
  std::vector<LeaseNews> news_;
  Utime ticked_;
  Utime listening_since_;
  Utime peer_heard_;
  int64_t term_ = 0;
};

}  // namespace beckon::intention
