// Front end "web": a page in the browser. The server runs in the loop's thread, so that what a page
// says is done in the moment it arrives; every page that is open shows the same.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>

#include "services/base/app.h"
#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/front_end.h"
#include "services/ui_bridge/web/http_server.h"
#include "services/ui_bridge/web/listen_socket.h"
#include "services/ui_bridge/web/page_state.h"
#include "services/ui_bridge/web/scene_feed.h"
#include "services/ui_bridge/web/web_api.h"

namespace beckon::ui_bridge::web {
namespace {

constexpr Utime kScenePeriod_us = 200'000;
constexpr Utime kSilence_us = 4 * kSecond;

struct WebConfig {
  std::string address = "127.0.0.1";  // numeric
  int port = 8765;                    // 0 = any that is free
  int max_options = 6;                // of a choice, shown at once
  double seconds_per_question = 3;    // s, to read, decide and press
  double seconds_per_option = 0.5;    // s, more for each option
  double false_yes = 0.005;           // 0..0.5
  double false_no = 0.005;            // 0..0.5
};

class WebFrontEnd final : public FrontEnd, private PageActions {
 public:
  WebFrontEnd(WebConfig config, const FrontEndSetup& setup, const ListenSocket& socket,
              AccessRules rules, PageFiles files)
      : config_(std::move(config)),
        setup_(setup),
        api_(std::move(rules), std::move(files), *this),
        server_({}, socket.fd, setup.loop, steady_,
                [this](const HttpRequest& request) { return api_(request); }) {
    state_.user = setup.user;
  }
  ~WebFrontEnd() override {
    for (auto& timer : {scene_timer_, silence_timer_}) {
      if (timer) setup_.loop.Cancel(*timer);
    }
  }

  // FrontEnd
  msg::Interface Announce() const override {
    msg::Interface interface;
    interface.kind = msg::InterfaceKind::kChoice;
    interface.max_options = config_.max_options;
    interface.seconds_per_question = static_cast<float>(config_.seconds_per_question);
    interface.seconds_per_option = static_cast<float>(config_.seconds_per_option);
    interface.false_yes = static_cast<float>(config_.false_yes);
    interface.false_no = static_cast<float>(config_.false_no);
    return interface;
  }

  void Begin() override {
    setup_.bus.Subscribe<msg::Session>([this](const msg::Session& event) {
      if (event.kind >= msg::SessionKind::kIdle) HearIntention();
    });
    setup_.bus.Subscribe<msg::Query>([this](const msg::Query&) { HearIntention(); });
    setup_.bus.Subscribe<msg::Poses>(
        [this](const msg::Poses& poses) {
          scene_.OnPoses(poses);
          SceneChanged();
        },
        1);
    heard_ = steady_.Now();
    silence_timer_ = setup_.loop.Every(kSecond, [this] { CheckSilence(); });
  }

  void Present(const msg::Query& query) override {
    state_.query = query;
    state_.answered = false;
    state_.notice.clear();
    state_.phase = Phase::kRunning;
    scene_.Refresh();
    Changed();
  }

  void Withdraw() override {
    state_.query.reset();
    state_.answered = false;
    Changed();
  }

  void ShowSession(const msg::Session& event) override {
    state_.event = event.kind;
    state_.event_text = event.text;
    const Phase before = state_.phase;
    switch (event.kind) {
      case msg::SessionKind::kBegun:
        state_.phase = Phase::kRunning;
        if (state_.task && state_.task->task_id != event.session_id) ForgetTask();
        break;
      case msg::SessionKind::kStopped:
        state_.phase = Phase::kStopped;
        state_.stopping = false;
        break;
      default:
        state_.phase = Phase::kIdle;
    }
    const bool over = before == Phase::kRunning && state_.phase == Phase::kIdle;
    if (over && ++sessions_ == setup_.exit_after_sessions) setup_.sink.Finish();
    Changed();
  }

  void ShowNotice(const std::string& text) override {
    state_.notice = text;
    Changed();
  }

  void ShowScene(const msg::Scene& scene) override {
    scene_.OnScene(scene);
    SceneChanged();
  }

  void ShowTask(const msg::Task& task) override {
    state_.task = task;
    state_.task_status.reset();
    Changed();
  }

  void ShowTaskStatus(const msg::TaskStatus& status) override {
    if (!state_.task || state_.task->task_id != status.task_id) return;
    state_.task_status = status;
    Changed();
  }

  void ShowUser(const std::string& user) override {
    state_.user = user;
    profile_ = {};
    profile_.user = user;
    ++state_.profile_rev;
    ForgetTask();
    if (opened_) setup_.sink.Request(msg::SessionKind::kRequestProfile);
    Changed();
  }

  void ShowProfile(const msg::Profile& profile) override {
    profile_ = profile;
    ++state_.profile_rev;
    Changed();
  }

  std::string State() const override {
    const size_t pages = server_.streams();
    return std::to_string(pages) + (pages == 1 ? " page" : " pages");
  }

 private:
  // PageActions
  std::shared_ptr<const std::string> StateJson() override {
    if (!json_) {
      ++rev_;
      Json json = ToJson(state_);
      json["frame_seq"] = scene_.frame_seq() ? Json(*scene_.frame_seq()) : Json(nullptr);
      json["scene"] = scene_.json();
      json["rev"] = rev_;
      json_ = std::make_shared<const std::string>(
          json.dump(-1, ' ', false, Json::error_handler_t::replace));
      server_.Publish("state", *json_);
    }
    return json_;
  }

