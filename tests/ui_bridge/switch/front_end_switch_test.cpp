// The switch front end on a real bus, its switch a FIFO, against a scripted intention and a user
// who presses when they see what they want lit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/front_end.h"
#include "services/ui_bridge/service.h"
#include "tests/ui_bridge/switch/fifo_switch.h"

namespace beckon::ui_bridge {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::IsEmpty;
using Kind = msg::SessionKind;

/// Section [switch] with quick times, but for what `settings` say.
std::string Quick(const std::string& settings) {
  std::string text = "[switch]\n" + settings + "\n";
  for (const std::string quick :
       {"scan_time = 0.15", "first_delay = 0.1", "ignore_repeat = 0.02", "guard_time = 0.01",
        "stop_hold = 0.4", "rounds = 0", "dwell_time = 0.15", "long_press = 0.2"}) {
    if (settings.find(quick.substr(0, quick.find(' '))) == std::string::npos) text += quick + "\n";
  }
  return text;
}

std::unique_ptr<FrontEndFactory> SwitchFactory() {
  for (auto& factory : MakeFrontEndFactories()) {
    if (factory->name() == "switch") return std::move(factory);
  }
  return nullptr;
}

class FrontEndSwitchTest : public ::testing::Test {
 protected:
  void SetUp() override {
    loop_.AddFd(bus_->fd(), [this] { bus_->HandleReadable(); });
    loop_.After(30 * kSecond, [this] {
      ADD_FAILURE() << "not done after 30 s";
      loop_.Stop();
    });
    bus_->Subscribe<msg::Interface>([this](const msg::Interface& i) { interfaces_.push_back(i); });
    bus_->Subscribe<msg::Highlight>([this](const msg::Highlight& highlight) {
      highlights_.push_back(highlight);
      Press();
    });
    bus_->Subscribe<msg::Answer>([this](const msg::Answer& answer) { OnAnswer(answer); });
    bus_->Subscribe<msg::Session>([this](const msg::Session& request) { OnRequest(request); });
  }

  /// Starts it with a configuration that is read over quick times and the FIFO.
  void Start(const std::string& settings, int sessions = 1) {
    auto factory = SwitchFactory();
    ASSERT_NE(factory, nullptr);
    auto table =
        ConfigTable::Parse(Quick("device = '" + fifo_.path() + "'\n" + settings), "test.toml");
    ASSERT_TRUE(table) << table.error().message;
    factory->Configure(table->Section("switch"));
    ASSERT_TRUE(table->Finish()) << table->Finish().error().message;
    service_ = std::make_unique<Service>(
        ServiceConfig{
            .user = "ann", .device = "sw", .exit_after_sessions = sessions, .listen_us = 50'000},
        *bus_, loop_, clock_, steady_);
    const Status added = service_->Add(*factory);
    ASSERT_TRUE(added) << added.error().message;
    service_->Begin();
    ASSERT_TRUE(fifo_.Plug());
  }
  void Run() { loop_.Run(); }
  /// Runs until it holds.
  void Await(const std::function<bool()>& until) {
    const auto timer = loop_.Every(3'000, [&] {
      if (until()) loop_.Stop();
    });
    loop_.Run();
    loop_.Cancel(timer);
    ASSERT_TRUE(until());
  }

