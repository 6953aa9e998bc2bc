// What pages ask of the front end.
#include <utility>

#include "services/base/bus.h"
#include "services/ui_bridge/web/web_front_end.h"

namespace beckon::ui_bridge::web {

std::shared_ptr<const std::string> WebFrontEnd::StateJson() {
  if (json_) return json_;
  state_.scanning = scanner_.has_value();
  state_.trial_seconds_left = settings_.SecondsLeft(steady_.Now());
  Json json = ToJson(state_);
  json["frame_seq"] = scene_.frame_seq() ? Json(*scene_.frame_seq()) : Json(nullptr);
  json["scene"] = scene_.json();
  json["rev"] = ++rev_;
  json_ = std::make_shared<const std::string>(
      json.dump(-1, ' ', false, Json::error_handler_t::replace));
  server_.Publish("state", *json_);
  return json_;
}

Json WebFrontEnd::Settings() {
  Json presets = Json::object();
  for (const auto& [name, preset] : Presets()) presets[name] = ToJson(preset);
  const auto left = settings_.SecondsLeft(steady_.Now());
  return {{"settings", ToJson(settings_.current())},
          {"presets", std::move(presets)},
          {"trial", left ? Json{{"seconds_left", *left}} : Json(nullptr)}};
}

PageImage WebFrontEnd::Image() {
  WatchCamera();
  return {scene_.image_type(), scene_.image()};
}

/// Frames are large: nobody listens to them before a page is there to see them.
void WebFrontEnd::WatchCamera() {
  if (std::exchange(watching_camera_, true)) return;
  setup_.bus.Subscribe<msg::Frame>(
      [this](msg::Frame frame) {
        scene_.OnFrame(std::move(frame));
        SceneChanged();
      },
      1);
}

void WebFrontEnd::Opened(bool first) {
  WatchCamera();
  if (!std::exchange(opened_, true)) setup_.sink.Request(msg::SessionKind::kRequestProfile);
  if (first && state_.phase == Phase::kIdle && !state_.stopping)
    setup_.sink.Request(msg::SessionKind::kRequestStart);
  scene_.Refresh();
  json_.reset();
  StateJson();
}

Outcome WebFrontEnd::Answer(int64_t query_id, int64_t option) {
  const auto refuse = [](const char* reason, const char* error) {
    return Outcome{409, {{"error", error}, {"reason", reason}}};
  };
  if (!state_.query || state_.query->id != query_id)
    return refuse("stale", "this question no longer stands");
  const size_t n = state_.query->options.size();
  if (option < 0 || static_cast<size_t>(option) >= n)
    return Outcome::Failed(400, "'option': expected 0 to " + std::to_string(n - 1));
  if (state_.answered) return refuse("answered", "this question is answered already");
  state_.answered = true;
  setup_.sink.Answer(query_id, OneHot(static_cast<size_t>(option), n));
  Changed();
  return {200, {{"taken", true}}};
}

Outcome WebFrontEnd::Request(msg::SessionKind request) {
  using Kind = msg::SessionKind;
  if (request == Kind::kRequestStop) {
    setup_.sink.Request(request);  // before anything else
    state_.stopping = state_.phase != Phase::kStopped;
    Changed();
    return {200, {{"done", true}}};
  }
  const bool stopped = state_.phase == Phase::kStopped || state_.stopping;
  if (request == Kind::kRequestResume && state_.stopping)
    return Outcome::Failed(409, "the stop is still on its way");
  if (stopped != (request == Kind::kRequestResume))
    return Outcome::Failed(409,
                           stopped ? "everything is stopped; resume first" : "nothing is stopped");
  if (request == Kind::kRequestStart && state_.phase == Phase::kRunning)
    return {200, {{"done", true}}};
  if (request == Kind::kRequestNoneOfThese && state_.query) state_.answered = true;
  setup_.sink.Request(request);
  Changed();
  return {200, {{"done", true}}};
}

Outcome WebFrontEnd::Press(int which, bool down) {
  if (!scanner_)
    return Outcome::Failed(409, "the page is not scanned; settings say how it is used");
  DoScanned(scanner_->OnSwitch(steady_.Now(),
                               which == 0 ? scan::Switch::kMain : scan::Switch::kSelect, down));
  Changed();
  return {200, {{"done", true}}};
}

void WebFrontEnd::DoScanned(const std::vector<Scanned>& choices) {
  for (const Scanned& choice : choices) {
    if (const auto* request = std::get_if<ScannedRequest>(&choice)) {
      Request(request->request);
    } else if (const auto* answer = std::get_if<ScannedAnswer>(&choice)) {
      Answer(answer->query_id, answer->option);
    } else if (const auto* trial = std::get_if<ScannedTrial>(&choice)) {
      EndTrial(trial->keep);
    }
    if (!scanner_) return;
  }
}

Outcome WebFrontEnd::ChooseUser(const std::string& user) {
  if (auto chosen = setup_.sink.ChooseUser(user); !chosen)
    return Outcome::Failed(400, chosen.error().message);
  return {200, {{"user", user}}};
}

Outcome WebFrontEnd::TrySettings(const Json& json) {
  auto settings = ReadSettings(json, settings_.current());
  if (!settings) return Outcome::Failed(400, settings.error().message);
  const Utime length = TrialLength_us(*settings, static_cast<Utime>(config_.trial_s * kSecond));
  settings_.Try(steady_.Now(), *std::move(settings), length);
  UseSettings();
  Changed();
  return {200, Settings()};
}

Outcome WebFrontEnd::KeepSettings() {
  const bool kept = EndTrial(/*keep=*/true);
  Changed();
  if (!kept) return Outcome::Failed(409, "no settings are on trial");
  return {200, Settings()};
}

bool WebFrontEnd::EndTrial(bool keep) {
  if (!settings_.on()) return false;
  const bool kept = keep && settings_.Keep(steady_.Now());
  if (kept) {
    store_.Save(state_.user, settings_.kept());
  } else {
    settings_.GiveUp();
  }
  UseSettings();
  return kept;
}

void WebFrontEnd::LoadSettings() {
  auto settings = store_.Load(state_.user);
  if (!settings)
    ShowNotice("Your settings could not be read, so the usual ones are used. " +
               settings.error().message);
  settings_ = SettingsTrial(settings ? *std::move(settings) : web::Settings{});
  UseSettings();
}

void WebFrontEnd::UseSettings() {
  ++state_.settings_rev;
  const scan::Config scan = ScanConfig(settings_.current());
  if (!settings_.current().scans()) {
    if (std::exchange(scanner_, std::nullopt)) state_.highlight.reset();
    state_.controls.clear();
  } else if (scanner_) {
    scanner_->SetConfig(steady_.Now(), scan);
  } else {
    scanner_.emplace(scan);
  }
}

}  // namespace beckon::ui_bridge::web
