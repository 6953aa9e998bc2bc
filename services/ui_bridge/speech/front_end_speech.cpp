// Front end "speech": questions are spoken, answers are words. What was heard goes on as
// likelihoods; what was not understood is asked again.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <utility>

#include "services/base/app.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/front_end.h"
#include "services/ui_bridge/speech/config.h"
#include "services/ui_bridge/speech/ears.h"
#include "services/ui_bridge/speech/prompt.h"
#include "services/ui_bridge/speech/speaker.h"
#include "services/ui_bridge/speech/turn.h"

namespace beckon::ui_bridge {
namespace {

using namespace speech;
using Request = msg::SessionKind;

constexpr int kMostPardons = 2;  // in a row: more would talk to a television set
constexpr int kWordFrames = 15;  // shorter noises are not answered

class SpeechFrontEnd final : public FrontEnd {
 public:
  SpeechFrontEnd(const SpeechConfig& config, const FrontEndSetup& setup)
      : config_(config),
        setup_(setup),
        times_(config.speaker.espeak.words_per_minute),
        speaker_(
            config.speaker, setup.loop,
            {.begun = [this](const auto& samples) { PromptBegun(samples); },
             .over = [this](bool whole) { PromptOver(whole); },
             .failed = [](const std::string& why) { spdlog::error("speech: prompts: {}", why); }}),
        ears_(config.ears, setup.loop,
              {.speaking = [this] { BargeIn(); },
               .heard = [this](const Hearing& hearing) { Heard(hearing); },
               .microphone = [this](bool runs, const std::string& why) { Microphone(runs, why); },
               .failed = [](const std::string& why) { spdlog::error("speech: {}", why); }}) {}
  ~SpeechFrontEnd() override { CancelAskAgain(); }

  msg::Interface Announce() const override {
    msg::Interface interface;
    interface.kind =
        config_.kind == "yesno" ? msg::InterfaceKind::kYesNo : msg::InterfaceKind::kChoice;
    interface.max_options = config_.max_options;
    interface.seconds_per_question = times_.seconds_per_question();
    interface.seconds_per_option = times_.seconds_per_option();
    interface.false_yes = static_cast<float>(config_.false_yes);
    interface.false_no = static_cast<float>(config_.false_no);
    return interface;
  }

  void Begin() override {
    ExpectNow();
    ears_.Start();
    setup_.sink.Request(Request::kRequestStart);
  }

  void Present(const msg::Query& query) override {
    query_ = query;
    answered_ = false;
    pardons_ = repeats_ = 0;
    ExpectNow();
    Ask("");
  }

  void Withdraw() override {
    query_.reset();
    asking_ = false;
    CancelAskAgain();
    speaker_.Hush();
    ExpectNow();
  }

  void ShowSession(const msg::Session& event) override {
    stopped_ = event.kind == msg::SessionKind::kStopped;
    if (event.kind == msg::SessionKind::kBegun) in_session_ = true;
    if (const std::string text = SessionPrompt(event); !text.empty()) Say(text);
    const bool over = event.kind == msg::SessionKind::kConfirmed ||
                      event.kind == msg::SessionKind::kAbandoned ||
                      event.kind == msg::SessionKind::kIdle;
    if (!over || !std::exchange(in_session_, false)) return;
    query_.reset();
    ExpectNow();
    if (++sessions_ == setup_.exit_after_sessions) {
      // What was reached is said to its end.
      if (speaker_.busy()) return void(finishing_ = true);
      setup_.sink.Finish();
    }
  }

  void ShowNotice(const std::string& text) override { Say(text); }

  void ShowTaskStatus(const msg::TaskStatus& status) override {
    if (status.state != msg::TaskState::kAccepted && status.state != msg::TaskState::kRunning)
      Say(status.text);
  }

  std::string State() const override {
    std::string state = !ears_.running()      ? "has no microphone"
                        : stopped_            ? "stopped"
                        : query_ && answered_ ? "answered"
                        : query_              ? "listens for an answer"
                                              : "waits for a question";
    return state + "; heard " + std::to_string(ears_.segments()) + ", understood " +
           std::to_string(understood_);
  }

 private:
  /// Nobody is asked anything while a prompt that says something else would be cut off by it: they
  /// follow each other.
  void Say(const std::string& text) {
    if (text.empty()) return;
    before_question_ = text;
    if (query_ && !answered_ && asking_) return Ask("");
    asking_ = false;
    speaker_.Say(text);
  }

  void Ask(const std::string& first) {
    if (!query_) return;
    CancelAskAgain();
    std::string text = first.empty() ? std::exchange(before_question_, {}) : first;
    if (!text.empty()) text += " ";
    asking_ = true;
    speaker_.Say(text + QuestionPrompt(*query_, config_.words.number, !hinted_));
    hinted_ = true;
  }

  void ExpectNow() {
    ears_.Expect(CommandsFor(query_ ? &*query_ : nullptr, config_.words), query_ ? query_->id : 0);
  }

  void PromptBegun(const std::vector<int16_t>& samples) {
    prompt_s_ = static_cast<double>(samples.size()) / kSampleRate;
    ears_.PromptBegins(samples);
  }

  void PromptOver(bool whole) {
    ears_.PromptEnds();
    if (whole) before_question_.clear();
    if (whole && asking_ && query_) {
      const auto options = static_cast<int>(query_->options.size());
      times_.Spoken(IsYesNo(*query_) ? 0 : options, prompt_s_);
      AskAgainLater();
    }
    if (finishing_ && !speaker_.busy()) setup_.sink.Finish();
  }

