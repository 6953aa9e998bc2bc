// A conversation that several services on one bus are ready to hold (docs/protocol.md, "Several
// machines"): heard and spoken by the one that leads it, followed by the others, one of which takes
// over when the leader falls silent. A service that is alone leads at once.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "services/intention/core/conversation.h"
#include "services/intention/core/lease.h"

namespace beckon::intention {

struct LeadCounters {
  int64_t taken_over = 0;  // sessions of a leader that fell silent
  int64_t yielded = 0;     // leases and claims that went to another
};

class LedConversation {
 public:
  /// `steady` paces leases: it never goes back, and counts on while the machine sleeps. Everything
  /// passed by reference must outlive this.
  LedConversation(const LeaseHolder& self, const Clock& steady, const Affordances& affordances,
                  const Policy& policy, Memory& memory, const ConversationConfig& config = {},
                  const LeaseConfig& lease_config = {});

  /// As Conversation's.
  Actions Recover(Utime now);
  Actions OnScene(const msg::Scene& scene, Utime now);
  Actions OnPoses(const msg::Poses& poses, Utime now);
  Actions OnInterface(const msg::Interface& announced, Utime now);
  Actions OnTaskStatus(const msg::TaskStatus& status, Utime now);
  Actions OnAnswer(const msg::Answer& answer, Utime now);
  /// Requests of front ends, events of other services.
  Actions OnSession(const msg::Session& message, Utime now);
  /// Another service's, or our own.
  Actions OnTask(const msg::Task& task, Utime now);
  Actions OnLease(const msg::Lease& lease, Utime now);
  /// Any sign of life of another intention service.
  void HearPeer() { leases_.HearPeer(steady_.Now()); }
  /// Call every 50 ms.
  Actions Tick(Utime now);

  const Conversation& conversation() const { return conversation_; }
  const Leases& leases() const { return leases_; }
  const LeadCounters& counters() const { return counters_; }
  /// As in seal_t.
  const std::string& sender() const { return sender_; }

 private:
  void OnRequest(const msg::Session& request, Utime now);
  void OnStart(const msg::Session& request, Utime now);
  void OnEvent(const msg::Session& event, Utime now);
  /// Another service says so.
  void OnStoppedElsewhere(const msg::Session& event, Utime now);
  void OnEnd(const msg::Session& event);
  void HearNews(Utime now);
  void Hear(const msg::Lease& lease, Utime now);
  void Hear(const LeaseWon& won, Utime now);
  void Hear(const LeaseLost& lost, Utime now);
  void Hear(const LeaseOrphaned& orphaned, Utime now);
  /// What the conversation wants said, but for what is another's to say.
  void Say(Actions actions);
  bool IsOursToSay(const Outgoing& message) const;
  bool IsLedByOther(const std::string& user) const;
  /// Puts everything in order after an event.
  Actions Settled(Utime now);

  const std::string sender_;
  const Clock& steady_;
  Leases leases_;
  Conversation conversation_;
  Actions actions_;
  LeadCounters counters_;
  std::map<std::string, msg::Session> starts_;  // the latest request of a user
  std::set<std::string> orphans_;               // users whose session is to be taken over
  Utime quiet_until_;   // another leads conversations: it says how things are
  Utime deaf_to_stop_;  // of others: they may not have heard of "resume" yet
};

}  // namespace beckon::intention
