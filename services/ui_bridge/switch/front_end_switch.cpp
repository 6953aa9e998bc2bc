// Front end "switch": scanning for a person with one working muscle, on an evdev device or a key of
// the terminal, seen and heard.
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/front_end.h"
#include "services/ui_bridge/scan/reaction.h"
#include "services/ui_bridge/scan/scanner.h"
#include "services/ui_bridge/switch/switch_config.h"
#include "services/ui_bridge/switch/switch_output.h"
#include "services/ui_bridge/switch/switch_pages.h"
#include "services/ui_bridge/switch/terminal_keys.h"

namespace beckon::ui_bridge {
namespace {

constexpr Utime kKeyRepeat_us = 700'000;  // a terminal's keys begin to repeat within this

class SwitchFrontEnd final : public FrontEnd, private SwitchListener {
 public:
  SwitchFrontEnd(const SwitchConfig& config, const FrontEndSetup& setup)
      : config_(config),
        setup_(setup),
        user_(setup.user),
        output_(config.audio, config.voice, setup.loop),
        scanner_(config.scan) {
    MeasureSeconds();
  }
  ~SwitchFrontEnd() override {
    for (const auto& timer : {tick_, beat_}) {
      if (timer) setup_.loop.Cancel(*timer);
    }
  }

  msg::Interface Announce() const override {
    msg::Interface interface;
    interface.kind = msg::InterfaceKind::kScan;
    interface.max_options = config_.max_options;
    interface.seconds_per_question = static_cast<float>(seconds_.per_question);
    interface.seconds_per_option = static_cast<float>(seconds_.per_option);
    interface.false_yes = static_cast<float>(config_.false_yes);
    interface.false_no = static_cast<float>(config_.false_no);
    return interface;
  }

  void Begin() override {
    if (TellsRelease(config_)) {
      for (const auto& device : EventDevices(config_)) {
        sources_.push_back(MakeEventDevice(device, setup_.loop, *this));
      }
    } else {
      sources_.push_back(MakeTerminalKeys(setup_.loop, *this));
      output_.Line("Space is the switch, Enter the second one; s stops.");
    }
    for (auto& source : sources_) source->Start();
    beat_ = setup_.loop.Every(kSecond, [this] { PublishHighlight(); });
    ShowPage();
    setup_.sink.Request(msg::SessionKind::kRequestStart);
  }

  void Present(const msg::Query& query) override {
    query_ = query;
    between_ = false;
    shown_.reset();
    output_.Ask(query);
    ShowPage();
  }

  void Withdraw() override {
    query_.reset();
    ShowPage();
  }

  void ShowSession(const msg::Session& event) override {
    const bool stopped = event.kind == msg::SessionKind::kStopped;
    // Until intention has heard of a stop of ours, what it says is older than that.
    if (stopped) stop_on_its_way_ = false;
    stopped_ = stopped;
    if (!stop_on_its_way_) scanner_.SetStopped(steady_.Now(), stopped);
    if (const std::string text = SessionWords(event); !text.empty()) output_.Tell(text);
    if (event.kind == msg::SessionKind::kBegun) {
      in_session_ = true;
      between_ = false;
    }
    const bool over = event.kind == msg::SessionKind::kConfirmed ||
                      event.kind == msg::SessionKind::kAbandoned ||
                      event.kind == msg::SessionKind::kIdle;
    if (over && std::exchange(in_session_, false)) AfterSession();
    ShowPage();
  }

  void ShowNotice(const std::string& text) override {
    output_.Tell(text);
    Refresh();
  }

  void ShowTaskStatus(const msg::TaskStatus& status) override { ShowNotice(TaskWords(status)); }

  void ShowUser(const std::string& user) override {
    user_ = user;
    reactions_ = scan::ReactionTimes();  // somebody else's
  }

  std::string State() const override {
    std::string state = scanner_.stopped() ? "stopped"
                        : query_ ? "scans question " + std::to_string(query_->questions_asked + 1)
                        : in_session_ ? "waits for a question"
                                      : "waits for a conversation";
    for (const auto& source : sources_) {
      if (const std::string source_state = source->State(); source_state != "ok") {
        state += "; switch: " + source_state;
      }
    }
    return state;
  }

