#include "services/ui_bridge/switch/switch_front_end.h"

#include <algorithm>
#include <utility>

#include "services/base/bus.h"
#include "services/ui_bridge/switch/switch_pages.h"
#include "services/ui_bridge/switch/terminal_keys.h"

namespace beckon::ui_bridge {

SwitchFrontEnd::SwitchFrontEnd(const SwitchConfig& config, const FrontEndSetup& setup)
    : config_(config),
      setup_(setup),
      user_(setup.user),
      output_(config.audio, config.voice, setup.loop),
      scanner_(config.scan),
      seconds_(scan::FitSeconds(config.scan, config.max_options)) {}
SwitchFrontEnd::~SwitchFrontEnd() {
  for (const auto& timer : {tick_, beat_}) {
    if (timer) setup_.loop.Cancel(*timer);
  }
}

msg::Interface SwitchFrontEnd::Announce() const {
  msg::Interface interface;
  interface.kind = msg::InterfaceKind::kScan;
  interface.max_options = config_.max_options;
  interface.seconds_per_question = static_cast<float>(seconds_.per_question);
  interface.seconds_per_option = static_cast<float>(seconds_.per_option);
  interface.false_yes = static_cast<float>(config_.false_yes);
  interface.false_no = static_cast<float>(config_.false_no);
  return interface;
}

void SwitchFrontEnd::Begin() {
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

void SwitchFrontEnd::Present(const msg::Query& query) {
  query_ = query;
  answered_.reset();
  between_ = false;
  shown_.reset();
  output_.Ask(query);
  ShowPage();
}

void SwitchFrontEnd::Withdraw() {
  query_.reset();
  ShowPage();
}

void SwitchFrontEnd::ShowSession(const msg::Session& event) {
  const bool stopped = event.kind == msg::SessionKind::kStopped;
  // Until intention has heard of a stop of ours, what it says is older than that.
  if (stopped) stop_on_its_way_ = false;
  const bool resumed = std::exchange(stopped_, stopped) && !stopped;
  if (!stop_on_its_way_) scanner_.SetStopped(steady_.Now(), stopped);
  if (const std::string text = SessionWords(event); !text.empty()) output_.Tell(text);
  if (event.kind == msg::SessionKind::kBegun) {
    in_session_ = true;
    between_ = false;
  }
  const bool over = event.kind == msg::SessionKind::kConfirmed ||
                    event.kind == msg::SessionKind::kAbandoned ||
                    event.kind == msg::SessionKind::kIdle;
  if (over && std::exchange(in_session_, false)) {
    AfterSession();
  } else if (over && resumed) {
    between_ = true;  // a stop took back what was asked for
  }
  ShowPage();
}

void SwitchFrontEnd::ShowNotice(const std::string& text) {
  output_.Tell(text);
  Refresh();
}

void SwitchFrontEnd::ShowTaskStatus(const msg::TaskStatus& status) {
  ShowNotice(TaskWords(status));
}

void SwitchFrontEnd::ShowUser(const std::string& user) {
  user_ = user;
  reactions_ = scan::ReactionTimes();  // somebody else's
  SetScanTime(config_.scan.scan_us);
}

std::string SwitchFrontEnd::State() const {
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

void SwitchFrontEnd::OnEdge(Utime at, scan::Switch which, bool down) {
  Do(scanner_.OnSwitch(at, which, down));
}
void SwitchFrontEnd::OnClick(Utime at, scan::Switch which) { Do(scanner_.OnClick(at, which)); }
void SwitchFrontEnd::OnStopKey() {
  const Utime now = steady_.Now();
  Stop();
  scanner_.SetStopped(now, true);
  Refresh();
}
void SwitchFrontEnd::OnRelease(Utime at) {
  scanner_.ReleaseAll(at);
  Refresh();
}
void SwitchFrontEnd::OnSourceNotice(const std::string& text) { ShowNotice(text); }

void SwitchFrontEnd::Do(const std::vector<scan::Action>& actions) {
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

void SwitchFrontEnd::Stop() {
  setup_.sink.Request(msg::SessionKind::kRequestStop);
  // Where it is stopped already, intention has nothing new to say.
  stop_on_its_way_ = !stopped_;
  output_.Tell("STOP.");
}

void SwitchFrontEnd::Choose(const scan::Action& action) {
  if (!query_ || query_->id != action.page) return;
  const auto option = static_cast<size_t>(action.option);
  setup_.sink.Answer(query_->id, OneHot(option, query_->options.size()));
  output_.Line("=> " + query_->options[option].text);
  reactions_.Chosen();
  chose_last_ = true;
  answered_ = query_->id;
  ShowPage();
}

void SwitchFrontEnd::Use(scan::Control control) {
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

void SwitchFrontEnd::AfterSession() {
  chose_last_ = false;
  if (++sessions_ == setup_.exit_after_sessions) return setup_.sink.Finish();
  between_ = true;
  const scan::Config& scan = scanner_.config();
  if (config_.suggest && scan.method == scan::Method::kAutomatic) {
    suggestion_ = reactions_.Suggest(scan.scan_us);
  }
  if (suggestion_) output_.Tell(SuggestionWords(*suggestion_, scan.scan_us));
}

void SwitchFrontEnd::DecideSuggestion(bool accepted) {
  if (!suggestion_) return;
  reactions_.Asked();
  if (accepted) {
    SetScanTime(suggestion_->scan_us);
    output_.Tell("The pointer moves every " + SecondsWords(suggestion_->scan_us) +
                 " s now; scan_time in [switch] keeps it.");
  }
  suggestion_.reset();
  ShowPage();
}

void SwitchFrontEnd::SetScanTime(Utime scan_us) {
  scan::Config scan = scanner_.config();
  scan.scan_us = scan_us;
  scanner_.SetConfig(steady_.Now(), scan);
  reactions_.ScanTimeChanged();
  seconds_ = scan::FitSeconds(scan, config_.max_options);
}

void SwitchFrontEnd::ShowPage() {
  if (Asks() && shown_ == query_->id) return Refresh();
  const scan::Page page = CurrentPage();
  if (!Asks() && shown_ == kControlPage && page.controls == controls_) return Refresh();
  shown_ = page.id;
  controls_ = page.controls;
  scanner_.Show(steady_.Now(), page);
  Refresh();
}

scan::Page SwitchFrontEnd::CurrentPage() const {
  using scan::Control;
  if (Asks()) return QuestionPage(*query_, config_.audio ? config_.seconds_a_letter : 0);
  scan::Page page;
  if (between_ && suggestion_) {
    page.controls = {Control::kAccept, Control::kKeep, Control::kStop};
  } else if (between_) {
    page.controls = {Control::kStart, Control::kStop};
  } else if (!TellsRelease(config_) || config_.scan.stop_hold_us == 0) {
    page.controls = {Control::kStop};  // who cannot hold needs another way
  }
  return page;
}

void SwitchFrontEnd::Refresh() {
  if (output_.Draw(scanner_.view(), query())) PublishHighlight();
  if (tick_) setup_.loop.Cancel(*std::exchange(tick_, std::nullopt));
  const auto due = scanner_.NextDeadline();
  if (!due) return;
  tick_ = setup_.loop.After(std::max<Utime>(1, *due - steady_.Now()), [this] {
    tick_.reset();
    Do(scanner_.Tick(steady_.Now()));
  });
}

void SwitchFrontEnd::PublishHighlight() {
  msg::Highlight highlight =
      HighlightOf(scanner_.view(), query_ && scanner_.view().page == query_->id);
  highlight.utime = clock_.Now();
  highlight.device = setup_.device;
  highlight.user = user_;
  if (const Status sent = setup_.bus.Publish(highlight); !sent) {
    output_.Line("What is lit could not be told: " + sent.error().message);
  }
}

}  // namespace beckon::ui_bridge