  // Intention.
  struct Question {
    msg::Query query;
    size_t wanted;  // option
  };
  Question Ask(std::vector<std::string> options, size_t wanted,
               msg::QueryKind kind = msg::QueryKind::kFull) {
    Question question;
    question.query.kind = kind;
    question.query.text = "Which?";
    for (auto& text : options) question.query.options.push_back({.text = text});
    if (kind == msg::QueryKind::kWhatIsIt) {
      question.query.any_object = false;
      question.query.objects = {{.object_id = 1, .category = msg::kUnknownCategory}};
      for (auto& option : question.query.options) option.category = option.text;
      question.query.options.back().category = msg::kUnknownCategory;
    }
    question.wanted = wanted;
    return question;
  }
  void AskNext() {
    if (script_.empty()) return Announce(Kind::kConfirmed);
    asked_ = script_.front();
    script_.pop_front();
    msg::Query& query = asked_->query;
    query.utime = clock_.Now();
    query.id = ++last_id_;
    query.session_id = session_;
    query.user = "ann";
    query.scene_seq = 1;
    query.questions_asked = static_cast<int>(answers_.size());
    ASSERT_TRUE(bus_->Publish(query));
  }
  void Announce(Kind kind) {
    msg::Session event;
    event.utime = clock_.Now();
    event.session_id = kind == Kind::kIdle ? "" : session_;
    event.user = "ann";
    event.kind = kind;
    event.questions = static_cast<int>(answers_.size());
    ASSERT_TRUE(bus_->Publish(event));
  }
  void OnRequest(const msg::Session& request) {
    if (request.kind >= Kind::kIdle) return;
    requests_.push_back(request.kind);
    switch (request.kind) {
      case Kind::kRequestStart:
        if (request.session_id == session_) return;
        session_ = request.session_id;
        if (!scripts_.empty()) {
          script_ = scripts_.front();
          scripts_.pop_front();
        }
        Announce(Kind::kBegun);
        return AskNext();
      case Kind::kRequestStop:
        if (!deaf_) Announce(Kind::kStopped);
        return;
      case Kind::kRequestResume:
        return Announce(Kind::kIdle);
      default:
        return;
    }
  }
  void OnAnswer(const msg::Answer& answer) {
    answers_.push_back(answer);
    ASSERT_TRUE(asked_);
    EXPECT_EQ(answer.query_id, asked_->query.id) << "an answer to another question";
    if (answer.query_id == asked_->query.id && answered_ids_.insert(answer.query_id).second) {
      EXPECT_EQ(answer.likelihoods, OneHot(asked_->wanted, asked_->query.options.size()));
      if (!slow_) AskNext();
    }
  }

  // The user. In the loop's thread like the front end: what they see lit is lit when they press.
  enum class How { kNotAtAll, kAutomatic, kStep, kInverse };
  bool Wanted() const {
    if (highlights_.empty()) return false;
    const auto& lit = highlights_.back();
    if (!wanted_control_.empty()) {
      return std::ranges::find(lit.controls, wanted_control_) != lit.controls.end();
    }
    return asked_ && lit.query_id == asked_->query.id &&
           std::ranges::find(lit.options, static_cast<int>(asked_->wanted)) != lit.options.end();
  }
  void Press() {
    if (busy_ || how_ == How::kNotAtAll) return;
    switch (how_) {
      case How::kAutomatic:
        return Later(30'000, [this] {
          if (Wanted()) Tap(KEY_SPACE);
        });
      case How::kStep:
        return Later(30'000, [this] {
          const auto& lit = highlights_.back();
          if (!wanted_control_.empty() || (asked_ && lit.query_id == asked_->query.id)) {
            Tap(Wanted() ? KEY_ENTER : KEY_SPACE);
          }
        });
      case How::kInverse:
        return Later(20'000, [this] {
          if (held_ && Wanted()) {
            held_ = !fifo_.Key(0);
          } else if (!held_ && asked_ && !answered_ids_.contains(asked_->query.id)) {
            held_ = fifo_.Key(1);
          }
        });
      case How::kNotAtAll:
        return;
    }
  }
  void Later(Utime delay, std::function<void()> then) {
    busy_ = true;
    loop_.After(delay, [this, then = std::move(then)] {
      busy_ = false;
      then();
      if (!busy_) Poll();
    });
  }
  /// Looks again even where nothing changes.
  void Poll() {
    if (!busy_) {
      busy_ = true;
      loop_.After(20'000, [this] {
        busy_ = false;
        Press();
      });
    }
  }
  void Tap(int key) {
    fifo_.Key(1, key);
    busy_ = true;
    loop_.After(30'000, [this, key] {
      fifo_.Key(0, key);
      loop_.After(40'000, [this] {
        busy_ = false;
        Poll();
      });
    });
  }

  std::deque<Question> AllKinds() {
    return {Ask({"Yes", "No"}, 1),
            Ask({"Open the carton", "Use the mug", "Move the tin", "None of these"}, 2,
                msg::QueryKind::kChoice),
            Ask({"Cup", "Mug", "None of these"}, 2, msg::QueryKind::kWhatIsIt),
            Ask({"Yes", "No"}, 0)};
  }
  /// Whether the front end lights this control, alone or in a group.
  bool Lit(const std::string& control) const {
    return !highlights_.empty() && std::ranges::find(highlights_.back().controls, control) !=
                                       highlights_.back().controls.end();
  }
  int Requests(Kind kind) const { return static_cast<int>(std::ranges::count(requests_, kind)); }

  SystemClock clock_;
  SteadyClock steady_;
  RunLoop loop_;
  std::unique_ptr<Bus> bus_ = std::move(*Bus::Open("memq://"));
  FifoSwitch fifo_;
  std::unique_ptr<Service> service_;

  std::deque<std::deque<Question>> scripts_;  // one a session
  std::deque<Question> script_;
  std::optional<Question> asked_;
  std::string session_;
  int64_t last_id_ = 100;
  bool deaf_ = false;  // intention does not hear a stop
  bool slow_ = false;  // it asks nothing after an answer

  How how_ = How::kAutomatic;
  std::string wanted_control_;
  bool busy_ = false;
  bool held_ = false;

  std::vector<msg::Interface> interfaces_;
  std::vector<msg::Highlight> highlights_;
  std::vector<msg::Answer> answers_;
  std::set<int64_t> answered_ids_;
  std::vector<Kind> requests_;
};

