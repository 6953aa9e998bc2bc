#include "services/intention/core/conversation.h"

#include <algorithm>

#include "services/intention/core/conversation_talk.h"

namespace beckon::intention {
namespace {

constexpr char kSessionChannel[] = "BECKON_SESSION";
constexpr char kAnswerChannel[] = "BECKON_ANSWER";

/// Requests remembered to know duplicates by.
constexpr size_t kRememberedRequests = 64;

}  // namespace

Conversation::Conversation(const Affordances& affordances, const Policy& policy, Memory& memory,
                           const ConversationConfig& config, MayAct may_act)
    : affordances_(affordances),
      policy_(policy),
      memory_(memory),
      config_(config),
      may_act_(std::move(may_act)) {}

Conversation::~Conversation() = default;

Actions Conversation::Taken() { return std::exchange(actions_, {}); }

void Conversation::Refuse(const std::string& channel, const std::string& reason,
                          const std::string& detail) {
  ++counters_.refused;
  actions_.push_back(Refused{channel, reason, detail});
}

msg::Session Conversation::Event(msg::SessionKind kind, Utime now) const {
  msg::Session event;
  event.utime = now;
  event.kind = kind;
  return event;
}

void Conversation::Announce(const msg::Session& event, Utime now) {
  latest_ = event;
  latest_announced_ = now;
  actions_.push_back(event);
}

void Conversation::AnnounceRunning(Talk& talk, Utime now) {
  msg::Session event = Event(msg::SessionKind::kBegun, now);
  event.session_id = talk.session_id;
  event.user = talk.user;
  event.questions = talk.interview ? talk.interview->questions() : 0;
  event.text = talk.waits_for;
  talk.announced = now;
  actions_.push_back(event);
}

bool Conversation::Seen(const msg::Session& request) {
  const RequestIdentity identity{request.kind, request.session_id, request.device, request.utime};
  if (std::find(seen_.begin(), seen_.end(), identity) != seen_.end()) return true;
  seen_.push_back(identity);
  if (seen_.size() > kRememberedRequests) seen_.pop_front();
  return false;
}

const msg::Session* Conversation::Ended(const std::string& session_id) const {
  for (const msg::Session& event : ended_) {
    if (event.session_id == session_id) return &event;
  }
  return nullptr;
}

Conversation::Talk* Conversation::Find(const msg::Session& request) {
  const auto found = talks_.find(request.user);
  if (found == talks_.end() || found->second->session_id != request.session_id) return nullptr;
  return found->second.get();
}

void Conversation::Advance(Talk& talk, Utime now) {
  TellLabels(talk, now);
  Put(talk, now);
}

void Conversation::Put(Talk& talk, Utime now) {
  const Interview::Outcome& outcome = talk.interview->outcome();
  if (const auto* accepted = std::get_if<AcceptedTask>(&outcome))
    return Confirm(talk, *accepted, now);
  if (const auto* gave_up = std::get_if<GaveUp>(&outcome)) {
    if (gave_up->unclear && talk.interview->StartOver()) {
      talk.notice += Finished(config_.phrases.start_again) + " ";
      return Put(talk, now);
    }
    const std::string notice = std::exchange(talk.notice, {});
    const bool bare = std::ranges::all_of(talk.table->objects(), &Followed::gone);
    if (!bare) return Abandon(talk, notice + gave_up->text, now, true);
    talk.query.reset();
    return WaitFor(talk, notice + Finished(config_.phrases.waiting_for_objects), now);
  }
  if (talk.query && talk.put == talk.interview->put()) return;  // it still stands
  if (!std::exchange(talk.waits_for, {}).empty()) AnnounceRunning(talk, now);
  msg::Query query = std::get<msg::Query>(outcome);
  query.utime = now;
  query.id = last_query_id_ = std::max(last_query_id_ + 1, now);
  query.session_id = talk.session_id;
  query.user = talk.user;
  query.text = std::exchange(talk.notice, {}) + query.text;
  query.scene_seq = talk.table->seq();
  query.questions_asked = talk.interview->questions();
  talk.put = talk.interview->put();
  talk.query = query;
  talk.query_sent = now;
  actions_.push_back(std::move(query));
}

Actions Conversation::OnAnswer(const msg::Answer& answer, Utime now) {
  const auto found = std::find_if(talks_.begin(), talks_.end(), [&](const auto& entry) {
    return entry.second->query && entry.second->query->id == answer.query_id &&
           entry.second->session_id == answer.session_id;
  });
  if (found == talks_.end()) {
    ++counters_.stale_answers;
    actions_.push_back(Refused{
        kAnswerChannel, refusal::kStale,
        "answer to query " + std::to_string(answer.query_id) + ", which is not the current one"});
    if (const msg::Session* ended = Ended(answer.session_id)) actions_.push_back(*ended);
    return Taken();
  }
  Talk& talk = *found->second;
  if (Status right = CheckLikelihoods(answer.likelihoods, talk.query->options.size()); !right) {
    Refuse(kAnswerChannel, refusal::kMalformed,
           "answer to query " + std::to_string(answer.query_id) + ": " + right.error().message);
    return Taken();
  }
  ++counters_.answers;
  talk.interview->Answer(answer.likelihoods, answer.device);
  Advance(talk, now);
  return Taken();
}

Actions Conversation::OnSession(const msg::Session& request, Utime now) {
  using Kind = msg::SessionKind;
  switch (request.kind) {
    case Kind::kRequestStart:
      Start(request, now);
      return Taken();
    case Kind::kRequestStop:
      Stop(request, now);
      return Taken();
    case Kind::kRequestResume:
      Resume(request, now);
      return Taken();
    case Kind::kRequestProfile:
      if (profiled_.size() < msg::kMaxUsers) profiled_[request.user] = false;
      TellProfile(request.user, now);
      return Taken();
    case Kind::kRequestCancel:
    case Kind::kRequestUndo:
    case Kind::kRequestNoneOfThese:
      break;
    default:
      return Taken();  // an event, our own
  }
  Talk* talk = Find(request);
  if (talk == nullptr) {
    if (const msg::Session* ended = Ended(request.session_id)) {
      actions_.push_back(*ended);
    } else {
      Refuse(kSessionChannel, refusal::kStale,
             "request for session '" + request.session_id + "', which does not run");
    }
    return Taken();
  }
  if (request.kind == Kind::kRequestCancel) {
    Abandon(*talk, Finished(config_.phrases.cancelled), now, false);
    return Taken();
  }
  if (!talk->interview || Seen(request)) return Taken();
  if (request.kind == Kind::kRequestNoneOfThese) {
    ++counters_.answers;
    talk->interview->NoneOfThese(request.device);
  } else if (!talk->interview->Undo()) {
    return Taken();
  }
  Advance(*talk, now);
  return Taken();
}

}  // namespace beckon::intention
