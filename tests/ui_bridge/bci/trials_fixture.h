// Trials with everything that they say written down, on a clock that stands.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "services/ui_bridge/bci/trials.h"

namespace beckon::ui_bridge::bci {

class TrialsRecorder final : public TrialsOutput {
 public:
  void Stimulate(const msg::Stimulus& stimulus) override {
    if (stimuli.empty() || stimuli.back().trial != stimulus.trial) {
      stimuli.push_back(stimulus);
    } else {
      ++repeated;
    }
  }
  void Answer(const msg::Query& query, const std::vector<double>& likelihoods,
              const std::vector<std::vector<double>>& trials) override {
    answered.push_back(query.id);
    answers.push_back(likelihoods);
    behind.push_back(trials);
  }
  void Request(msg::SessionKind request) override { requests.push_back(request); }
  void ShowNotice(const std::string& text) override { notices.push_back(text); }
  DecoderModel ModelOf(const std::string& decoder) override {
    decoders.push_back(decoder);
    return {.sharpness = 1};
  }

  std::vector<msg::Stimulus> stimuli;
  int repeated = 0;
  std::vector<int64_t> answered;
  std::vector<std::vector<double>> answers;
  std::vector<std::vector<std::vector<double>>> behind;
  std::vector<msg::SessionKind> requests;
  std::vector<std::string> notices;
  std::vector<std::string> decoders;
};

/// A 2 x 2 matrix, its last cell "stop", unless a test says otherwise.
class TrialsTest : public ::testing::Test {
 protected:
  void Make() { trials_.emplace(config_, "bci@here", 1000, out_); }

  void Begin() {
    Make();
    trials_->Requested();
    trials_->OnSession(msg::SessionKind::kBegun, now_);
  }

  void Pass(double seconds) {
    const Utime end = now_ + static_cast<Utime>(seconds * 1e6);
    for (; now_ < end; now_ += 50'000) trials_->Tick(now_);
  }

  /// Ticks until a trial runs; false after 60 s.
  bool AwaitTrial() {
    for (int i = 0; i < 1200 && trials_->trial() == 0; ++i) Pass(0.05);
    return trials_->trial() != 0;
  }

  msg::Query Question(int64_t id, size_t options = 3) const {
    msg::Query query;
    query.id = id;
    query.session_id = "s";
    query.text = "What?";
    query.questions_asked = 1;
    for (size_t i = 0; i < options; ++i)
      query.options.push_back({.text = "Option " + std::to_string(i)});
    return query;
  }

  msg::Decoding Decoding(size_t likeliest, double p = 0.9) const {
    msg::Decoding decoding;
    decoding.decoder = "cap";
    decoding.device = "bci@here";
    decoding.trial = trials_->trial();
    const size_t classes = trials_->layout().labels.size();
    decoding.probabilities.assign(classes, (1 - p) / static_cast<double>(classes - 1));
    decoding.probabilities[likeliest] = p;
    return decoding;
  }

  /// The next trial comes out so.
  void Decode(size_t likeliest, double p = 0.9) {
    ASSERT_TRUE(AwaitTrial());
    ASSERT_FALSE(trials_->OnDecoding(Decoding(likeliest, p), now_));
  }

  Refusal WhyRefused(const msg::Decoding& decoding) {
    const auto refused = trials_->OnDecoding(decoding, now_);
    EXPECT_TRUE(refused.has_value());
    return refused ? refused->why : static_cast<Refusal>(-1);
  }

  TrialsConfig config_{.layout = {.controls = {Control::kStop}}};
  TrialsRecorder out_;
  std::optional<Trials> trials_;
  Utime now_ = kSecond;
};

}  // namespace beckon::ui_bridge::bci