struct Way {
  const char* name;
  const char* settings;
  bool step = false;
  bool inverse = false;
};

class WholeConversation : public FrontEndSwitchTest, public ::testing::WithParamInterface<Way> {};

TEST_P(WholeConversation, AnswersEveryQuestionOnceWithWhatIsWanted) {
  how_ = GetParam().step ? How::kStep : GetParam().inverse ? How::kInverse : How::kAutomatic;
  scripts_ = {AllKinds()};
  ASSERT_NO_FATAL_FAILURE(Start(GetParam().settings));
  Run();
  EXPECT_EQ(answered_ids_.size(), 4u);
  ASSERT_FALSE(interfaces_.empty());
  EXPECT_EQ(interfaces_[0].kind, msg::InterfaceKind::kScan);
  EXPECT_EQ(interfaces_[0].max_options, 6);
  EXPECT_GT(interfaces_[0].seconds_per_question, 0);
  EXPECT_FLOAT_EQ(interfaces_[0].false_yes, 0.02f);
}

INSTANTIATE_TEST_SUITE_P(
    EveryMethod, WholeConversation,
    ::testing::Values(
        Way{"Automatic", "method = 'automatic'"},
        Way{"AutomaticOnPress", "accept = 'press'\nhold_time = 0.01"},
        Way{"AutomaticRows", "grouping = 'row-column'\ncolumns = 2"},
        Way{"AutomaticBinary", "grouping = 'binary'\nback = 'entry'"},
        Way{"Step", "method = 'step'\nselect_key = 'KEY_ENTER'", true},
        Way{"StepRows",
            "method = 'step'\nselect_key = 'KEY_ENTER'\ngrouping = 'row-column'\ncolumns = 2",
            true},
        Way{"Inverse", "method = 'inverse'", false, true},
        Way{"InverseBinary", "method = 'inverse'\ngrouping = 'binary'", false, true}),
    [](const auto& way) { return std::string(way.param.name); });

