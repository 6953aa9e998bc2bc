// A person with a decoder at their head: intention and the front end bci in one thread, on a clock
// that jumps, so that an hour's session takes milliseconds.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bench/bci/list_memory.h"
#include "services/intention/core/conversation.h"
#include "services/intention/core/evaluation.h"
#include "services/ui_bridge/bci/announcement.h"
#include "services/ui_bridge/bci/session_trials.h"
#include "services/ui_bridge/bci/simulated_decoding.h"
#include "services/ui_bridge/bci/trials.h"
#include "services/ui_bridge/dialogue.h"

namespace beckon::bench {

struct PersonConfig {
  ui_bridge::bci::TrialsConfig trials;
  double accuracy = 0.7;    // of single trials
  double sharpness = 1;     // above 1: the decoder is surer than it ought to be
  double trial_s = 3;       // s, from the start of a trial to its decoding
  double slip = 0;          // share of questions in which another option is attended to
  bool names_only = false;  // says which class and no more
  bool learns = true;       // calibrates
  uint64_t seed = 1;
};

struct Lived {
  enum class End { kRight, kWrong, kAbandoned, kStopped, kTooLong };
  End end = End::kTooLong;
  int questions = 0;
  int trials = 0;
  double seconds = 0;
  double posterior = 0;
};

class Person final : public ui_bridge::DialogueOutput, public ui_bridge::bci::TrialsOutput {
 public:
  Person(const intention::Affordances& affordances, const intention::Policy& policy,
         const PersonConfig& config);

  /// One session. What is wanted is on the table.
  Lived Live(const intention::ScenarioSession& session);

 private:
  void Step();
  void Announce();
  void ShowTable();
  void Do(intention::Actions actions);
  void Hear(const intention::Outgoing& said);
  void Decode();

  // DialogueOutput
  void Send(const msg::Answer& answer) override;
  void Send(const msg::Session& request) override;
  void Present(const msg::Query& query) override;
  void Withdraw() override;
  void ShowSession(const msg::Session& event) override;
  void ShowUser(const std::string&) override {}
  // TrialsOutput
  void Stimulate(const msg::Stimulus& stimulus) override;
  void Answer(const msg::Query& query, const std::vector<double>& likelihoods,
              const std::vector<std::vector<double>>& trials) override;
  void Request(msg::SessionKind request) override;
  void ShowNotice(const std::string&) override {}
  ui_bridge::bci::DecoderModel ModelOf(const std::string&) override;

  const intention::Affordances& affordances_;
  const PersonConfig config_;
  std::mt19937_64 random_;
  ManualClock clock_{1'767'571'200 * kSecond};
  ListMemory memory_;
  intention::Conversation conversation_;
  ui_bridge::Dialogue dialogue_;
  ui_bridge::bci::Trials trials_;
  ui_bridge::bci::Calibration calibration_;
  ui_bridge::bci::SessionTrials session_trials_;
  ui_bridge::bci::SimulatedDecoding decoder_;
  msg::Interface interface_;
  std::deque<std::function<void()>> later_;  // what was sent and not heard yet
  int64_t ids_ = 0;
  int64_t scenes_ = 0;
  Utime next_second_ = 0;
  const intention::ScenarioSession* session_ = nullptr;
  msg::Task wanted_;
  std::optional<msg::Query> query_;
  std::optional<size_t> meant_;  // option of the question
  std::optional<msg::Stimulus> stimulus_;
  int64_t decoded_ = 0;
  Lived lived_;
  bool over_ = false;
};

}  // namespace beckon::bench
