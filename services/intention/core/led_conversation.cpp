#include "services/intention/core/led_conversation.h"

#include <utility>

namespace beckon::intention {
namespace {

constexpr size_t kMostStarts = 256;
/// Since another spoke of a conversation that it leads or led: they repeat it once a second.
constexpr Utime kQuiet = 3 * kSecond;
/// Since "resume": whoever missed nothing has said STOPPED for the last time by then.
constexpr Utime kResumeSpreads = 3 * kSecond / 2;

using Kind = msg::SessionKind;

}  // namespace

LedConversation::LedConversation(const LeaseHolder& self, const Clock& steady,
                                 const Affordances& affordances, const Policy& policy,
                                 Memory& memory, const ConversationConfig& config,
                                 const LeaseConfig& lease_config)
    : sender_(self.machine + "/intention"),
      steady_(steady),
      leases_(self, steady.Now(), lease_config),
      // Asks the clock anew: between question and deed the process may have stood still.
      conversation_(affordances, policy, memory, config,
                    [this](const std::string& user) { return leases_.Holds(user, steady_.Now()); }),
      quiet_until_(steady.Now()),
      deaf_to_stop_(steady.Now()) {}

Actions LedConversation::Recover(Utime now) {
  Say(conversation_.Recover(now));
  return Settled(now);
}

Actions LedConversation::OnScene(const msg::Scene& scene, Utime now) {
  leases_.Tick(steady_.Now());
  Say(conversation_.OnScene(scene, now));
  return Settled(now);
}

Actions LedConversation::OnPoses(const msg::Poses& poses, Utime now) {
  leases_.Tick(steady_.Now());
  Say(conversation_.OnPoses(poses, now));
  return Settled(now);
}

Actions LedConversation::OnInterface(const msg::Interface& announced, Utime now) {
  Say(conversation_.OnInterface(announced, now));
  return Settled(now);
}

Actions LedConversation::OnTaskStatus(const msg::TaskStatus& status, Utime now) {
  Say(conversation_.OnTaskStatus(status, now));
  return Settled(now);
}

Actions LedConversation::OnAnswer(const msg::Answer& answer, Utime now) {
  leases_.Tick(steady_.Now());
  const auto user = conversation_.UserOf(answer.session_id);
  const bool ours =
      user ? leases_.Holds(*user, steady_.Now()) : !leases_.IsElsewhere(answer.session_id);
  if (ours) Say(conversation_.OnAnswer(answer, now));
  return Settled(now);
}

Actions LedConversation::OnSession(const msg::Session& message, Utime now) {
  leases_.Tick(steady_.Now());
  if (message.kind < Kind::kIdle) {
    OnRequest(message, now);
  } else if (message.seal.sender != sender_) {
    OnEvent(message, now);
  }
  return Settled(now);
}

Actions LedConversation::OnTask(const msg::Task& task, Utime now) {
  leases_.Tick(steady_.Now());
  if (task.seal.sender != sender_) {
    msg::Session end;
    end.utime = task.utime;
    end.kind = Kind::kConfirmed;
    end.session_id = task.task_id;
    end.user = task.user;
    end.questions = task.questions;
    end.text = conversation_.DoneText(task);
    OnEnd(end);
  }
  return Settled(now);
}

Actions LedConversation::OnLease(const msg::Lease& lease, Utime now) {
  leases_.Tick(steady_.Now());
  if (lease.remaining_ms > 0 && lease.seal.sender != sender_) quiet_until_ = steady_.Now() + kQuiet;
  if (!leases_.OnLease(lease, steady_.Now())) {
    actions_.push_back(Refused{"BECKON_LEASE", refusal::kMalformed,
                               "a term of " + std::to_string(lease.term) + " for '" + lease.user +
                                   "' is more than any service claims"});
  }
  return Settled(now);
}

Actions LedConversation::Tick(Utime now) {
  leases_.Tick(steady_.Now());
  HearNews(now);
  Say(conversation_.Tick(now));
  return Settled(now);
}

void LedConversation::OnRequest(const msg::Session& request, Utime now) {
  const bool was_stopped = conversation_.stopped();
  switch (request.kind) {
    case Kind::kRequestStart:
      OnStart(request, now);
      break;
    case Kind::kRequestStop:  // everybody stops, and stays so
      Say(conversation_.OnSession(request, now));
      break;
    case Kind::kRequestResume:
      quiet_until_ = steady_.Now();  // front ends wait for all that stopped
      Say(conversation_.OnSession(request, now));
      if (was_stopped && !conversation_.stopped()) deaf_to_stop_ = steady_.Now() + kResumeSpreads;
      break;
    case Kind::kRequestProfile:
      if (!IsLedByOther(request.user)) Say(conversation_.OnSession(request, now));
      break;
    default:
      if (leases_.IsElsewhere(request.user, request.session_id)) break;
      if (leases_.Holds(request.user, steady_.Now()) || !IsLedByOther(request.user))
        Say(conversation_.OnSession(request, now));
      // A claim for a session that nobody wants any more.
      if (request.kind == Kind::kRequestCancel &&
          leases_.Claims(request.user, request.session_id) && !conversation_.Runs(request.user))
        leases_.GiveBack(request.user, steady_.Now());
  }
}

void LedConversation::OnStart(const msg::Session& request, Utime now) {
  if (starts_.size() < kMostStarts || starts_.contains(request.user))
    starts_.insert_or_assign(request.user, request);
  switch (leases_.StateOf(request.user)) {
    case LeaseState::kHeld:
      return Say(conversation_.OnSession(request, now));
    case LeaseState::kFree:
      // What is over is told without a lease.
      if (conversation_.stopped() || conversation_.IsOver(request.session_id))
        return Say(conversation_.OnSession(request, now));
      return leases_.Claim(request.user, request.session_id, conversation_.HasScene(now),
                           steady_.Now());
    default:
      return;  // whoever leads answers; front ends repeat it
  }
}

void LedConversation::OnEvent(const msg::Session& event, Utime now) {
  HearPeer();
  if (event.kind == Kind::kStopped) return OnStoppedElsewhere(event, now);
  if (event.kind == Kind::kIdle) return;
  quiet_until_ = steady_.Now() + kQuiet;
  if (event.kind != Kind::kBegun) OnEnd(event);
}

void LedConversation::OnStoppedElsewhere(const msg::Session& event, Utime now) {
  if (conversation_.stopped() || steady_.Now() < deaf_to_stop_) return;
  msg::Session request = event;
  request.kind = Kind::kRequestStop;
  Say(conversation_.OnSession(request, now));
}

void LedConversation::OnEnd(const msg::Session& event) {
  conversation_.NoteEnd(event);
  // Ended by a machine that had it before, and came back.
  if (conversation_.UserOf(event.session_id) == event.user) conversation_.Withdraw(event.user);
}

void LedConversation::HearNews(Utime now) {
  for (auto news = leases_.Taken(); !news.empty(); news = leases_.Taken()) {
    for (const LeaseNews& one : news) {
      std::visit([&](const auto& what) { Hear(what, now); }, one);
    }
  }
}

void LedConversation::Hear(const msg::Lease& lease, Utime now) {
  msg::Lease stamped = lease;
  stamped.utime = now;
  actions_.push_back(std::move(stamped));
}

void LedConversation::Hear(const LeaseWon& won, Utime now) {
  const bool orphan = orphans_.erase(won.user) > 0;
  if (conversation_.Runs(won.user)) return;  // it was ours, and is again
  msg::Session request;
  const auto start = starts_.find(won.user);
  if (start != starts_.end() && start->second.session_id == won.session_id) request = start->second;
  request.kind = Kind::kRequestStart;
  request.user = won.user;
  request.session_id = won.session_id;
  if (!orphan) return Say(conversation_.OnSession(request, now));
  Say(conversation_.TakeOver(request, now));
  counters_.taken_over += conversation_.Runs(won.user) ? 1 : 0;
}

void LedConversation::Hear(const LeaseLost& lost, Utime) {
  ++counters_.yielded;
  orphans_.erase(lost.user);
  conversation_.Withdraw(lost.user);
}

void LedConversation::Hear(const LeaseOrphaned& orphaned, Utime now) {
  if (conversation_.stopped() || conversation_.IsOver(orphaned.session_id)) return;
  orphans_.insert(orphaned.user);
  leases_.Claim(orphaned.user, orphaned.session_id, conversation_.HasScene(now), steady_.Now());
}

bool LedConversation::IsLedByOther(const std::string& user) const {
  switch (leases_.StateOf(user)) {
    case LeaseState::kFree:
    case LeaseState::kHeld:
      return false;
    default:
      return true;  // or may be
  }
}

bool LedConversation::IsOursToSay(const Outgoing& message) const {
  if (const auto* query = std::get_if<msg::Query>(&message))
    return leases_.Holds(query->user, steady_.Now());
  if (const auto* label = std::get_if<msg::Label>(&message)) return !IsLedByOther(label->user);
  const auto* event = std::get_if<msg::Session>(&message);
  if (event == nullptr || event->kind == Kind::kStopped) return true;
  if (event->kind == Kind::kIdle) return steady_.Now() >= quiet_until_;
  return !IsLedByOther(event->user);
}

void LedConversation::Say(Actions actions) {
  for (Outgoing& one : actions) {
    if (IsOursToSay(one)) actions_.push_back(std::move(one));
  }
}

Actions LedConversation::Settled(Utime now) {
  HearNews(now);
  for (const std::string& user : leases_.Held()) {
    if (!conversation_.Runs(user)) leases_.GiveBack(user, steady_.Now());
  }
  HearNews(now);
  return std::exchange(actions_, {});
}

}  // namespace beckon::intention