 private:
  // SwitchListener
  void OnEdge(Utime at, scan::Switch which, bool down) override {
    Do(scanner_.OnSwitch(at, which, down));
  }
  void OnClick(Utime at, scan::Switch which) override { Do(scanner_.OnClick(at, which)); }
  void OnStopKey() override {
    const Utime now = steady_.Now();
    Stop();
    scanner_.SetStopped(now, true);
    Refresh();
  }
  void OnRelease(Utime at) override {
    scanner_.ReleaseAll(at);
    Refresh();
  }
  void OnSourceNotice(const std::string& text) override { ShowNotice(text); }

  void Do(const std::vector<scan::Action>& actions) {
    using Kind = scan::Action::Kind;
    for (const auto& action : actions) {
      reactions_.Add(action.reaction_us);
      switch (action.kind) {
        case Kind::kStop:
          Stop();
          break;
        case Kind::kChoose:
          Choose(action);
          break;
        case Kind::kControl:
          Use(action.control);
          break;
        case Kind::kResume:
          stop_on_its_way_ = false;
          setup_.sink.Request(msg::SessionKind::kRequestResume);
          output_.Tell("Resuming.");
          break;
        case Kind::kRest:
          output_.Tell("Resting; press to go on.");
          break;
        case Kind::kOpen:
        case Kind::kBack:
        case Kind::kWake:
          break;
      }
    }
    Refresh();
  }

  void Stop() {
    setup_.sink.Request(msg::SessionKind::kRequestStop);
    // Where it is stopped already, intention has nothing new to say.
    stop_on_its_way_ = !stopped_;
    output_.Tell("STOP.");
  }

  void Choose(const scan::Action& action) {
    if (!query_ || query_->id != action.page) return;
    const auto option = static_cast<size_t>(action.option);
    setup_.sink.Answer(query_->id, OneHot(option, query_->options.size()));
    output_.Line("=> " + query_->options[option].text);
    reactions_.Chosen();
    chose_last_ = true;
  }

  void Use(scan::Control control) {
    using scan::Control;
    switch (control) {
      case Control::kUndo:
        setup_.sink.Request(msg::SessionKind::kRequestUndo);
        if (std::exchange(chose_last_, false)) reactions_.Undone();
        return output_.Line("=> Undo");
      case Control::kNone:
        setup_.sink.Request(msg::SessionKind::kRequestNoneOfThese);
        return output_.Line("=> None of these");
      case Control::kStart:
        between_ = false;
        setup_.sink.Request(msg::SessionKind::kRequestStart);
        return ShowPage();
      case Control::kAccept:
      case Control::kKeep:
        return DecideSuggestion(control == Control::kAccept);
      default:
        return;
    }
  }

  void AfterSession() {
    chose_last_ = false;
    if (++sessions_ == setup_.exit_after_sessions) return setup_.sink.Finish();
    between_ = true;
    const scan::Config& scan = scanner_.config();
    if (config_.suggest && scan.method == scan::Method::kAutomatic) {
      suggestion_ = reactions_.Suggest(scan.scan_us);
    }
    if (suggestion_) output_.Tell(SuggestionWords(*suggestion_, scan.scan_us));
  }

  void DecideSuggestion(bool accepted) {
    if (!suggestion_) return;
    reactions_.Asked();
    if (accepted) {
      scan::Config scan = scanner_.config();
      scan.scan_us = suggestion_->scan_us;
      scanner_.SetConfig(steady_.Now(), scan);
      reactions_.ScanTimeChanged();
      MeasureSeconds();
      output_.Tell("The pointer moves every " + SecondsWords(scan.scan_us) +
                   " s now; scan_time in [switch] keeps it.");
    }
    suggestion_.reset();
    ShowPage();
  }

  void MeasureSeconds() { seconds_ = scan::FitSeconds(scanner_.config(), config_.max_options); }