  PageImage Image() override { return {scene_.image_type(), scene_.image()}; }
  Json Profile() override { return ToJson(profile_); }
  Json Settings() override { return Json::object(); }

  void Opened(bool first) override {
    if (!std::exchange(opened_, true)) {
      setup_.bus.Subscribe<msg::Frame>(
          [this](msg::Frame frame) {
            scene_.OnFrame(std::move(frame));
            SceneChanged();
          },
          1);
      setup_.sink.Request(msg::SessionKind::kRequestProfile);
    }
    if (first && state_.phase == Phase::kIdle) setup_.sink.Request(msg::SessionKind::kRequestStart);
    scene_.Refresh();
    json_.reset();
    StateJson();
  }

  Outcome Answer(int64_t query_id, int64_t option) override {
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

  Outcome Request(msg::SessionKind request) override {
    // Nothing comes before a stop.
    setup_.sink.Request(request);
    if (request == msg::SessionKind::kRequestStop) state_.stopping = true;
    if (request == msg::SessionKind::kRequestNoneOfThese)
      state_.answered = state_.query.has_value();
    Changed();
    return {200, {{"done", true}}};
  }

  Outcome Press(int, bool) override { return Outcome::Failed(409, "nothing is scanned here"); }

  Outcome ChooseUser(const std::string& user) override {
    if (auto chosen = setup_.sink.ChooseUser(user); !chosen)
      return Outcome::Failed(400, chosen.error().message);
    return {200, {{"user", user}}};
  }

  Outcome TrySettings(const Json&) override { return Outcome::Failed(501, "not yet"); }
  Outcome KeepSettings() override { return Outcome::Failed(501, "not yet"); }

  void ForgetTask() {
    state_.task.reset();
    state_.task_status.reset();
  }

  void HearIntention() {
    heard_ = steady_.Now();
    if (std::exchange(state_.intention_silent, false)) Changed();
  }

  void CheckSilence() {
    const bool silent = steady_.Now() - heard_ > kSilence_us;
    if (silent && !std::exchange(state_.intention_silent, true)) Changed();
  }

  /// Every page is told at once.
  void Changed() {
    json_.reset();
    if (server_.streams() > 0) StateJson();
  }

  /// Pages are told some times a second.
  void SceneChanged() {
    if (scene_timer_ || server_.streams() == 0) return;
    const Utime wait = scene_told_ + kScenePeriod_us - steady_.Now();
    scene_timer_ = setup_.loop.After(std::max<Utime>(wait, 1), [this] {
      scene_timer_.reset();
      scene_told_ = steady_.Now();
      if (scene_.Refresh()) Changed();
    });
  }

  const WebConfig config_;
  const FrontEndSetup setup_;
  const SteadyClock steady_;
  PageState state_;
  SceneFeed scene_;
  msg::Profile profile_;
  std::shared_ptr<const std::string> json_;  // null: to be made anew
  int64_t rev_ = 0;
  bool opened_ = false;
  int sessions_ = 0;
  Utime heard_ = 0;
  Utime scene_told_ = 0;
  std::optional<RunLoop::TimerId> scene_timer_;
  std::optional<RunLoop::TimerId> silence_timer_;
  WebApi api_;
  HttpServer server_;
};

class WebFactory final : public FrontEndFactory {
 public:
  std::string name() const override { return "web"; }
  std::string summary() const override { return "a page in the browser"; }

  void AddOptions(CLI::App& app) override {
    auto* group = app.add_option_group("web", "Options of the web front end");
    port_ =
        group
            ->add_option("--port", config_.port, "Of the page (default 8765); 0 = any that is free")
            ->check(CLI::Range(0, 65535));
  }

  void Configure(ConfigTable table) override {
    const int port = config_.port;
    table.Get("port", config_.port, 0, 65535);
    if (port_ != nullptr && port_->count() > 0) config_.port = port;
    table.Get("address", config_.address);
    table.Get("max_options", config_.max_options, 2, 64);
    table.Get("seconds_per_question", config_.seconds_per_question, 0.001, 3600);
    table.Get("seconds_per_option", config_.seconds_per_option, 0, 3600);
    table.Get("false_yes", config_.false_yes, 0, 0.5);
    table.Get("false_no", config_.false_no, 0, 0.5);
  }

  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    auto files = ReadPageFiles(SharedFile("web"));
    if (!files) return files.error();
    auto socket =
        IsSocketInherited() ? TakeInheritedSocket() : Listen(config_.address, config_.port);
    if (!socket) return socket.error();
    AccessRules rules;
    std::printf("The page: %s/\n", socket->Url().c_str());
    std::fflush(stdout);
    return std::unique_ptr<FrontEnd>(std::make_unique<WebFrontEnd>(
        config_, setup, *socket, std::move(rules), *std::move(files)));
  }

 private:
  WebConfig config_;
  CLI::Option* port_ = nullptr;
};

const FrontEndRegistration kRegistration([]() -> std::unique_ptr<FrontEndFactory> {
  return std::make_unique<WebFactory>();
});

}  // namespace
}  // namespace beckon::ui_bridge::web
