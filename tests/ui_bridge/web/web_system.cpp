#include "tests/ui_bridge/web/web_system.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "services/ui_bridge/web/listen_socket.h"

namespace beckon::ui_bridge::web {

using Kind = msg::SessionKind;

void ScriptedIntention::Join(Bus& bus, RunLoop& loop) {
  bus_ = &bus;
  bus.Subscribe<msg::Session>([this](const msg::Session& request) {
    if (!deaf && request.kind < Kind::kIdle) OnRequest(request);
  });
  bus.Subscribe<msg::Answer>([this](const msg::Answer& answer) {
    if (!deaf) OnAnswer(answer);
  });
  bus.Subscribe<msg::Interface>([this](const msg::Interface& i) { interfaces.push_back(i); });
  bus.Subscribe<msg::Highlight>([this](const msg::Highlight& h) { highlights.push_back(h); });
  if (event.utime == 0) Announce(Kind::kIdle);
  loop.Every(100'000, [this] { PublishAll(); });
}

void ScriptedIntention::PublishAll() {
  if (deaf) return;
  EXPECT_TRUE(bus_->Publish(event));
  if (asking) {
    EXPECT_TRUE(bus_->Publish(query));
  }
}

void ScriptedIntention::Forget() {
  asking = false;
  event.session_id.clear();
  Announce(Kind::kIdle);
}

void ScriptedIntention::Announce(Kind kind, const std::string& text) {
  event.utime = SystemClock().Now();
  event.user = kind == Kind::kIdle ? "" : user;
  if (kind == Kind::kIdle) event.session_id.clear();
  event.kind = kind;
  event.questions = answered_;
  event.text = text;
  PublishAll();
}

void ScriptedIntention::OnRequest(const msg::Session& request) {
  requests.push_back(request);
  const bool runs = event.kind == Kind::kBegun, stopped = event.kind == Kind::kStopped;
  if (request.kind == Kind::kRequestStop) {
    asking = false;
    return Announce(Kind::kStopped, "Stopped.");
  }
  if (request.kind == Kind::kRequestResume && stopped) return Announce(Kind::kIdle);
  if (request.kind == Kind::kRequestCancel && runs) {
    asking = false;
    return Announce(Kind::kAbandoned);
  }
  if (request.kind == Kind::kRequestUndo && asking && answered_ > 0) {
    --answered_;
    return Ask();
  }
  if (request.kind != Kind::kRequestStart || runs || stopped) return;
  if (event.session_id == request.session_id) return;
  ++starts;
  user = request.user;
  event.session_id = request.session_id;
  answered_ = 0;
  Announce(Kind::kBegun);
  Ask();
}

void ScriptedIntention::OnAnswer(const msg::Answer& answer) {
  if (!asking || answer.query_id != query.id) return;
  answers.push_back(answer);
  if (++answered_ < questions) return Ask();
  asking = false;
  msg::Task task;
  task.utime = SystemClock().Now();
  task.task_id = event.session_id;
  task.user = user;
  task.action = "Open";
  task.object = {3, "Carton", 1};
  task.posterior = 0.99;
  task.expires_utime = task.utime + 30 * kSecond;
  const auto sent = bus_->Publish(task);
  EXPECT_TRUE(sent) << (sent ? "" : sent.error().message);
  Announce(Kind::kConfirmed, "Open the carton.");
}

void ScriptedIntention::Ask() {
  query = {};
  query.utime = SystemClock().Now();
  query.id = next_query_id_++;
  query.session_id = event.session_id;
  query.user = user;
  query.text = "This?";
  query.options = {{.text = "Yes"}, {.text = "No"}};
  query.scene_seq = 1;
  query.questions_asked = answered_;
  asking = true;
  PublishAll();
}

WebFolder::WebFolder() {
  char name[] = "/tmp/beckon-web-XXXXXX";
  path_ = mkdtemp(name);
  std::filesystem::create_directory(page());
  std::ofstream(page() + "/index.html") << "<!doctype html><title>page</title>";
  std::ofstream(page() + "/main.js") << "// nothing";
}

WebFolder::~WebFolder() { std::filesystem::remove_all(path_); }

class WebSystem::Factory final : public FrontEndFactory {
 public:
  explicit Factory(WebSystem& system) : system_(system) {}
  std::string name() const override { return "web"; }
  std::string summary() const override { return "the front end of the test"; }
  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    auto socket = Listen("127.0.0.1", system_.port_);
    if (!socket) return socket.error();
    system_.port_ = socket->port;
    WebConfig config{.data = system_.folder_.data(), .trial_s = system_.trial_s_};
    auto made = std::make_unique<WebFrontEnd>(config, setup, socket->fd, system_.rules_,
                                              *ReadPageFiles(system_.folder_.page()));
    system_.front_end_ = made.get();
    return std::unique_ptr<FrontEnd>(std::move(made));
  }

 private:
  WebSystem& system_;
};

WebSystem::WebSystem(AccessRules rules, double trial_s)
    : rules_(std::move(rules)), trial_s_(trial_s) {
  StartBridge();
}

WebSystem::~WebSystem() { StopBridge(); }

void WebSystem::StartBridge() {
  life_ = std::make_unique<Life>();
  life_->bus = std::move(*Bus::Open("memq://"));
  life_->loop.AddFd(life_->bus->fd(), [this] { life_->bus->HandleReadable(); });
  life_->service = std::make_unique<Service>(
      ServiceConfig{.user = "ann", .device = "desk", .listen_us = 300'000}, *life_->bus,
      life_->loop, clock_, steady_);
  Factory factory(*this);
  const auto added = life_->service->Add(factory);
  ASSERT_TRUE(added) << added.error().message;
  life_->service->Begin();
  intention_.Join(*life_->bus, life_->loop);
  life_->thread = std::thread([this] { life_->loop.Run(); });
}

void WebSystem::StopBridge() {
  if (!life_) return;
  life_->loop.Stop();
  life_->thread.join();
  life_.reset();
}

void WebSystem::InLoop(const std::function<void()>& work) {
  std::atomic<bool> done = false;
  life_->loop.Post([&] {
    work();
    done = true;
    done.notify_all();
  });
  done.wait(false);
}

bool WebSystem::Until(const std::function<bool()>& condition, double timeout_s) {
  const auto begin = std::chrono::steady_clock::now();
  bool met = false;
  while (!met &&
         std::chrono::steady_clock::now() - begin < std::chrono::duration<double>(timeout_s)) {
    InLoop([&] { met = condition(); });
    if (!met) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return met;
}

}  // namespace beckon::ui_bridge::web
