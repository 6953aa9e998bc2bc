#include "services/ui_bridge/bci/trials.h"

#include <algorithm>
#include <utility>

#include "services/base/refusal.h"

namespace beckon::ui_bridge::bci {
namespace {

constexpr Utime kResend_us = 200'000;
constexpr Utime kBeforeWatch_us = kSecond;  // the next question is likelier
constexpr Utime kUndoPatience_us = 3 * kSecond;
constexpr double kInvitePrior = 0.3;
constexpr double kGoOnPrior = 0.1;
/// Nobody goes on by chance: a decoder that is at rest is not to lead out of a stop.
constexpr double kResumePrior = 0.02;

Utime Microseconds(double seconds) { return static_cast<Utime>(seconds * 1e6); }

}  // namespace

Trials::Trials(const TrialsConfig& config, std::string device, int64_t first_trial,
               TrialsOutput& output)
    : config_(config),
      device_(std::move(device)),
      output_(output),
      stop_watch_(config.stop_watch),
      last_trial_(first_trial - 1) {}

void Trials::Present(const msg::Query& query, Utime now) {
  query_ = query;
  answered_ = false;
  retry_at_.reset();
  const auto layout = LayOut(config_.layout, query);
  fits_ = layout.ok();
  if (!fits_) output_.ShowNotice("This is " + layout.error().message + ".");
  if (Wanted() == Asking::kQuestion || !fits_) Begin(now, Microseconds(config_.read_s));
}

void Trials::Withdraw(Utime now) {
  query_.reset();
  answered_ = false;
  retry_at_.reset();
  BeginWanted(now);
}

void Trials::OnSession(msg::SessionKind event, Utime now) {
  using Kind = msg::SessionKind;
  const bool was_stopped = std::exchange(stopped_, event == Kind::kStopped);
  // Intention came back and knows nothing; the start is asked for again.
  if (event == Kind::kIdle) requested_ = requested_ || in_session_;
  if (event != Kind::kIdle) requested_ = false;
  in_session_ = event == Kind::kBegun;
  if (event == Kind::kStopped || event == Kind::kIdle || event == Kind::kBegun) stopping_ = false;
  if (!in_session_) query_.reset();
  confirming_ = false;
  if (event != Kind::kBegun) rest_until_ = now + Microseconds(config_.rest_s);
  if (was_stopped != stopped_) paused_ = false;
  BeginWanted(now);
}

Asking Trials::Wanted() const {
  if (stopping_) return Asking::kNothing;
  if (stopped_) return Asking::kResume;
  if (paused_) return Asking::kPaused;
  if (query_ && fits_ && !answered_) return Asking::kQuestion;
  if (!in_session_ && !requested_ && config_.invite) return Asking::kInvite;
  return Watches() ? Asking::kWatch : Asking::kNothing;
}

void Trials::BeginWanted(Utime now) {
  if (Wanted() == asking_ && (asking_ != Asking::kQuestion || asked_ == query_->id)) return;
  Begin(now, kBeforeWatch_us);
}

void Trials::Begin(Utime now, Utime delay_us) {
  asking_ = Wanted();
  if (asking_ == Asking::kInvite && now < rest_until_)
    asking_ = Watches() ? Asking::kWatch : Asking::kNothing;
  trial_.reset();
  received_.clear();
  next_trial_ = now + delay_us;
  if (asking_ == Asking::kResume) next_trial_ = std::max(next_trial_, rest_until_);
  switch (asking_) {
    case Asking::kQuestion:
      layout_ = *LayOut(config_.layout, *query_);
      asked_ = query_->id;
      break;
    case Asking::kInvite:
      LayOutOwn("Another task", "Not now", kInvitePrior);
      break;
    case Asking::kPaused:
      LayOutOwn("Go on", "Not yet", kGoOnPrior);
      break;
    case Asking::kResume:
      confirming_ ? LayOutOwn("Stay stopped", "Yes, go on", 1 - kResumePrior)
                  : LayOutOwn("Go on", "Stay stopped", kResumePrior);
      break;
    default:
      layout_ = LayOut(config_.layout, std::vector<std::string>(), 0);
  }
  fusion_ = Fusion(layout_.labels.size());
}

void Trials::LayOutOwn(const char* first, const char* second, double first_prior) {
  layout_ = LayOut(config_.layout, {first, second}, first_prior);
}

std::string Trials::Text() const {
  switch (asking_) {
    case Asking::kQuestion:
      return query_->text;
    case Asking::kInvite:
      return "Another task?";
    case Asking::kPaused:
      return "Paused. Go on?";
    case Asking::kResume:
      return confirming_ ? "Really go on?" : "Everything is stopped. Go on?";
    default:
      return "";
  }
}

void Trials::Tick(Utime now) {
  if (retry_at_ && now >= *retry_at_) {
    retry_at_.reset();
    answered_ = false;
    BeginWanted(now);
  }
  if (asking_ == Asking::kWatch || asking_ == Asking::kNothing) {
    if (Wanted() != asking_ && (Wanted() != Asking::kInvite || now >= rest_until_)) Begin(now, 0);
  }
  if (asking_ == Asking::kNothing) return;
  if (!trial_) {
    if (now >= next_trial_) StartTrial(now);
    return;
  }
  if (now - trial_->stimulus.utime >= Microseconds(config_.trial_timeout_s)) {
    ++counters_.lost;
    if (!std::exchange(silent_, true)) {
      output_.ShowNotice("Nothing comes from the decoder" +
                         (decoder_.empty() ? "" : " '" + decoder_ + "'") + ".");
    }
    StartTrial(now);
  } else if (now - trial_->sent >= kResend_us) {
    trial_->sent = now;
    output_.Stimulate(trial_->stimulus);
  }
}

void Trials::StartTrial(Utime now) {
  msg::Stimulus stimulus;
  stimulus.utime = now;
  stimulus.device = device_;
  stimulus.trial = ++last_trial_;
  stimulus.query_id = asking_ == Asking::kQuestion ? query_->id : 0;
  stimulus.repetition = fusion_.trials() + 1;
  stimulus.mode = layout_.mode;
  stimulus.rows = layout_.rows;
  stimulus.columns = layout_.columns;
  stimulus.labels = layout_.labels;
  trial_ = Trial{stimulus, now};
  ++counters_.trials;
  output_.Stimulate(stimulus);
}

const char* ReasonOf(Refusal why) {
  switch (why) {
    case Refusal::kForeign:
    case Refusal::kOtherDecoder:
      return refusal::kForeign;
    case Refusal::kStale:
      return refusal::kStale;
    case Refusal::kDuplicate:
      return refusal::kDuplicate;
    case Refusal::kMalformed:
      break;
  }
  return refusal::kMalformed;
}

std::optional<Refused> Trials::Check(const msg::Decoding& decoding) const {
  const std::string trial = "trial " + std::to_string(decoding.trial);
  if (decoding.device != device_)
    return Refused{Refusal::kForeign,
                   trial + " is of another front end, '" + decoding.device + "'"};
  const bool other = config_.decoder.empty() ? !decoder_.empty() && decoding.decoder != decoder_
                                             : decoding.decoder != config_.decoder;
  // One that is not there any more may be replaced.
  if (other && !(config_.decoder.empty() && silent_)) {
    return Refused{Refusal::kOtherDecoder,
                   trial + " by '" + decoding.decoder + "': '" +
                       (config_.decoder.empty() ? decoder_ : config_.decoder) + "' counts"};
  }
  if (decoded_trial_ != 0 && decoding.trial == decoded_trial_)
    return Refused{Refusal::kDuplicate, trial + " was decoded already"};
  if (!trial_ || decoding.trial != trial_->stimulus.trial) {
    return Refused{Refusal::kStale,
                   trial + " is not the current one, " + std::to_string(this->trial())};
  }
  if (auto right = CheckProbabilities(decoding.probabilities, layout_.labels.size()); !right)
    return Refused{Refusal::kMalformed, trial + ": " + right.error().message};
  return std::nullopt;
}

std::optional<Refused> Trials::OnDecoding(const msg::Decoding& decoding, Utime now) {
  auto refused = Check(decoding);
  if (refused) {
    ++counters_.refused;
    return refused;
  }
  if (std::exchange(silent_, false)) output_.ShowNotice("The decoder is back.");
  if (decoding.decoder != decoder_) {
    decoder_ = decoding.decoder;
    model_ = output_.ModelOf(decoder_);
  }
  Take(decoding, now);
  return std::nullopt;
}

void Trials::Take(const msg::Decoding& decoding, Utime now) {
  ++counters_.decoded;
  decoded_trial_ = decoding.trial;
  trial_.reset();
  next_trial_ = now + Microseconds(config_.pause_s);
  const auto logs = LogLikelihoods(decoding.probabilities, model_);
  const auto stop = ClassOf(config_.layout, Control::kStop);
  if (stop && !stopped_ &&
      stop_watch_.Hear(logs, *stop, model_.gap, asking_ == Asking::kQuestion)) {
    ++counters_.stops;
    return Stop(now);
  }
  if (asking_ == Asking::kWatch) return;
  fusion_.Add(logs);
  received_.push_back(decoding.probabilities);
  Decide(now);
}

void Trials::Decide(Utime now) {
  const auto posterior = Posterior();
  const Verdict verdict = ShouldStop(config_.stopping, posterior, layout_.ends, fusion_.trials());
  if (verdict == Verdict::kNotYet) return;
  const bool sure = verdict == Verdict::kSure;
  const auto likeliest =
      static_cast<size_t>(std::max_element(posterior.begin(), posterior.end()) - posterior.begin());
  switch (asking_) {
    case Asking::kQuestion:
      if (sure && layout_.controls[likeliest]) return Obey(*layout_.controls[likeliest], now);
      return Answer(now);
    case Asking::kInvite:
      return DecideInvite(sure && likeliest == 0, now);
    case Asking::kPaused:
      return DecidePaused(sure && likeliest == 0, now);
    case Asking::kResume:
      return DecideResume(likeliest, sure, now);
    default:
      return;
  }
}

void Trials::Answer(Utime now) {
  const auto likelihoods = fusion_.Likelihoods(layout_.options);
  const auto trials = std::exchange(received_, {});
  const msg::Query query = *query_;
  answered_ = true;
  ++counters_.answers;
  Begin(now, kBeforeWatch_us);
  output_.Answer(query, likelihoods, trials);  // last: the next question may come from within
}

void Trials::DecideInvite(bool wanted, Utime now) {
  if (!wanted) return AskOwnLater(now);
  requested_ = true;
  Begin(now, kBeforeWatch_us);
  output_.Request(msg::SessionKind::kRequestStart);
}

void Trials::DecidePaused(bool wanted, Utime now) {
  if (!wanted) return AskOwnLater(now);
  paused_ = false;
  Begin(now, Microseconds(config_.read_s));
}

void Trials::DecideResume(size_t likeliest, bool sure, Utime now) {
  // The second time it is in another place: a class that is always decoded does not go on.
  const bool wanted = sure && likeliest == (confirming_ ? 1 : 0);
  if (!wanted) {
    confirming_ = false;
    return AskOwnLater(now);
  }
  if (!std::exchange(confirming_, true)) return Begin(now, Microseconds(config_.read_s));
  confirming_ = false;
  AskOwnLater(now);
  output_.Request(msg::SessionKind::kRequestResume);
}

void Trials::AskOwnLater(Utime now) {
  rest_until_ = now + Microseconds(config_.rest_s);
  Begin(now, asking_ == Asking::kInvite ? kBeforeWatch_us : Microseconds(config_.rest_s));
}

void Trials::Obey(Control control, Utime now) {
  switch (control) {
    case Control::kStop:
      return Stop(now);
    case Control::kPause:
      return TogglePause(now);
    case Control::kUndo:
      answered_ = true;
      retry_at_ = now + kUndoPatience_us;
      Begin(now, kBeforeWatch_us);
      return output_.Request(msg::SessionKind::kRequestUndo);
  }
}

void Trials::Stop(Utime now) {
  output_.Request(msg::SessionKind::kRequestStop);
  stopping_ = !stopped_;
  stop_watch_.Reset();
  answered_ = true;
  Begin(now, kBeforeWatch_us);
}

void Trials::TogglePause(Utime now) {
  if (stopped_ || stopping_) return;
  paused_ = !paused_;
  Begin(now, Microseconds(config_.read_s));
}

}  // namespace beckon::ui_bridge::bci
