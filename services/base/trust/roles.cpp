#include "services/base/trust/roles.h"

#include <algorithm>

namespace beckon::trust {
namespace {

Demand Of(std::initializer_list<Role> roles) {
  Demand demand;
  for (const Role role : roles) demand.one_of.Add(role);
  return demand;
}

Demand Lasting(Demand demand) {
  demand.may_last = true;
  return demand;
}

}  // namespace

Roles Roles::All() {
  Roles all;
  for (const auto& [role, name] : kRoleNames) all.Add(role);
  return all;
}

Result<Roles> Roles::FromNames(const std::vector<std::string>& names) {
  Roles roles;
  for (const auto& name : names) {
    const auto* known =
        std::ranges::find_if(kRoleNames, [&](const auto& pair) { return name == pair.second; });
    if (known == kRoleNames.end()) {
      std::string expected;
      for (const auto& [role, text] : kRoleNames)
        expected += (expected.empty() ? "" : ", ") + std::string(text);
      return Error{"'" + name + "' is no role; expected some of " + expected};
    }
    roles.Add(known->first);
  }
  return roles;
}

std::vector<std::string> Roles::Names() const {
  std::vector<std::string> names;
  for (const auto& [role, name] : kRoleNames) {
    if (Has(role)) names.emplace_back(name);
  }
  return names;
}

Demand DemandOf(const msg::Scene&) { return Of({Role::kPerception}); }
Demand DemandOf(const msg::Poses&) { return Of({Role::kPerception}); }
Demand DemandOf(const msg::Interface&) { return Of({Role::kFrontEnd}); }
Demand DemandOf(const msg::Query&) { return Of({Role::kIntention}); }
Demand DemandOf(const msg::Answer&) { return Of({Role::kFrontEnd}); }
Demand DemandOf(const msg::Task&) { return Of({Role::kIntention}); }
Demand DemandOf(const msg::Label&) { return Of({Role::kIntention}); }
Demand DemandOf(const msg::Profile&) { return Of({Role::kIntention}); }
Demand DemandOf(const msg::Highlight&) { return Of({Role::kFrontEnd}); }
Demand DemandOf(const msg::Stimulus&) { return Of({Role::kFrontEnd}); }
Demand DemandOf(const msg::Decoding&) { return Of({Role::kDecoder}); }
Demand DemandOf(const msg::History&) {
  // A copied disk has the same key and the same sender, and its counters may lag behind.
  Demand demand = Lasting(Of({Role::kIntention}));
  demand.may_repeat = true;
  return demand;
}
Demand DemandOf(const msg::Lease&) { return Lasting(Of({Role::kIntention})); }

Demand DemandOf(const msg::Session& session) {
  if (session.kind == msg::SessionKind::kRequestStop)
    return {.one_of = Roles::All(), .may_last = true, .may_repeat = true};
  return Of({session.kind < msg::SessionKind::kIdle ? Role::kFrontEnd : Role::kIntention});
}

Demand DemandOf(const msg::TaskStatus& status) {
  if (status.state == msg::TaskState::kExpired || status.state == msg::TaskState::kRevoked)
    return Of({Role::kRobot, Role::kIntention});
  return Of({Role::kRobot});
}

}  // namespace beckon::trust
