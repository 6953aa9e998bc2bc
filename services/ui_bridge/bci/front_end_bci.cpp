// Front end "bci": asks a decoder of brain signals, trial by trial (STIMULUS, DECODING), until it
// is known well enough what the user means. For people who look on it writes to the terminal.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "services/base/app.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/bci/bci_config.h"
#include "services/ui_bridge/bci/bci_text.h"
#include "services/ui_bridge/bci/decoders.h"
#include "services/ui_bridge/bci/line_reader.h"
#include "services/ui_bridge/bci/lsl_source.h"
#include "services/ui_bridge/bci/session_trials.h"
#include "services/ui_bridge/bci/trials.h"
#include "services/ui_bridge/front_end.h"

namespace beckon::ui_bridge {
namespace {

using namespace bci;

constexpr Utime kTick_us = 20'000;
constexpr char kDecodingChannel[] = "BECKON_DECODING";

class BciFrontEnd final : public FrontEnd, private TrialsOutput {
 public:
  BciFrontEnd(const BciConfig& config, const FrontEndSetup& setup, std::optional<LslLibrary> lsl)
      : config_(config),
        setup_(setup),
        lsl_library_(lsl),
        decoders_(config, config.calibration_dir.empty() ? DataFile("bci") : config.calibration_dir,
                  setup.user),
        trials_(config.trials, setup.device, clock_.Now(), *this) {
    LogWarnings();
  }
  ~BciFrontEnd() override {
    if (tick_) setup_.loop.Cancel(*tick_);
  }

  msg::Interface Announce() const override { return decoders_.interface(); }

  void Begin() override {
    if (isatty(STDIN_FILENO) == 1) Print(RenderKeys());
    keys_.emplace(setup_.loop, STDIN_FILENO, [this](const std::string& line) { Type(line); });
    setup_.bus.Subscribe<msg::Decoding>([this](const msg::Decoding& decoding) { Hear(decoding); });
    if (lsl_library_) ListenToLsl();
    tick_ = setup_.loop.Every(kTick_us, [this] {
      trials_.Tick(steady_.Now());
      ShowAsked();
    });
    AskForSession();
  }

  void Present(const msg::Query& query) override {
    if (query.session_id != session_id_) session_trials_.Forget();
    session_id_ = query.session_id;
    trials_.Present(query, steady_.Now());
    ShowAsked();
  }

  void Withdraw() override { trials_.Withdraw(steady_.Now()); }

  void ShowSession(const msg::Session& event) override {
    using Kind = msg::SessionKind;
    trials_.OnSession(event.kind, steady_.Now());
    Print(RenderEvent(event));
    if (event.kind == Kind::kBegun) in_session_ = true;
    const bool stopped = event.kind == Kind::kStopped;
    if (stopped || event.kind == Kind::kAbandoned) session_trials_.Forget();
    if (event.kind == Kind::kIdle && setup_.exit_after_sessions > 0 && !in_session_)
      AskForSession();  // after a stop
    const bool over = stopped || event.kind == Kind::kConfirmed || event.kind == Kind::kAbandoned;
    if (!over || !std::exchange(in_session_, false) || stopped) return;
    if (++sessions_ == setup_.exit_after_sessions) return End();
    if (setup_.exit_after_sessions > 0) AskForSession();
  }

  void ShowNotice(const std::string& text) override { Print(text + "\n"); }
  void ShowScene(const msg::Scene& scene) override {
    if (run_.IsAnother(scene)) session_trials_.Renumbered();
  }
  void ShowTask(const msg::Task& task) override {
    auto known = session_trials_.Confirm(task);
    if (!config_.learn || known.empty()) return;
    trials_.SetModel(decoders_.Learn(std::move(known)));
    LogWarnings();
  }
  void ShowTaskStatus(const msg::TaskStatus& status) override {
    if (!status.text.empty()) Print("Robot: " + status.text + "\n");
  }
  void ShowUser(const std::string& user) override {
    decoders_.SetUser(user);
    LogWarnings();
    session_trials_.Forget();
    if (!trials_.decoder().empty()) trials_.SetModel(decoders_.Choose(trials_.decoder()));
  }

  std::string State() const override {
    const TrialCounters& c = trials_.counters();
    const std::string text = trials_.Text();
    const std::string decoder = trials_.decoder().empty() ? "no decoder yet" : trials_.decoder();
    return "bci: " + (text.empty() ? "nothing asked" : "'" + text + "'") + "; " + decoder +
           (trials_.silent() ? ", silent" : "") + "; trials " + std::to_string(c.decoded) +
           " decoded, " + std::to_string(c.lost) + " lost, " + std::to_string(c.refused) +
           " decodings refused";
  }

 private:
  // TrialsOutput
  void Stimulate(const msg::Stimulus& stimulus) override {
    msg::Stimulus stamped = stimulus;
    stamped.utime = clock_.Now() - (steady_.Now() - stimulus.utime);
    stamped.seal.sender = setup_.device;
    if (auto sent = setup_.bus.Publish(stamped); !sent) spdlog::error("{}", sent.error().message);
  }
  void Answer(const msg::Query& query, const std::vector<double>& likelihoods,
              const std::vector<std::vector<double>>& trials) override {
    session_trials_.Add(query, trials);
    Print(RenderAnswer(query, likelihoods));
    setup_.sink.Answer(query.id, likelihoods);
  }
  void Request(msg::SessionKind request) override { setup_.sink.Request(request); }
  DecoderModel ModelOf(const std::string& decoder) override {
    const DecoderModel model = decoders_.Choose(decoder);
    LogWarnings();
    return model;
  }

