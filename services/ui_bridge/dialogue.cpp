#include "services/ui_bridge/dialogue.h"

#include <algorithm>
#include <utility>

namespace beckon::ui_bridge {
namespace {

constexpr size_t kEndedKept = 32;
/// More that are said at once are left out.
constexpr size_t kMostChanges = 16;

bool IsEvent(msg::SessionKind kind) { return kind >= msg::SessionKind::kIdle; }

}  // namespace

Dialogue::Dialogue(DialogueConfig config, const Clock& clock, const Clock& steady,
                   std::function<std::string()> new_session_id, DialogueOutput& output)
    : config_(std::move(config)),
      clock_(clock),
      steady_(steady),
      new_session_id_(std::move(new_session_id)),
      output_(output),
      listen_until_(steady.Now() + config_.listen_us),
      heard_(steady.Now()),
      ours_heard_(steady.Now()) {}

void Dialogue::Tick() {
  const Utime now = steady_.Now();
  if (wanted_ && phase_ == Phase::kIdle && now >= listen_until_) BeginRequesting();
  for (auto* repeated : {&start_, &control_, &change_}) {
    if (*repeated && now >= (*repeated)->due) {
      (*repeated)->due = now + config_.repeat_us;
      output_.Send((*repeated)->message);
    }
  }
  if (answer_ && now >= answer_->due) {
    answer_->due = now + config_.repeat_us;
    output_.Send(answer_->message);
  }
  CheckLost(now);
  if (!silent_ && now - heard_ > config_.silence_us) {
    silent_ = true;
    output_.ShowNotice("Nothing is heard of the intention service; waiting for it.");
  }
}

void Dialogue::OnQuery(const msg::Query& query) {
  if (query.user != config_.user) return;
  heard_ = steady_.Now();
  silent_ = false;
  if (query.session_id == session_id_) ours_heard_ = heard_;
  if (phase_ == Phase::kStopped || Stopping() || cancelled_ || HasEnded(query.session_id)) return;
  if (phase_ != Phase::kRunning || query.session_id != session_id_) Join(query.session_id);
  if (!presented_.insert(query.id).second) return;
  leader_ = query.seal.sender;
  answer_.reset();
  query_ = query;
  output_.Present(query);
  HearCount(query.questions_asked);
}

void Dialogue::OnSession(const msg::Session& event) {
  if (!IsEvent(event.kind)) return;
  heard_ = steady_.Now();
  silent_ = false;
  // Stopping is for everybody; IDLE names nobody or speaks to one user; the rest is one user's.
  const bool ours = event.user == config_.user;
  const bool everybody = event.kind == msg::SessionKind::kStopped ||
                         (event.kind == msg::SessionKind::kIdle && event.user.empty());
  if (!ours && !everybody) return;
  switch (event.kind) {
    case msg::SessionKind::kIdle:
      return IsBystander(event) ? void() : OnIdle(event);
    case msg::SessionKind::kConfirmed:
    case msg::SessionKind::kAbandoned:
      return OnEnd(event);
    case msg::SessionKind::kStopped:
      if (Stopping()) control_.reset();
      phase_ = Phase::kStopped;
      leader_ = event.seal.sender;
      LayDown();
      return ShowOnce(event);
    default:
      break;
  }
  // BEGUN
  if (Stopping() || HasEnded(event.session_id)) return;
  if (control_ && control_->message.kind == msg::SessionKind::kRequestResume) control_.reset();
  if (phase_ != Phase::kRunning || event.session_id != session_id_) Join(event.session_id);
  ours_heard_ = heard_;
  // The one that asked is silent, or yielded: another leads, and asks anew.
  leader_ = event.seal.sender;
  if (query_ && query_->seal.sender != leader_) DropQuery();
  if (answer_ && query_ && event.questions > query_->questions_asked) answer_.reset();
  // It waits for something, and asks anew when that is there.
  if (query_ && !event.text.empty() && event.utime > query_->utime) DropQuery();
  HearCount(event.questions);
  ShowOnce(event);
}

bool Dialogue::IsBystander(const msg::Session& idle) const {
  if (leader_.empty() || idle.seal.sender == leader_ || !idle.user.empty()) return false;
  const bool resuming = control_ && control_->message.kind == msg::SessionKind::kRequestResume;
  return !resuming && !(phase_ == Phase::kRequesting && cancelled_);
}

void Dialogue::OnIdle(const msg::Session& event) {
  if (control_ && control_->message.kind == msg::SessionKind::kRequestResume) control_.reset();
  switch (phase_) {
    case Phase::kRunning:
      if (cancelled_) {
        End();
        break;
      }
      // Intention came back without our session: it was not committed. The same id makes the
      // request safe where it was.
      output_.ShowNotice("The conversation was interrupted; it starts over.");
      DropQuery();
      presented_.clear();
      BeginRequesting();
      return;
    case Phase::kStopped:
      End();
      break;
    case Phase::kRequesting:
      if (!cancelled_) return;
      End();
      break;
    case Phase::kIdle:
      break;
  }
  ShowOnce(event);
}

/// Intention that came back may have other things to say than IDLE: that another session, or one of
/// another user, is confirmed.
void Dialogue::CheckLost(Utime now) {
  if (phase_ != Phase::kRunning || Stopping() || heard_ - ours_heard_ <= config_.lost_us) return;
  ours_heard_ = now;
  msg::Session idle;
  idle.utime = clock_.Now();
  idle.user = config_.user;
  idle.kind = msg::SessionKind::kIdle;
  OnIdle(idle);
}

void Dialogue::OnEnd(const msg::Session& event) {
  const bool resumed = control_ && control_->message.kind == msg::SessionKind::kRequestResume;
  if (phase_ == Phase::kIdle || (event.session_id != session_id_ && !resumed)) return;
  if (resumed) control_.reset();
  End();
  leader_ = event.seal.sender;
  ShowOnce(event);
}

void Dialogue::Start() {
  if (Stopping()) return;
  wanted_ = true;
  Tick();
}

void Dialogue::Answer(int64_t query_id, const std::vector<double>& likelihoods) {
  if (phase_ != Phase::kRunning || !query_ || query_->id != query_id || cancelled_) return;
  if (change_ || Stopping()) return;
  msg::Answer answer;
  answer.utime = clock_.Now();
  answer.query_id = query_id;
  answer.session_id = session_id_;
  answer.device = config_.device;
  answer.likelihoods = likelihoods;
  output_.Send(answer);
  answer_ = {std::move(answer), steady_.Now() + config_.repeat_us};
}

void Dialogue::Undo() { Change(msg::SessionKind::kRequestUndo); }

void Dialogue::NoneOfThese() {
  if (query_ && query_->kind == msg::QueryKind::kWhatIsIt) {
    // There it is the last option, an answer like any other.
    std::vector<double> likelihoods(query_->options.size(), 0.0);
    likelihoods.back() = 1;
    return Answer(query_->id, likelihoods);
  }
  Change(msg::SessionKind::kRequestNoneOfThese);
}

void Dialogue::Change(msg::SessionKind kind) {
  if (phase_ != Phase::kRunning || cancelled_ || Stopping()) return;
  if (changes_.size() >= kMostChanges) return;
  changes_.push_back(kind);
  SendNextChange();
}

void Dialogue::SendNextChange() {
  if (change_ || answer_ || changes_.empty()) return;
  const msg::SessionKind kind = changes_.front();
  changes_.pop_front();
  const msg::Session request = Request(kind);
  output_.Send(request);
  // With nothing to take back no count will ever tell that it arrived.
  const bool nothing = kind == msg::SessionKind::kRequestUndo && questions_ == 0;
  if (!nothing) change_ = {request, steady_.Now() + config_.repeat_us};
}

void Dialogue::HearCount(int questions) {
  if (std::exchange(questions_, questions) != questions) change_.reset();
  SendNextChange();
}

void Dialogue::Cancel() {
  wanted_ = false;
  if (phase_ == Phase::kIdle || phase_ == Phase::kStopped) return;
  cancelled_ = true;
  start_.reset();
  DropQuery();
  ForgetChanges();
  Insist(msg::SessionKind::kRequestCancel);
}

void Dialogue::ChangeUser(const std::string& user) {
  if (user == next_user_.value_or(config_.user)) return;
  next_user_ = user;
  Cancel();
  if (phase_ == Phase::kIdle || phase_ == Phase::kStopped) TakeNextUser();
}

void Dialogue::TakeNextUser() {
  if (!next_user_) return;
  config_.user = *std::exchange(next_user_, std::nullopt);
  output_.ShowUser(config_.user);
}

void Dialogue::Stop() {
  Insist(msg::SessionKind::kRequestStop);
  LayDown();
}

void Dialogue::Resume() {
  if (phase_ == Phase::kStopped) Insist(msg::SessionKind::kRequestResume);
}

bool Dialogue::Stopping() const {
  return control_ && control_->message.kind == msg::SessionKind::kRequestStop;
}

void Dialogue::LayDown() {
  start_.reset();
  wanted_ = false;
  DropQuery();
  ForgetChanges();
}

void Dialogue::Insist(msg::SessionKind kind) {
  if (Stopping() && kind != msg::SessionKind::kRequestStop) return;  // stopping goes first
  control_ = {Request(kind), steady_.Now() + config_.repeat_us};
  output_.Send(control_->message);
}

void Dialogue::BeginRequesting() {
  if (phase_ != Phase::kRunning || session_id_.empty()) session_id_ = new_session_id_();
  phase_ = Phase::kRequesting;
  presented_.clear();
  ForgetChanges();
  start_ = {Request(msg::SessionKind::kRequestStart), steady_.Now() + config_.repeat_us};
  output_.Send(start_->message);
}

void Dialogue::Join(const std::string& session_id) {
  DropQuery();
  ForgetChanges();
  presented_.clear();
  start_.reset();
  if (session_id != session_id_ && cancelled_) {
    cancelled_ = false;
    control_.reset();
  }
  session_id_ = session_id;
  phase_ = Phase::kRunning;
  ours_heard_ = heard_;
  wanted_ = false;
}

void Dialogue::End() {
  DropQuery();
  ForgetChanges();
  presented_.clear();
  start_.reset();
  if (control_ && control_->message.kind == msg::SessionKind::kRequestCancel) control_.reset();
  cancelled_ = false;
  wanted_ = false;
  phase_ = Phase::kIdle;
  if (!session_id_.empty()) ended_.push_back(std::exchange(session_id_, {}));
  if (ended_.size() > kEndedKept) ended_.pop_front();
  TakeNextUser();
}

void Dialogue::ForgetChanges() {
  changes_.clear();
  change_.reset();
  questions_ = 0;
}

void Dialogue::DropQuery() {
  answer_.reset();
  if (!query_) return;
  query_.reset();
  output_.Withdraw();
}

void Dialogue::ShowOnce(const msg::Session& event) {
  if (shown_ && shown_->kind == event.kind && shown_->session_id == event.session_id &&
      shown_->text == event.text) {
    return;
  }
  shown_ = event;
  output_.ShowSession(event);
}

bool Dialogue::HasEnded(const std::string& session_id) const {
  return std::ranges::find(ended_, session_id) != ended_.end();
}

msg::Session Dialogue::Request(msg::SessionKind kind) const {
  msg::Session request;
  request.utime = clock_.Now();
  request.session_id = session_id_;
  request.user = config_.user;
  request.device = config_.device;
  request.kind = kind;
  return request;
}

}  // namespace beckon::ui_bridge
