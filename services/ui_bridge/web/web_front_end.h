// The front end behind the page: what the conversation says becomes the state that every open page
// is told, what a page says goes to the conversation at once. All in the loop's thread, the server
// too.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "services/base/run_loop.h"
#include "services/ui_bridge/front_end.h"
#include "services/ui_bridge/web/http_server.h"
#include "services/ui_bridge/web/page_scanner.h"
#include "services/ui_bridge/web/page_state.h"
#include "services/ui_bridge/web/scene_feed.h"
#include "services/ui_bridge/web/settings_store.h"
#include "services/ui_bridge/web/settings_trial.h"
#include "services/ui_bridge/web/web_api.h"

namespace beckon::ui_bridge::web {

struct WebConfig {
  std::string address = "127.0.0.1";  // numeric; any but a loopback address asks for a token
  int port = 8765;                    // 0 = any that is free
  std::vector<std::string> hosts;     // further names by which browsers reach this machine
  std::string page;                   // folder of the page's files; empty = the one shipped
  std::string data;                   // folder of settings and token; empty = this user's
  int max_options = 6;                // of a choice, shown at once
  double seconds_per_question = 3;    // s, to read, decide and press; scanning reckons its own
  double seconds_per_option = 0.5;    // s, more for each option
  double false_yes = 0.005;           // 0..0.5, where learning starts
  double false_no = 0.005;            // 0..0.5
  double trial_s = 20;          // s, for which new settings are tried; longer for slow scanning
  double switch_errors = 0.02;  // 0..0.5, instead of both where it is scanned
};

class WebFrontEnd final : public FrontEnd, private PageActions {
 public:
  /// Takes the listening socket `listening` over.
  WebFrontEnd(WebConfig config, const FrontEndSetup& setup, int listening, AccessRules rules,
              PageFiles files, HttpServerConfig server = {});
  ~WebFrontEnd() override;

  // FrontEnd
  msg::Interface Announce() const override;
  void Begin() override;
  void Present(const msg::Query& query) override;
  void Withdraw() override;
  void ShowSession(const msg::Session& event) override;
  void ShowNotice(const std::string& text) override;
  void ShowScene(const msg::Scene& scene) override;
  void ShowTask(const msg::Task& task) override;
  void ShowTaskStatus(const msg::TaskStatus& status) override;
  void ShowUser(const std::string& user) override;
  void ShowProfile(const msg::Profile& profile) override;
  /// A page may be opened at any time.
  bool Endless() const override { return true; }
  std::string State() const override;

  const HttpServer& server() const { return server_; }
  /// Waits until all settings are on disk.
  void FlushSettings() { store_.Flush(); }

 private:
  // PageActions (web_requests.cpp)
  std::shared_ptr<const std::string> StateJson() override;
  PageImage Image() override;
  Json Profile() override { return ToJson(profile_); }
  Json Settings() override;
  void Opened(bool first) override;
  Outcome Answer(int64_t query_id, int64_t option) override;
  Outcome Request(msg::SessionKind request) override;
  Outcome Press(int which, bool down) override;
  Outcome ChooseUser(const std::string& user) override;
  Outcome TrySettings(const Json& settings) override;
  Outcome KeepSettings() override;

  void WatchCamera();
  void LoadSettings();
  void UseSettings();
  void DoScanned(const std::vector<Scanned>& choices);
  /// False where nothing was kept.
  bool EndTrial(bool keep);
  void OnHighlight(const msg::Highlight& highlight);
  void ShowHighlight();
  void ForgetTask();
  void HearIntention();
  void EverySecond();
  /// Every page is told at once.
  void Changed();
  /// Pages are told some times a second.
  void SceneChanged();
  /// Sets the timer for what comes next of the scanner and the trial.
  void Pace();
  void OnPace();

  const WebConfig config_;
  const FrontEndSetup setup_;
  const SystemClock clock_;
  const SteadyClock steady_;
  SettingsStore store_;
  SettingsTrial settings_;
  std::optional<PageScanner> scanner_;  // where the page is scanned
  PageState state_;
  SceneFeed scene_;
  msg::Profile profile_;
  std::shared_ptr<const std::string> json_;  // null: to be made anew
  int64_t rev_ = 0;
  bool watching_camera_ = false;
  bool in_session_ = false;
  bool told_of_silence_ = false;  // by the notice that stands
  bool opened_ = false;           // by any page, ever
  int sessions_ = 0;
  Utime heard_ = 0;  // intention
  Utime scene_told_ = 0;
  Utime highlight_heard_ = 0;  // of another front end
  std::optional<RunLoop::TimerId> scene_timer_;
  std::optional<RunLoop::TimerId> second_timer_;
  std::optional<RunLoop::TimerId> pace_timer_;
  WebApi api_;
  HttpServer server_;
};

}  // namespace beckon::ui_bridge::web