  void Hear(const msg::Decoding& decoding) {
    const Utime began = trials_.trial_began(), now = steady_.Now();
    if (const auto refused = trials_.OnDecoding(decoding, now))
      return setup_.bus.Refuse(kDecodingChannel, ReasonOf(refused->why), refused->detail);
    decoders_.Time(static_cast<double>(now - began) / kSecond);
    if (trials_.repetitions() > 0 && trials_.asking() != Asking::kWatch)
      Print(RenderPosterior(trials_.layout(), trials_.Posterior(), trials_.repetitions()));
    ShowAsked();
  }

  void ListenToLsl() {
    lsl_.emplace(*lsl_library_, config_.lsl, setup_.loop,
                 LslSource::Handlers{.sample = [this](const LslSample& sample) { HearLsl(sample); },
                                     .stream =
                                         [this](bool found) {
                                           ShowNotice("The LSL stream '" + config_.lsl + "' is " +
                                                      (found ? "there." : "gone."));
                                         }});
  }

  /// k probabilities are of the trial in which they were recorded; k + 1 channels: the last says
  /// which trial.
  void HearLsl(const LslSample& sample) {
    msg::Decoding decoding;
    decoding.decoder = "lsl:" + config_.lsl;
    decoding.device = setup_.device;
    decoding.probabilities = sample.channels;
    const size_t classes = Classes(config_.trials.layout);
    if (sample.channels.size() == classes + 1) {
      const double trial = sample.channels.back();
      decoding.trial = trial >= 1 && trial < 0x1p53 ? static_cast<int64_t>(trial) : 0;
      decoding.probabilities.pop_back();
    } else {
      const auto age_us = static_cast<Utime>(std::min(sample.age_s, 1e6) * 1e6);
      if (trials_.trial() != 0 && steady_.Now() - age_us >= trials_.trial_began())
        decoding.trial = trials_.trial();
    }
    Hear(decoding);
  }

  void Type(const std::string& line) {
    switch (ParseKey(line)) {
      case Key::kStop:
        return trials_.Stop(steady_.Now());
      case Key::kResume:
        return setup_.sink.Request(msg::SessionKind::kRequestResume);
      case Key::kUndo:
        return setup_.sink.Request(msg::SessionKind::kRequestUndo);
      case Key::kPause:
        return trials_.TogglePause(steady_.Now());
      case Key::kNew:
        if (!in_session_ && !ended_) AskForSession();
        return;
      case Key::kQuit:
        setup_.sink.Request(msg::SessionKind::kRequestCancel);
        return End();
      default:
        return Print("'" + line.substr(0, 40) + "'? " + RenderKeys());
    }
  }

  void AskForSession() {
    trials_.Requested();
    setup_.sink.Request(msg::SessionKind::kRequestStart);
  }

  void End() {
    if (!std::exchange(ended_, true)) setup_.sink.Finish();
  }

  /// What is asked, once each time that it changes.
  void ShowAsked() {
    const std::string text = trials_.Text();
    const std::string asked = text.empty() ? "" : RenderAsked(text, trials_.layout());
    if (asked == shown_) return;
    shown_ = asked;
    Print(asked);
  }

  void LogWarnings() {
    for (const auto& warning : decoders_.TakeWarnings()) spdlog::warn("bci: {}", warning);
  }

  static void Print(const std::string& text) {
    if (text.empty()) return;
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  }

  const BciConfig config_;
  const FrontEndSetup setup_;
  const std::optional<LslLibrary> lsl_library_;
  const SystemClock clock_;
  const SteadyClock steady_;
  Decoders decoders_;
  Trials trials_;
  SessionTrials session_trials_;
  RunWatch run_;
  std::optional<LineReader> keys_;
  std::optional<LslSource> lsl_;
  std::optional<RunLoop::TimerId> tick_;
  std::string session_id_;
  std::string shown_;
  bool in_session_ = false;
  bool ended_ = false;
  int sessions_ = 0;
};

class BciFactory final : public FrontEndFactory {
 public:
  std::string name() const override { return "bci"; }
  std::string summary() const override {
    return "a decoder of brain signals, by the messages STIMULUS and DECODING or from LSL";
  }

  void AddOptions(CLI::App& app) override {
    auto* group = app.add_option_group("bci", "Options of the front end for brain signals");
    group->add_option("--bci-decoder", decoder_, "The decoder that counts (default: the first)")
        ->type_name("NAME");
    group->add_option("--lsl", lsl_, "Read class probabilities from this LSL stream")
        ->type_name("STREAM");
  }

  void Configure(ConfigTable table) override { ReadConfig(std::move(table), config_); }

  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    BciConfig config = config_;
    if (!decoder_.empty()) config.trials.decoder = decoder_;
    if (!lsl_.empty()) config.lsl = lsl_;
    std::optional<LslLibrary> library;
    if (!config.lsl.empty()) {
      auto loaded = LoadLsl(config.lsl_library);
      if (!loaded) return loaded.error();
      library = *loaded;
    }
    return std::unique_ptr<FrontEnd>(std::make_unique<BciFrontEnd>(config, setup, library));
  }

 private:
  BciConfig config_;
  std::string decoder_;
  std::string lsl_;
};

const FrontEndRegistration kRegistration([]() -> std::unique_ptr<FrontEndFactory> {
  return std::make_unique<BciFactory>();
});

}  // namespace
}  // namespace beckon::ui_bridge