TEST_F(FrontEndSwitchTest, HoldingStopsAtOnceAndOnlyADeliberateResumeLeadsOut) {
  how_ = How::kNotAtAll;
  scripts_ = {AllKinds(), {}};
  Start("", 0);
  Await(
      [this] { return asked_.has_value() && !highlights_.empty() && highlights_.back().query_id; });
  const Utime pressed = steady_.Now();
  fifo_.Key(1);
  Await([this] { return Requests(Kind::kRequestStop) > 0; });
  EXPECT_GE(steady_.Now() - pressed, 395'000);
  fifo_.Key(0);
  Await([this] { return Lit("resume"); });
  EXPECT_THAT(service_->State(), ::testing::HasSubstr("stopped"));
  how_ = How::kAutomatic;
  wanted_control_ = "resume";
  Poll();
  Await([this] { return Requests(Kind::kRequestResume) > 0; });
  wanted_control_ = "start";
  Await([this] { return Requests(Kind::kRequestStart) > 1 && asked_; });
  EXPECT_THAT(answers_, IsEmpty());
}

TEST_F(FrontEndSwitchTest, WhoCannotHoldFindsStopLitWhileTheyWaitForTheNextQuestion) {
  scripts_ = {AllKinds()};
  slow_ = true;
  Start("stop_hold = 0", 0);
  Await([this] { return !answers_.empty(); });
  wanted_control_ = "stop";
  Await([this] { return Requests(Kind::kRequestStop) > 0; });
  EXPECT_EQ(answered_ids_.size(), 1u);
}

TEST_F(FrontEndSwitchTest, StaysStoppedWhileIntentionHasNotHeardOfIt) {
  how_ = How::kNotAtAll;
  deaf_ = true;
  scripts_ = {AllKinds()};
  Start("", 0);
  Await([this] { return asked_.has_value(); });
  fifo_.Key(1);
  Await([this] { return Requests(Kind::kRequestStop) > 0; });
  fifo_.Key(0);
  msg::Session begun;
  begun.utime = clock_.Now();
  begun.session_id = session_;
  begun.user = "ann";
  begun.kind = Kind::kBegun;
  begun.text = "Waiting for the poses.";  // said before it heard
  ASSERT_TRUE(bus_->Publish(begun));
  Await([this] { return Requests(Kind::kRequestStop) > 1; });  // repeated
  EXPECT_THAT(service_->State(), ::testing::HasSubstr("stopped"));
}

TEST_F(FrontEndSwitchTest, APressHeldOverAChangeOfQuestionAnswersNeither) {
  how_ = How::kNotAtAll;
  scripts_ = {AllKinds()};
  Start("", 0);
  Await([this] { return !highlights_.empty() && highlights_.back().query_id == 101; });
  fifo_.Key(1);
  Await([this] { return highlights_.back().pressed; });
  AskNext();  // superseded
  Await([this] { return highlights_.back().query_id == 102; });
  fifo_.Key(0);
  Await([this] { return !highlights_.back().pressed; });
  Await([this] { return highlights_.back().options == std::vector{1}; });
  EXPECT_THAT(answers_, IsEmpty());
  how_ = How::kAutomatic;
  Poll();
  Await([this] { return answers_.size() == 1; });
}

TEST_F(FrontEndSwitchTest, ASwitchUnpluggedWhileHeldChoosesNothingAndWorksAgainWhenItIsBack) {
  how_ = How::kNotAtAll;
  scripts_ = {AllKinds()};
  Start("", 1);
  Await([this] { return !highlights_.empty() && highlights_.back().query_id == 101; });
  fifo_.Key(1);
  Await([this] { return highlights_.back().pressed; });
  fifo_.Unplug();
  Await([this] { return !highlights_.back().pressed; });
  EXPECT_THAT(service_->State(), ::testing::HasSubstr("switch:"));
  Await([this] { return fifo_.Plug(); });
  EXPECT_THAT(answers_, IsEmpty());
  EXPECT_EQ(Requests(Kind::kRequestStop), 0);
  how_ = How::kAutomatic;
  Poll();
  Run();
  EXPECT_EQ(answered_ids_.size(), 4u);
}

TEST_F(FrontEndSwitchTest, BouncingContactsAndKeyRepeatsAreOnePress) {
  how_ = How::kNotAtAll;
  scripts_ = {AllKinds()};
  Start("method = 'step'\nselect_key = 'KEY_ENTER'\nignore_repeat = 0", 0);
  Await([this] { return !highlights_.empty() && highlights_.back().query_id == 101; });
  Await([this, seen = steady_.Now()] { return steady_.Now() - seen > 30'000; });  // the guard time
  int64_t at_us = 1'000'000;
  for (const int value : {1, 0, 1, 0, 1, 2, 2, 2}) fifo_.Key(value, KEY_SPACE, at_us += 1'000);
  Await([this] { return highlights_.back().pressed; });
  for (const int value : {2, 0, 1, 0}) fifo_.Key(value, KEY_SPACE, at_us += 1'000);
  Await([this] {
    return !highlights_.back().pressed && highlights_.back().options != std::vector{0};
  });
  EXPECT_THAT(highlights_.back().options, ElementsAre(1)) << "one step, not three";
}

TEST_F(FrontEndSwitchTest, TwoSwitchesAtOnceAreOnePress) {
  how_ = How::kNotAtAll;
  scripts_ = {AllKinds()};
  Start("method = 'step'\nselect_key = 'KEY_ENTER'", 0);
  Await([this] { return !highlights_.empty() && highlights_.back().query_id == 101; });
  Await([this, seen = steady_.Now()] { return steady_.Now() - seen > 30'000; });  // the guard time
  fifo_.Key(1, KEY_SPACE, 1'000'000);
  fifo_.Key(1, KEY_ENTER, 1'000'000);
  Await([this] { return highlights_.back().pressed; });
  fifo_.Key(0, KEY_ENTER, 1'200'000);
  fifo_.Key(0, KEY_SPACE, 1'200'000);
  Await([this] { return !highlights_.back().pressed; });
  EXPECT_THAT(answers_, IsEmpty());
  EXPECT_THAT(highlights_.back().options, ElementsAre(1)) << "the first of them moved";
}

TEST_F(FrontEndSwitchTest, UndoIsAmongTheControls) {
  scripts_ = {AllKinds()};
  Start("", 0);
  Await([this] { return answers_.size() == 1; });
  wanted_control_ = "undo";  // lit as part of the group, then alone
  Await([this] { return Requests(Kind::kRequestUndo) > 0; });
  EXPECT_EQ(answers_.size(), 1u);
}

TEST_F(FrontEndSwitchTest, StartsOverWhenIntentionComesBackWithoutItsConversation) {
  how_ = How::kNotAtAll;
  scripts_ = {AllKinds(), {Ask({"Yes", "No"}, 1)}};
  Start("", 1);
  Await([this] { return !highlights_.empty() && highlights_.back().query_id == 101; });
  session_.clear();  // killed, and back
  Announce(Kind::kIdle);
  Await([this] { return highlights_.back().query_id == 102; });
  how_ = How::kAutomatic;
  Poll();
  Run();
  EXPECT_THAT(answered_ids_, ElementsAre(102));
}

TEST_F(FrontEndSwitchTest, OffersAnotherTaskByOnePress) {
  scripts_ = {{Ask({"Yes", "No"}, 0)}, {Ask({"Yes", "No"}, 1)}};
  Start("", 2);
  Await([this] { return answers_.size() == 1; });
  Await([this] { return Lit("start"); });
  EXPECT_EQ(Requests(Kind::kRequestStart), 1);
  wanted_control_ = "start";
  Await([this] { return Requests(Kind::kRequestStart) == 2; });
  wanted_control_.clear();
  Run();
  EXPECT_EQ(answered_ids_.size(), 2u);
}

class Suggestion : public FrontEndSwitchTest {
 protected:
  /// What an option costs before and after the user says `answer` to the suggestion.
  std::pair<float, float> SecondsPerOption(const std::string& answer) {
    scripts_ = {{}};
    for (int i = 0; i < 14; ++i) scripts_[0].push_back(Ask({"Yes", "No"}, 1));
    Start("", 0);
    Await([this] { return Lit("accept"); });
    const float before = interfaces_.back().seconds_per_option;
    wanted_control_ = answer;
    Await([this] { return Lit("start"); });
    interfaces_.clear();
    Await([this] { return !interfaces_.empty(); });
    return {before, interfaces_.back().seconds_per_option};
  }
};

TEST_F(Suggestion, OfAScanTimeIsTakenWhenItIsAccepted) {
  const auto [before, after] = SecondsPerOption("accept");
  EXPECT_GT(after, before);  // these presses are quick, but 0.3 s is the shortest that is suggested
}

TEST_F(Suggestion, OfAScanTimeChangesNothingWhenItIsNot) {
  const auto [before, after] = SecondsPerOption("keep");
  EXPECT_FLOAT_EQ(after, before);
}

TEST_F(FrontEndSwitchTest, TellsWhatIsLitOnEveryChangeAndOnceASecond) {
  how_ = How::kNotAtAll;
  scripts_ = {AllKinds()};
  Start("method = 'step'\nselect_key = 'KEY_ENTER'", 0);
  Await([this] { return !highlights_.empty() && highlights_.back().query_id == 101; });
  const size_t before = highlights_.size();
  Await([&] { return highlights_.size() >= before + 2; });  // nothing changes
  const auto& lit = highlights_.back();
  EXPECT_EQ(lit.device, "sw");
  EXPECT_EQ(lit.user, "ann");
  EXPECT_THAT(lit.options, ElementsAre(0));
  EXPECT_EQ(lit.dwell_ms, 0);
}

TEST_F(FrontEndSwitchTest, GoesOnWithoutAVoiceThatIsMissing) {
  scripts_ = {AllKinds()};
  Start("audio = true\nvoice = ['/nonexistent/voice']\nseconds_a_letter = 0");
  Run();
  EXPECT_EQ(answered_ids_.size(), 4u);
}

}  // namespace
}  // namespace beckon::ui_bridge
