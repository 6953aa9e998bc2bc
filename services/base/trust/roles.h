// Who may say what: each kind of message belongs to a role, each key has roles.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/result.h"

namespace beckon::trust {

enum class Role : uint8_t {
  kPerception = 1,
  kIntention = 2,
  kFrontEnd = 4,
  kRobot = 8,
  kDecoder = 16
};
inline constexpr std::array<std::pair<Role, const char*>, 5> kRoleNames = {
    {{Role::kPerception, "perception"},
     {Role::kIntention, "intention"},
     {Role::kFrontEnd, "front-end"},
     {Role::kRobot, "robot"},
     {Role::kDecoder, "decoder"}}};

/// Any number of roles.
class Roles {
 public:
  Roles() = default;
  static Roles All();
  /// From names; the error lists them.
  static Result<Roles> FromNames(const std::vector<std::string>& names);
  std::vector<std::string> Names() const;
  void Add(Role role) { bits_ |= static_cast<uint8_t>(role); }
  bool Has(Role role) const { return (bits_ & static_cast<uint8_t>(role)) != 0; }
  bool HasAnyOf(Roles others) const { return (bits_ & others.bits_) != 0; }
  friend bool operator==(const Roles&, const Roles&) = default;

 private:
  uint8_t bits_ = 0;
};

/// What a message asks of whoever sent it.
struct Demand {
  Roles one_of;             // the key must have one of these
  bool may_last = false;    // holds without expiry: idempotent, or safe whenever it comes
  bool may_repeat = false;  // a copy is as good as the first
};

Demand DemandOf(const msg::Scene& scene);
Demand DemandOf(const msg::Poses& poses);
Demand DemandOf(const msg::Interface& interface);
Demand DemandOf(const msg::Query& query);
Demand DemandOf(const msg::Answer& answer);
/// Requests are a front end's, events intention's. A request to stop is anybody's whose key is
/// known, late or repeated: refusing one would be the greater danger.
Demand DemandOf(const msg::Session& session);
Demand DemandOf(const msg::Task& task);
/// The robot's, but that a task expired or was revoked also intention may say.
Demand DemandOf(const msg::TaskStatus& status);
Demand DemandOf(const msg::Label& label);
Demand DemandOf(const msg::Profile& profile);
Demand DemandOf(const msg::Highlight& highlight);
Demand DemandOf(const msg::Stimulus& stimulus);
Demand DemandOf(const msg::Decoding& decoding);
/// History and leases have no expiry, since machines whose clocks differ share them too.
Demand DemandOf(const msg::History& history);
Demand DemandOf(const msg::Lease& lease);

}  // namespace beckon::trust
