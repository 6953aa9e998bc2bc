// Whole conversations: an intention of this test's own asks, a mouth made of espeak-ng answers into
// the microphone, which is a FIFO.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <map>

#include "services/base/run_loop.h"
#include "services/ui_bridge/service.h"
#include "tests/ui_bridge/conformance/mouth.h"

namespace beckon::ui_bridge {
namespace {

std::unique_ptr<FrontEndFactory> SpeechFactory(const std::string& toml) {
  for (auto& factory : MakeFrontEndFactories()) {
    if (factory->name() != "speech") continue;
    auto table = ConfigTable::Parse(toml, "test.toml");
    factory->Configure(table->Section("speech"));
    EXPECT_TRUE(table->Finish()) << table->Finish().error().message;
    return std::move(factory);
  }
  return nullptr;
}

class SpokenTest : public ::testing::Test {
 protected:
  void SetUp() override {
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    loop_.After(110 * kSecond, [this] {
      ADD_FAILURE() << "not done after 110 s";
      loop_.Stop();
    });
    mouth_.Open(loop_);
    bus_->Subscribe<msg::Session>([this](const msg::Session& request) { OnSession(request); });
    bus_->Subscribe<msg::Answer>([this](const msg::Answer& answer) { OnAnswer(answer); });
  }

  /// Says it `after_us` from now, and in another voice again until `id` is answered:
  /// what is not understood is asked again, and people do repeat themselves.
  void Answer(int64_t id, const std::string& text, Utime after_us, size_t turn = 0) {
    static const std::vector<std::string> voices = {"en-us", "en-us+f2", "en-gb", "en-us+m7"};
    loop_.After(after_us, [this, id, text, turn] {
      if (answers_.contains(id)) return;
      Say(text, 1, voices[turn % voices.size()]);
      Answer(id, text, 5 * kSecond, turn + 1);
    });
  }

  void Say(const std::string& text, Utime after_us, const std::string& voice = "en-us") {
    loop_.After(after_us, [this, text, voice] { mouth_.Say(text, voice); });
  }

  void Announce(msg::SessionKind kind, const std::string& text = "") {
    msg::Session event;
    event.utime = clock_.Now();
    event.session_id = session_;
    event.user = "ann";
    event.kind = kind;
    event.text = text;
    ASSERT_TRUE(bus_->Publish(event));
  }

  void Ask(int64_t id, const std::vector<std::string>& options, msg::QueryKind kind) {
    msg::Query query;
    query.utime = clock_.Now();
    query.id = id;
    query.session_id = session_;
    query.user = "ann";
    query.kind = kind;
    query.text = "Open the carton?";
    for (const auto& text : options) {
      msg::Option option;
      option.text = text;
      query.options.push_back(option);
    }
    query.scene_seq = 1;
    ASSERT_TRUE(bus_->Publish(query));
  }

  void OnSession(const msg::Session& request) {
    if (static_cast<int>(request.kind) >= static_cast<int>(msg::SessionKind::kIdle)) return;
    requests_.push_back(request.kind);
    if (request.kind == msg::SessionKind::kRequestStart && session_.empty()) {
      session_ = request.session_id;
      Announce(msg::SessionKind::kBegun);
      begun_();
    }
    if (request.kind == msg::SessionKind::kRequestStop) {
      Announce(msg::SessionKind::kStopped, "stopped");
      stopped_();
    }
  }

  void OnAnswer(const msg::Answer& answer) {
    if (!answers_.emplace(answer.query_id, answer.likelihoods).second) return;
    answered_(answer.query_id);
  }

  void Run(const std::string& play) {
    auto factory = SpeechFactory("[speech]\ninput = \"" + mouth_.path() +
                                 "\"\nask_again_s = 0\nplay = " + play + "\n");
    ASSERT_TRUE(factory);
    Service service({.user = "ann", .device = "", .exit_after_sessions = 1, .listen_us = 50'000},
                    *bus_, loop_, clock_, steady_);
    const auto added = service.Add(*factory);
    ASSERT_TRUE(added) << added.error().message;
    service.Begin();
    loop_.Run();
  }

  SystemClock clock_;
  SteadyClock steady_;
  RunLoop loop_;
  std::unique_ptr<Bus> bus_ = std::move(*Bus::Open("memq://"));
  conformance::Mouth mouth_{"/tmp/beckon-spoken-" + std::to_string(getpid())};
  std::string session_;
  std::map<int64_t, std::vector<double>> answers_;
  std::vector<msg::SessionKind> requests_;
  std::function<void()> begun_ = [] {};
  std::function<void()> stopped_ = [] {};
  std::function<void(int64_t)> answered_ = [](int64_t) {};
};

TEST_F(SpokenTest, ALedConversationEndsInWhatTheMouthSaid) {
  begun_ = [this] {
    Ask(1, {"Yes", "No"}, msg::QueryKind::kFull);
    Answer(1, "no", 3 * kSecond);
  };
  answered_ = [this](int64_t id) {
    if (id == 1) {
      Ask(2, {"Open the carton", "Squeeze the tube", "None of these"}, msg::QueryKind::kChoice);
      Answer(2, "open the carton", 2 * kSecond);
    } else {
      Announce(msg::SessionKind::kConfirmed, "Open the carton.");
    }
  };
  Run("[\"true\"]");
  ASSERT_EQ(answers_.size(), 2u);
  EXPECT_EQ(answers_[1].size(), 2u);
  EXPECT_EQ(answers_[1][1], 1) << "no";
  EXPECT_LT(answers_[1][0], 1);
  EXPECT_EQ(answers_[2].size(), 3u);
  EXPECT_EQ(answers_[2][0], 1) << "open the carton";
}

TEST_F(SpokenTest, StopDuringAPromptStopsAtOnceAndEndsThePrompt) {
  begun_ = [this] {
    Ask(1, {"Yes", "No"}, msg::QueryKind::kFull);
    Say("stop", 3 * kSecond);
  };
  Utime stopped_at = 0;
  stopped_ = [&] {
    if (stopped_at == 0) stopped_at = steady_.Now();
    loop_.Stop();
  };
  const Utime begin = steady_.Now();
  Run("[\"sleep\", \"100\"]");
  EXPECT_THAT(requests_, ::testing::Contains(msg::SessionKind::kRequestStop));
  EXPECT_LT(stopped_at - begin, 90 * kSecond) << "the prompt takes 100 s";
  EXPECT_TRUE(answers_.empty());
}

TEST_F(SpokenTest, OtherSpeechIsNoAnswer) {
  begun_ = [this] {
    Ask(1, {"Yes", "No"}, msg::QueryKind::kFull);
    Say("the weather is fine today", 2 * kSecond);
    Say("I would like some tea please", 6 * kSecond);
    Answer(1, "yes", 12 * kSecond);
  };
  answered_ = [this](int64_t) { Announce(msg::SessionKind::kConfirmed, "Done."); };
  Run("[\"true\"]");
  ASSERT_EQ(answers_.size(), 1u);
  EXPECT_EQ(answers_[1][0], 1) << "yes, not what was said before";
}

}  // namespace
}  // namespace beckon::ui_bridge