  void BargeIn() {
    if (speaker_.busy()) speaker_.Hush();
    CancelAskAgain();
  }

  void Heard(const Hearing& hearing) {
    const size_t options = query_ ? query_->options.size() : 0;
    const Decision decision =
        Decide(hearing.heard, *hearing.grammar, hearing.ended, options, config_.turn);
    if (decision.kind == Decision::Kind::kStop) return Stop();
    if (!hearing.ended) return;
    // What was begun before the question stood is no answer to it.
    const bool current = hearing.tag == (query_ ? query_->id : 0) && !ears_.IsOld(hearing);
    if (decision.kind == Decision::Kind::kNotUnderstood || !current) {
      if (query_ && !answered_ && hearing.loud_frames >= kWordFrames) NotUnderstood();
      return;
    }
    if (decision.kind == Decision::Kind::kCommand) Do(decision);
  }

  /// What is stopped already is not stopped again: a word is heard as it begins and once it is
  /// over.
  void Stop() {
    if (!stopped_) setup_.sink.Request(Request::kRequestStop);
    speaker_.Hush();
    ++understood_;
  }

  void Do(const Decision& decision) {
    ++understood_;
    pardons_ = 0;
    switch (decision.command.kind) {
      case CommandKind::kOption:
        if (!query_ || std::exchange(answered_, true)) return;
        return setup_.sink.Answer(query_->id, decision.likelihoods);
      case CommandKind::kNone:
        if (!query_ || std::exchange(answered_, true)) return;
        return setup_.sink.Request(Request::kRequestNoneOfThese);
      case CommandKind::kUndo:
        return setup_.sink.Request(Request::kRequestUndo);
      case CommandKind::kStop:
        return Stop();
      case CommandKind::kResume:
        if (stopped_) setup_.sink.Request(Request::kRequestResume);
        return;
      case CommandKind::kStart:
        if (!in_session_ && !stopped_) setup_.sink.Request(Request::kRequestStart);
        return;
      case CommandKind::kRepeat:
        return Ask("");
    }
  }

  void NotUnderstood() {
    if (pardons_++ < kMostPardons) return Ask("Pardon?");
    AskAgainLater();
  }

  void AskAgainLater() {
    CancelAskAgain();
    if (config_.ask_again_s <= 0 || answered_ || repeats_ >= config_.ask_again_times) return;
    ask_again_ = setup_.loop.After(static_cast<Utime>(config_.ask_again_s * kSecond), [this] {
      ask_again_.reset();
      if (!query_ || answered_ || ears_.speaking()) return;
      ++repeats_;
      pardons_ = 0;
      Ask("");
    });
  }

  void CancelAskAgain() {
    if (ask_again_) setup_.loop.Cancel(*std::exchange(ask_again_, std::nullopt));
  }

  void Microphone(bool runs, const std::string& reason) {
    if (runs) {
      spdlog::info("speech: the microphone works");
      if (std::exchange(lost_microphone_, false)) Say("I can hear you again.");
      return;
    }
    spdlog::error("speech: no microphone: {}; trying again", reason);
    lost_microphone_ = true;
    Say("I cannot hear you: the microphone is gone.");
  }

  const SpeechConfig config_;
  const FrontEndSetup setup_;
  PromptTimes times_;
  std::optional<msg::Query> query_;
  bool answered_ = false;
  bool asking_ = false;  // the prompt asks the question
  bool hinted_ = false;  // how to answer was said once
  bool stopped_ = false;
  bool in_session_ = false;
  bool finishing_ = false;
  bool lost_microphone_ = false;
  std::string before_question_;  // what was to be said, and perhaps was not
  double prompt_s_ = 0;
  int pardons_ = 0;
  int repeats_ = 0;
  int sessions_ = 0;
  int64_t understood_ = 0;
  std::optional<RunLoop::TimerId> ask_again_;
  Speaker speaker_;
  Ears ears_;
};

class SpeechFactory final : public FrontEndFactory {
 public:
  std::string name() const override { return "speech"; }
  std::string summary() const override { return "spoken questions, spoken answers"; }

  void AddOptions(CLI::App& app) override {
    app.add_option_group("speech", "Options of the speech front end")
        ->add_option("--speech-input", input_,
                     "Sound from a file or FIFO (16 bit, 16 kHz, one channel), not the microphone")
        ->type_name("FILE");
  }

  void Configure(ConfigTable table) override { ReadConfig(table, config_); }

  Result<std::unique_ptr<FrontEnd>> Create(const FrontEndSetup& setup) override {
    SpeechConfig config = config_;
    if (!input_.empty()) config.ears.source.input = input_;
    if (config.model_file.empty()) config.model_file = SharedFile("speech_model.toml");
    auto judgement = LoadJudgement(config.model_file);
    if (!judgement) return judgement.error();
    config.ears.recogniser.judgement = *judgement;
    if (auto right = CheckWords(config); !right) return right.error();
    return std::unique_ptr<FrontEnd>(std::make_unique<SpeechFrontEnd>(config, setup));
  }

 private:
  SpeechConfig config_;
  std::string input_;
};

const FrontEndRegistration kRegistration([]() -> std::unique_ptr<FrontEndFactory> {
  return std::make_unique<SpeechFactory>();
});

}  // namespace
}  // namespace beckon::ui_bridge
