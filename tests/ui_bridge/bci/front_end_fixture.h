// The front end bci on a memory bus, between an intention and a decoder that do as a test says.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "services/ui_bridge/service.h"

namespace beckon::ui_bridge::bci {

class FrontEndTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "beckon-bci-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    ASSERT_EQ(pipe(keys_), 0);
    stdin_ = dup(STDIN_FILENO);
    ASSERT_EQ(dup2(keys_[0], STDIN_FILENO), STDIN_FILENO);
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    ListenAsIntention();
    bus_->Subscribe<msg::Interface>([this](const msg::Interface& i) { interface_ = i; });
    bus_->Subscribe<msg::Stimulus>([this](const msg::Stimulus& stimulus) {
      const bool fresh = stimuli_.empty() || stimuli_.back().trial != stimulus.trial;
      if (fresh) stimuli_.push_back(stimulus);
      if (fresh && decode_) decode_(stimulus);
    });
  }

  void TearDown() override {
    bridge_.reset();
    dup2(stdin_, STDIN_FILENO);
    for (const int fd : {stdin_, keys_[0], keys_[1]}) close(fd);
    std::filesystem::remove_all(folder_);
  }

  void ListenAsIntention() {
    bus_->Subscribe<msg::Session>([this](const msg::Session& said) {
      if (static_cast<int>(said.kind) >= static_cast<int>(msg::SessionKind::kIdle)) return;
      if (requests_.empty() || requests_.back() != said.kind) requests_.push_back(said.kind);
      switch (said.kind) {
        case msg::SessionKind::kRequestStart:
          if (session_ == said.session_id) return;
          session_ = said.session_id;
          Tell(msg::SessionKind::kBegun);
          if (on_begun_) on_begun_();
          return;
        case msg::SessionKind::kRequestStop:
          return Tell(msg::SessionKind::kStopped);
        case msg::SessionKind::kRequestResume:
          return Tell(msg::SessionKind::kIdle);
        default:
          return;
      }
    });
    bus_->Subscribe<msg::Answer>([this](const msg::Answer& answer) {
      if (++times_answered_[answer.query_id] > 1 &&
          answers_.back().likelihoods == answer.likelihoods)
        return;  // repeated
      answers_.push_back(answer);
      if (on_answer_) on_answer_(answer);
    });
  }

  static std::string Quick() {
    return "[bci]\nread_s = 0\npause_s = 0\ntrial_timeout_s = 0.4\nrest_s = 0.2\ninvite = false\n"
           "controls = [\"stop\"]\n";
  }

  Status Start(const std::string& toml, int sessions = 0) {
    factories_ = MakeFrontEndFactories();
    const auto bci = std::ranges::find(factories_, "bci", [](const auto& f) { return f->name(); });
    auto table = ConfigTable::Parse(
        toml + "calibration_dir = \"" + (folder_ / "bci").string() + "\"\n", "test.toml");
    if (!table) return table.error();
    (*bci)->Configure(table->Section("bci"));
    if (auto read = table->Finish(); !read) return read;
    bridge_ = std::make_unique<Service>(ServiceConfig{.user = "ann",
                                                      .device = "bci@test",
                                                      .exit_after_sessions = sessions,
                                                      .listen_us = 50'000},
                                        *bus_, loop_, clock_, steady_);
    if (auto added = bridge_->Add(**bci); !added) return added;
    bridge_->Begin();
    return {};
  }

  /// Runs until `done`, or fails after 20 s.
  void Until(const std::function<bool()>& done) {
    bool late = false;
    const auto deadline = loop_.After(20 * kSecond, [&] {
      late = true;
      loop_.Stop();
    });
    const auto check = loop_.Every(2'000, [&] {
      if (done()) loop_.Stop();
    });
    loop_.Run();
    loop_.Cancel(check);
    if (!late) loop_.Cancel(deadline);
    ASSERT_FALSE(late) << "not done after 20 s; " << bridge_->State();
  }

  void Tell(msg::SessionKind kind) {
    msg::Session event;
    event.utime = clock_.Now();
    event.kind = kind;
    event.user = kind == msg::SessionKind::kIdle ? "" : "ann";
    event.session_id = kind == msg::SessionKind::kIdle ? "" : session_;
    event.questions = static_cast<int>(answers_.size());
    ASSERT_TRUE(bus_->Publish(event));
  }

  msg::Query Question(int64_t id) const {
    msg::Query query;
    query.utime = clock_.Now();
    query.id = id;
    query.session_id = session_;
    query.user = "ann";
    query.kind = msg::QueryKind::kChoice;
    query.text = "What shall I do?";
    query.any_object = false;
    query.objects = {{1, "Carton", 1}, {2, "Mug", 1}};
    query.options = {{.text = "Open the carton", .actions = {"Open"}, .objects = {1}},
                     {.text = "Grasp the mug", .actions = {"Grasp"}, .objects = {2}},
                     {.text = "None of these"}};
    query.scene_seq = 1;
    query.questions_asked = static_cast<int>(answers_.size());
    return query;
  }
  void Ask(int64_t id) { ASSERT_TRUE(bus_->Publish(Question(id))); }

  void TellTask(const std::string& action, const msg::ObjectRef& object) {
    msg::Task task;
    task.utime = clock_.Now();
    task.task_id = session_;
    task.user = "ann";
    task.action = action;
    task.object = object;
    task.posterior = 0.995;
    task.expires_utime = clock_.Now() + 30 * kSecond;
    ASSERT_TRUE(bus_->Publish(task));
  }

  msg::Decoding Decoding(const msg::Stimulus& stimulus, size_t likeliest, double p = 0.85) const {
    msg::Decoding decoding;
    decoding.utime = clock_.Now();
    decoding.decoder = "cap";
    decoding.device = stimulus.device;
    decoding.trial = stimulus.trial;
    const size_t classes = stimulus.labels.size();
    decoding.probabilities.assign(classes, (1 - p) / static_cast<double>(classes - 1));
    decoding.probabilities[likeliest] = p;
    return decoding;
  }
  void Decode(const msg::Stimulus& stimulus, size_t likeliest, double p = 0.85) {
    ASSERT_TRUE(bus_->Publish(Decoding(stimulus, likeliest, p)));
  }

  int64_t RefusedDecodings() const {
    const auto found = bus_->traffic().find("BECKON_DECODING");
    return found == bus_->traffic().end() ? 0 : found->second.Refused();
  }
  bool Requested(msg::SessionKind kind) const { return std::ranges::count(requests_, kind) > 0; }
  void Type(const std::string& line) {
    ASSERT_EQ(write(keys_[1], line.data(), line.size()), static_cast<ssize_t>(line.size()));
  }

  SystemClock clock_;
  SteadyClock steady_;
  RunLoop loop_;
  std::unique_ptr<Bus> bus_ = std::move(*Bus::Open("memq://"));
  std::filesystem::path folder_;
  int keys_[2] = {-1, -1};
  int stdin_ = -1;
  std::vector<std::unique_ptr<FrontEndFactory>> factories_;
  std::unique_ptr<Service> bridge_;
  std::string session_;
  msg::Interface interface_;
  std::vector<msg::Stimulus> stimuli_;  // the first of each trial
  std::vector<msg::SessionKind> requests_;
  std::vector<msg::Answer> answers_;
  std::map<int64_t, int> times_answered_;
  std::function<void()> on_begun_;
  std::function<void(const msg::Answer&)> on_answer_;
  std::function<void(const msg::Stimulus&)> decode_;
};

}  // namespace beckon::ui_bridge::bci