  /// What there is to choose now. A question that was answered is not shown again.
  void ShowPage() {
    using scan::Control;
    scan::Page page;
    if (query_) {
      if (shown_ == query_->id) return Refresh();
      page = QuestionPage(*query_, config_.audio ? config_.seconds_a_letter : 0);
    } else if (between_ && suggestion_) {
      page.controls = {Control::kAccept, Control::kKeep, Control::kStop};
    } else if (between_) {
      page.controls = {Control::kStart, Control::kStop};
    } else if (!TellsRelease(config_) || config_.scan.stop_hold_us == 0) {
      page.controls = {Control::kStop};  // who cannot hold needs another way
    }
    const std::vector<Control> controls = page.controls;
    if (!query_ && shown_ == kControlPage && controls == controls_) return Refresh();
    shown_ = page.id;
    controls_ = controls;
    scanner_.Show(steady_.Now(), page);
    Refresh();
  }

  /// Brings screen, voice, bus and timer up to what the scanner says.
  void Refresh() {
    if (output_.Draw(scanner_.view(), query_ ? &*query_ : nullptr)) PublishHighlight();
    if (tick_) setup_.loop.Cancel(*std::exchange(tick_, std::nullopt));
    const auto due = scanner_.NextDeadline();
    if (!due) return;
    tick_ = setup_.loop.After(std::max<Utime>(1, *due - steady_.Now()), [this] {
      tick_.reset();
      Do(scanner_.Tick(steady_.Now()));
    });
  }

  void PublishHighlight() {
    msg::Highlight highlight =
        HighlightOf(scanner_.view(), query_ && scanner_.view().page == query_->id);
    highlight.utime = clock_.Now();
    highlight.device = setup_.device;
    highlight.user = user_;
    if (const Status sent = setup_.bus.Publish(highlight); !sent) {
      output_.Line("What is lit could not be told: " + sent.error().message);
    }
  }

  const SwitchConfig config_;
  const FrontEndSetup setup_;
  const SteadyClock steady_;
  const SystemClock clock_;
  std::string user_;
  SwitchOutput output_;
  std::vector<std::unique_ptr<SwitchSource>> sources_;
  scan::Scanner scanner_;
  scan::ScanSeconds seconds_;
  scan::ReactionTimes reactions_;
  std::optional<scan::ScanSuggestion> suggestion_;
  std::optional<RunLoop::TimerId> tick_;
  std::optional<RunLoop::TimerId> beat_;

  std::optional<msg::Query> query_;
  std::optional<int64_t> shown_;  // page of the scanner
  std::vector<scan::Control> controls_;
  bool in_session_ = false;
  bool between_ = false;          // a session is over and the next was not asked for
  bool stopped_ = false;          // as intention said last
  bool stop_on_its_way_ = false;  // ours, that it has not heard of yet
  bool chose_last_ = false;       // the last thing done was to choose an option
  int sessions_ = 0;
};

class SwitchFactory final : public FrontEndFactory {
 public:
  std::string name() const override { return "switch"; }
  std::string summary() const override {
    return "scanning with one or two switches, or keys of the terminal";
  }

  void AddOptions(CLI::App& app) override {
    auto* group = app.add_option_group("switch", "Options of the switch front end");
    group
        ->add_option("--switch-device", device_,
                     "An input device, name:TEXT, uniq:TEXT, a FIFO, or \"terminal\"")
        ->type_name("DEVICE");
  }

  void Configure(ConfigTable table) override { ReadSwitchConfig(std::move(table), config_); }

  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    SwitchConfig config = config_;
    if (!device_.empty()) config.device = device_;
    if (const Status right = ValidateSwitch(config); !right) return right.error();
    if (!TellsRelease(config)) {
      config.scan.ignore_repeat_us = std::max(config.scan.ignore_repeat_us, kKeyRepeat_us);
    }
    return std::unique_ptr<FrontEnd>(std::make_unique<SwitchFrontEnd>(config, setup));
  }

 private:
  std::string device_;
  SwitchConfig config_;
};

const FrontEndRegistration kRegistration([]() -> std::unique_ptr<FrontEndFactory> {
  return std::make_unique<SwitchFactory>();
});

}  // namespace
}  // namespace beckon::ui_bridge
