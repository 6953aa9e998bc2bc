// The course of trials: what the decoder is to decode now, what its word is worth, and when that is
// an answer. Also what is asked while no question stands: whether to stop, to go on after a stop or
// a pause, to begin another task. A state machine: events in with the time, messages out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/base/utime.h"
#include "services/ui_bridge/bci/evidence.h"
#include "services/ui_bridge/bci/fusion.h"
#include "services/ui_bridge/bci/layout.h"
#include "services/ui_bridge/bci/stopping.h"

namespace beckon::ui_bridge::bci {

struct TrialsConfig {
  LayoutConfig layout;
  StoppingConfig stopping;
  StopWatchConfig stop_watch;
  std::string decoder;          // the one that counts; empty: the first that is heard
  double read_s = 1.5;          // s, >= 0, to read a question before its first trial
  double pause_s = 0.3;         // s, >= 0, between trials
  double trial_timeout_s = 10;  // s, > 0, without a decoding: the trial is lost
  double rest_s = 10;           // s, >= 0, before "another task?" and "go on?" are asked again
  bool invite = true;           // ask "another task?" when one is done
};

/// What trials want done.
class TrialsOutput {
 public:
  virtual ~TrialsOutput() = default;
  /// utime: when the trial began, by the time that was passed in.
  virtual void Stimulate(const msg::Stimulus& stimulus) = 0;
  /// `trials`: the probabilities behind it, as received.
  virtual void Answer(const msg::Query& query, const std::vector<double>& likelihoods,
                      const std::vector<std::vector<double>>& trials) = 0;
  virtual void Request(msg::SessionKind request) = 0;
  virtual void ShowNotice(const std::string& text) = 0;
  /// How to read a decoder that is heard for the first time, or again after another.
  virtual DecoderModel ModelOf(const std::string& decoder) = 0;
};

enum class Asking {
  kNothing,
  kWatch,     // only whether to stop
  kQuestion,  // that of intention
  kInvite,    // another task?
  kPaused,    // go on after a pause?
  kResume     // go on after a stop?
};

/// Why a decoding was refused.
enum class Refusal { kForeign, kStale, kDuplicate, kOtherDecoder, kMalformed };
/// The key by which it is counted (services/base/refusal.h).
const char* ReasonOf(Refusal why);
struct Refused {
  Refusal why;
  std::string detail;
};

struct TrialCounters {
  int64_t trials = 0;   // begun
  int64_t decoded = 0;  // taken
  int64_t lost = 0;     // without a decoding
  int64_t refused = 0;  // decodings
  int64_t answers = 0;
  int64_t stops = 0;  // by the decoder
};

/// Times are those of one clock that never goes back. Not thread-safe.
class Trials {
 public:
  /// `device`: of this front end. Trials are numbered from `first_trial` (>= 1), which has to be
  /// above all numbers of an earlier run. `config` as Check(config.layout) wants it. `output` must
  /// outlive this.
  Trials(const TrialsConfig& config, std::string device, int64_t first_trial, TrialsOutput& output);

  /// A session was asked for, and is not announced yet.
  void Requested() { requested_ = true; }
  void Present(const msg::Query& query, Utime now);
  void Withdraw(Utime now);
  void OnSession(msg::SessionKind event, Utime now);
  /// Nothing: it was taken.
  std::optional<Refused> OnDecoding(const msg::Decoding& decoding, Utime now);
  /// Call at least every 50 ms.
  void Tick(Utime now);

  /// By hand (a carer). Each is obeyed before it returns.
  void Stop(Utime now);
  void TogglePause(Utime now);

  /// The decoder was calibrated anew; counts from the next trial on.
  void SetModel(const DecoderModel& model) { model_ = model; }

  Asking asking() const { return asking_; }
  /// What is asked now, in words.
  std::string Text() const;
  const Layout& layout() const { return layout_; }
  /// P(class) after the trials so far.
  std::vector<double> Posterior() const { return fusion_.Posterior(layout_.prior); }
  int repetitions() const { return fusion_.trials(); }
  /// Of the current trial; 0 where none runs.
  int64_t trial() const { return trial_ ? trial_->stimulus.trial : 0; }
  /// When it began.
  Utime trial_began() const { return trial_ ? trial_->stimulus.utime : 0; }
  const std::string& decoder() const { return decoder_; }
  bool silent() const { return silent_; }
  bool answered() const { return answered_; }
  const TrialCounters& counters() const { return counters_; }

 private:
  struct Trial {
    msg::Stimulus stimulus;
    Utime sent;
  };

  /// What is to be asked in the present state.
  Asking Wanted() const;
  /// Drops what runs and begins what is wanted, its first trial after `delay_us`.
  void Begin(Utime now, Utime delay_us);
  void BeginWanted(Utime now);
  void LayOutOwn(const char* first, const char* second, double first_prior);
  void StartTrial(Utime now);
  std::optional<Refused> Check(const msg::Decoding& decoding) const;
  void Take(const msg::Decoding& decoding, Utime now);
  void Decide(Utime now);
  void DecideInvite(bool wanted, Utime now);
  void DecidePaused(bool wanted, Utime now);
  void DecideResume(size_t likeliest, bool sure, Utime now);
  void AskOwnLater(Utime now);
  void Answer(Utime now);
  void Obey(Control control, Utime now);
  bool Watches() const { return ClassOf(config_.layout, Control::kStop).has_value(); }

  const TrialsConfig config_;
  const std::string device_;
  TrialsOutput& output_;

  std::optional<msg::Query> query_;
  bool fits_ = true;               // the question on the classes
  bool answered_ = false;          // or taken back by undo; nothing more is said about it
  std::optional<Utime> retry_at_;  // ask it again, where undo came to nothing
  bool stopped_ = false;
  bool stopping_ = false;  // stop was requested and is not announced yet
  bool paused_ = false;
  bool in_session_ = false;
  bool requested_ = false;
  Utime rest_until_ = 0;     // nothing of our own is asked before
  bool confirming_ = false;  // "go on" was said once after a stop

  Asking asking_ = Asking::kNothing;
  int64_t asked_ = 0;  // query id, where it is a question
  Layout layout_;
  Fusion fusion_;
  std::vector<std::vector<double>> received_;  // of the question asked now
  StopWatch stop_watch_;
  std::optional<Trial> trial_;
  Utime next_trial_ = 0;
  int64_t last_trial_;
  int64_t decoded_trial_ = 0;  // the latest that was decoded
  std::string decoder_;
  DecoderModel model_;
  bool silent_ = false;
  TrialCounters counters_;
};

}  // namespace beckon::ui_bridge::bci
