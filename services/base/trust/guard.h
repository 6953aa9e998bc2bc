// Signs what leaves a process and checks what comes in, where the machine has keys.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>

#include "services/base/trust/counter.h"
#include "services/base/trust/key_folder.h"
#include "services/base/trust/replay_window.h"
#include "services/base/utime.h"

namespace beckon::trust {

/// Why a message is not to be believed. `reason` is a key of refusal.h.
struct Rejection {
  std::string reason;
  std::string detail;
};

class Guard {
 public:
  /// So many senders of one key are told apart; a further one is refused.
  static constexpr size_t kMostSenders = 64;

  /// `counter_file` outlives the process, so that a clock that was put back does not make it mute.
  /// Both clocks must outlive the guard; `steady` paces looking for changed keys.
  Guard(KeyFolder folder, OwnKey own, const std::string& counter_file, const Clock& clock,
        const Clock& steady);

  const Node& own() const { return own_.node; }
  size_t trusted() const { return trusted_.size(); }

  /// Counter, expiry (unless it is set, or the message lasts) and key; the signature comes last.
  void Stamp(msg::Seal& seal, bool may_last);
  void Sign(std::span<uint8_t> encoded) const { own_.secret.Sign(encoded); }

  /// Nothing where `encoded`, whose seal is `seal`, may be believed. Cheap reasons first; what is
  /// refused changes nothing.
  std::optional<Rejection> Check(const std::string& channel, const msg::Seal& seal,
                                 const Demand& demand, std::span<const uint8_t> encoded);

 private:
  void LookForChanges();
  ReplayWindow* WindowOf(const std::string& channel, const msg::Seal& seal);

  const KeyFolder folder_;
  const OwnKey own_;
  Counter counter_;
  const Clock& clock_;
  const Clock& steady_;
  Utime looked_at_ = 0;
  uint64_t version_ = 0;
  std::map<KeyId, Node> trusted_;
  std::map<KeyId, std::string> revoked_;
  std::map<KeyId, std::map<std::pair<std::string, std::string>, ReplayWindow>>
      windows_;  // sender, channel
};

}  // namespace beckon::trust
