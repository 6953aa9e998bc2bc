// The front end on a bus, in a thread of its own, with an intention that follows a script; the
// test's thread plays the browsers over real sockets.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/service.h"
#include "services/ui_bridge/web/web_front_end.h"

namespace beckon::ui_bridge::web {

/// Begins what is asked for, asks questions of two options, confirms; stops and resumes; repeats
/// itself as docs/protocol.md says. What it knows outlives the bus that it speaks on.
class ScriptedIntention {
 public:
  void Join(Bus& bus, RunLoop& loop);

  int questions = 3;  // of each session
  bool deaf = false;  // says and hears nothing: it is away
  std::string user = "ann";
  msg::Query query;  // that stands, where `asking`
  bool asking = false;
  msg::Session event;  // the latest

  /// As after a restart: no session runs.
  void Forget();
  void PublishAll();

  int starts = 0;
  std::vector<msg::Answer> answers;  // that were taken
  std::vector<msg::Session> requests;
  std::vector<msg::Interface> interfaces;
  std::vector<msg::Highlight> highlights;

 private:
  void OnRequest(const msg::Session& request);
  void OnAnswer(const msg::Answer& answer);
  void Ask();
  void Announce(msg::SessionKind kind, const std::string& text = {});

  Bus* bus_ = nullptr;
  int64_t next_query_id_ = 100;
  int answered_ = 0;  // in this session
};

/// A folder with a page of a few words and a place for settings; gone with it.
class WebFolder {
 public:
  WebFolder();
  ~WebFolder();
  std::string page() const { return path_ + "/page"; }
  std::string data() const { return path_ + "/data"; }

 private:
  std::string path_;
};

/// ui_bridge with this front end alone. A restart keeps port and intention.
class WebSystem {
 public:
  explicit WebSystem(AccessRules rules = {}, double trial_s = 20);
  ~WebSystem();

  int port() const { return port_; }
  const WebFolder& folder() const { return folder_; }
  /// Runs in the loop's thread and waits for it.
  void InLoop(const std::function<void()>& work);
  /// Waits until `condition`, which is asked in the loop's thread.
  bool Until(const std::function<bool()>& condition, double timeout_s = 5);
  void StopBridge();
  void StartBridge();

  /// These in the loop's thread only.
  ScriptedIntention& intention() { return intention_; }
  Bus& bus() { return *life_->bus; }
  WebFrontEnd& front_end() { return *front_end_; }

 private:
  class Factory;
  struct Life {
    RunLoop loop;
    std::unique_ptr<Bus> bus;
    std::unique_ptr<Service> service;
    std::thread thread;
  };

  const WebFolder folder_;
  const AccessRules rules_;
  const double trial_s_;
  const SystemClock clock_;
  const SteadyClock steady_;
  int port_ = 0;
  ScriptedIntention intention_;
  WebFrontEnd* front_end_ = nullptr;
  std::unique_ptr<Life> life_;
};

}  // namespace beckon::ui_bridge::web
