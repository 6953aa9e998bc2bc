// A person with one working muscle in front of a scan: the scanner, its switches, its screen and
// its voice, as one side of the conversation.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/base/run_loop.h"
#include "services/ui_bridge/front_end.h"
#include "services/ui_bridge/scan/reaction.h"
#include "services/ui_bridge/scan/scanner.h"
#include "services/ui_bridge/switch/switch_config.h"
#include "services/ui_bridge/switch/switch_output.h"
#include "services/ui_bridge/switch/switch_source.h"

namespace beckon::ui_bridge {

/// Asks for a conversation when it begins, and after each offers another. What is lit is told on
/// the bus (msg::Highlight) on every change and once a second.
class SwitchFrontEnd final : public FrontEnd, private SwitchListener {
 public:
  /// `config` as ValidateSwitch takes it.
  SwitchFrontEnd(const SwitchConfig& config, const FrontEndSetup& setup);
  ~SwitchFrontEnd() override;

  msg::Interface Announce() const override;
  void Begin() override;
  void Present(const msg::Query& query) override;
  void Withdraw() override;
  void ShowSession(const msg::Session& event) override;
  void ShowNotice(const std::string& text) override;
  void ShowTaskStatus(const msg::TaskStatus& status) override;
  void ShowUser(const std::string& user) override;
  std::string State() const override;

 private:
  // SwitchListener
  void OnEdge(Utime at, scan::Switch which, bool down) override;
  void OnClick(Utime at, scan::Switch which) override;
  void OnStopKey() override;
  void OnRelease(Utime at) override;
  void OnSourceNotice(const std::string& text) override;

  // What presses lead to.
  void Do(const std::vector<scan::Action>& actions);
  void Stop();
  void Choose(const scan::Action& action);
  void Use(scan::Control control);
  void AfterSession();
  void DecideSuggestion(bool accepted);
  void SetScanTime(Utime scan_us);

  /// Whether a question stands that was not answered.
  bool Asks() const { return query_ && answered_ != query_->id; }
  /// What there is to choose now.
  void ShowPage();
  scan::Page CurrentPage() const;
  /// Brings screen, voice, bus and timer up to what the scanner says.
  void Refresh();
  void PublishHighlight();
  const msg::Query* query() const { return query_ ? &*query_ : nullptr; }

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
  std::optional<int64_t> answered_;  // id of the question
  std::optional<int64_t> shown_;     // page of the scanner
  std::vector<scan::Control> controls_;
  bool in_session_ = false;
  bool between_ = false;          // a session is over and the next was not asked for
  bool stopped_ = false;          // as intention said last
  bool stop_on_its_way_ = false;  // ours, that it has not heard of yet
  bool chose_last_ = false;       // the last thing done was to choose an option
  int sessions_ = 0;
};

}  // namespace beckon::ui_bridge
