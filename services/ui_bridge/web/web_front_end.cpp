// What the conversation tells the front end, and how pages get to know it.
#include "services/ui_bridge/web/web_front_end.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "services/base/app.h"
#include "services/base/bus.h"

namespace beckon::ui_bridge::web {
namespace {

constexpr Utime kScenePeriod_us = 200'000;
constexpr Utime kSilence_us = 4 * kSecond;
constexpr Utime kHighlightStands_us = 3 * kSecond;  // without being repeated

bool LooksTheSame(const msg::Highlight& a, const msg::Highlight& b) {
  return a.device == b.device && a.query_id == b.query_id && a.options == b.options &&
         a.controls == b.controls && a.pressed == b.pressed && a.paused == b.paused &&
         a.dwell_ms == b.dwell_ms;
}

}  // namespace

WebFrontEnd::WebFrontEnd(WebConfig config, const FrontEndSetup& setup, int listening,
                         AccessRules rules, PageFiles files, HttpServerConfig server)
    : config_(std::move(config)),
      setup_(setup),
      store_(config_.data.empty() ? DataFile("web") : config_.data),
      api_(std::move(rules), std::move(files), *this),
      server_(server, listening, setup.loop, steady_,
              [this](const HttpRequest& request) { return api_(request); }) {
  state_.user = profile_.user = setup.user;
  heard_ = steady_.Now();
  LoadSettings();
}

WebFrontEnd::~WebFrontEnd() {
  for (const auto& timer : {scene_timer_, second_timer_, pace_timer_}) {
    if (timer) setup_.loop.Cancel(*timer);
  }
}

msg::Interface WebFrontEnd::Announce() const {
  msg::Interface interface;
  interface.max_options = config_.max_options;
  double per_question = config_.seconds_per_question, per_option = config_.seconds_per_option;
  double false_yes = config_.false_yes, false_no = config_.false_no;
  interface.kind = msg::InterfaceKind::kChoice;
  if (settings_.current().scans()) {
    const auto seconds = ExpectedScanSeconds(ScanConfig(settings_.current()), config_.max_options);
    interface.kind = msg::InterfaceKind::kScan;
    per_question = seconds.per_question;
    per_option = seconds.per_option;
    false_yes = false_no = config_.switch_errors;
  }
  interface.seconds_per_question = static_cast<float>(per_question);
  interface.seconds_per_option = static_cast<float>(per_option);
  interface.false_yes = static_cast<float>(false_yes);
  interface.false_no = static_cast<float>(false_no);
  return interface;
}

void WebFrontEnd::Begin() {
  setup_.bus.Subscribe<msg::Session>([this](const msg::Session& event) {
    if (event.kind >= msg::SessionKind::kIdle) HearIntention();
  });
  setup_.bus.Subscribe<msg::Query>([this](const msg::Query&) { HearIntention(); });
  setup_.bus.Subscribe<msg::Highlight>([this](const msg::Highlight& h) { OnHighlight(h); });
  setup_.bus.Subscribe<msg::Poses>(
      [this](const msg::Poses& poses) {
        scene_.OnPoses(poses);
        SceneChanged();
      },
      1);
  second_timer_ = setup_.loop.Every(kSecond, [this] { EverySecond(); });
  Changed();
}

void WebFrontEnd::Present(const msg::Query& query) {
  state_.query = query;
  state_.answered = false;
  state_.notice.clear();
  state_.phase = Phase::kRunning;
  in_session_ = true;
  scene_.Refresh();
  Changed();
}

void WebFrontEnd::Withdraw() {
  state_.query.reset();
  state_.answered = false;
  Changed();
}

void WebFrontEnd::ShowSession(const msg::Session& event) {
  state_.phase = Phase::kIdle;
  state_.event = event.kind;
  state_.event_text = event.text;
  if (event.kind == msg::SessionKind::kBegun) {
    state_.phase = Phase::kRunning;
    in_session_ = true;
    if (state_.task && state_.task->task_id != event.session_id) ForgetTask();
  } else if (event.kind == msg::SessionKind::kStopped) {
    state_.phase = Phase::kStopped;
    state_.stopping = false;
  }
  if (state_.phase != Phase::kRunning) state_.query.reset();
  const bool over = state_.phase == Phase::kIdle && std::exchange(in_session_, false);
  if (over && ++sessions_ == setup_.exit_after_sessions) setup_.sink.Finish();
  Changed();
}

void WebFrontEnd::ShowNotice(const std::string& text) {
  state_.notice = text;
  told_of_silence_ = steady_.Now() - heard_ >= kSilence_us;
  Changed();
}

void WebFrontEnd::ShowScene(const msg::Scene& scene) {
  scene_.OnScene(scene);
  SceneChanged();
}

void WebFrontEnd::ShowTask(const msg::Task& task) {
  state_.task = task;
  state_.task_status.reset();
  Changed();
}

void WebFrontEnd::ShowTaskStatus(const msg::TaskStatus& status) {
  if (!state_.task || state_.task->task_id != status.task_id) return;
  state_.task_status = status;
  Changed();
}

void WebFrontEnd::ShowUser(const std::string& user) {
  settings_.GiveUp();
  state_.user = user;
  state_.notice.clear();
  state_.highlight.reset();
  ForgetTask();
  profile_ = {};
  profile_.user = user;
  ++state_.profile_rev;
  LoadSettings();
  if (opened_) setup_.sink.Request(msg::SessionKind::kRequestProfile);
  Changed();
}

void WebFrontEnd::ShowProfile(const msg::Profile& profile) {
  profile_ = profile;
  ++state_.profile_rev;
  Changed();
}

std::string WebFrontEnd::State() const {
  const size_t pages = server_.streams();
  return std::to_string(pages) + (pages == 1 ? " page is open" : " pages are open");
}

void WebFrontEnd::ForgetTask() {
  state_.task.reset();
  state_.task_status.reset();
}

void WebFrontEnd::HearIntention() {
  heard_ = steady_.Now();
  bool changed = std::exchange(state_.intention_silent, false);
  if (std::exchange(told_of_silence_, false)) {
    state_.notice.clear();
    changed = true;
  }
  if (changed) Changed();
}

void WebFrontEnd::EverySecond() {
  const Utime now = steady_.Now();
  bool changed = false;
  if (now - heard_ > kSilence_us) changed = !std::exchange(state_.intention_silent, true);
  if (scanner_) {
    // A page that is gone holds no switch.
    if (server_.streams() == 0) scanner_->ReleaseAll(now);
    ShowHighlight();
  } else if (state_.highlight && now - highlight_heard_ > kHighlightStands_us) {
    state_.highlight.reset();
    changed = true;
  }
  if (changed || settings_.on()) Changed();
}

/// Another front end scans for the same user: its pointer is shown, where this page has none.
void WebFrontEnd::OnHighlight(const msg::Highlight& highlight) {
  if (scanner_ || highlight.user != state_.user || highlight.device == setup_.device) return;
  highlight_heard_ = steady_.Now();
  const bool same = state_.highlight && LooksTheSame(*state_.highlight, highlight);
  state_.highlight = highlight;
  if (!same) Changed();
}

/// Of this page's scanner, for other screens.
void WebFrontEnd::ShowHighlight() {
  msg::Highlight highlight = scanner_->highlight();
  highlight.utime = clock_.Now();
  highlight.device = setup_.device;
  highlight.user = state_.user;
  if (auto sent = setup_.bus.Publish(highlight); !sent)
    spdlog::error("{}: {}", setup_.device, sent.error().message);
}

void WebFrontEnd::Changed() {
  json_.reset();
  Pace();
  if (server_.streams() > 0) StateJson();
}

void WebFrontEnd::SceneChanged() {
  if (scene_timer_ || server_.streams() == 0) return;
  const Utime wait = scene_told_ + kScenePeriod_us - steady_.Now();
  scene_timer_ = setup_.loop.After(std::max<Utime>(wait, 1), [this] {
    scene_timer_.reset();
    scene_told_ = steady_.Now();
    if (scene_.Refresh()) Changed();
  });
}

void WebFrontEnd::Pace() {
  const Utime now = steady_.Now();
  std::optional<Utime> next = settings_.NextDeadline();
  if (scanner_) {
    scanner_->Update(now, state_, settings_.on());
    msg::Highlight lit = scanner_->highlight();
    lit.device = setup_.device;
    const bool same = state_.highlight && LooksTheSame(*state_.highlight, lit);
    state_.highlight = lit;
    state_.controls = scanner_->controls();
    if (!same) {
      json_.reset();
      ShowHighlight();
    }
    if (const auto due = scanner_->NextDeadline(); due && (!next || *due < *next)) next = due;
  }
  if (pace_timer_) setup_.loop.Cancel(*std::exchange(pace_timer_, std::nullopt));
  if (!next) return;
  pace_timer_ = setup_.loop.After(std::max<Utime>(*next - now, 1), [this] {
    pace_timer_.reset();
    OnPace();
  });
}

void WebFrontEnd::OnPace() {
  const Utime now = steady_.Now();
  if (settings_.Tick(now)) UseSettings();
  if (scanner_) DoScanned(scanner_->Tick(now));
  Changed();
}

}  // namespace beckon::ui_bridge::web
