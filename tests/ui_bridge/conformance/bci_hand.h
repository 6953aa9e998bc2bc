// A decoder that knows what its user wants: answers a STIMULUS where the wanted thing is among its
// labels, and is silent otherwise.
#pragma once

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/ui_bridge/conformance/hand.h"

namespace beckon::ui_bridge::conformance {

class BciHand : public Hand {
 public:
  std::string front_end() const override { return "bci"; }
  std::string config() const override {
    return "[bci]\nrows = 2\ncolumns = 3\ncontrols = [\"undo\", \"stop\"]\nread_s = 0.05\n"
           "pause_s = 0.01\nrest_s = 0.1\ntrial_s = 0.05\nlearn = false\n"
           "calibration_dir = \"/tmp/beckon-bci-hand\"\n";
  }

  void Begin(const HandSetup& setup) override {
    setup_.emplace(setup);
    setup_->bus.Subscribe<msg::Stimulus>([this](const msg::Stimulus& stimulus) {
      if (stimulus.device != setup_->device) return;
      stimulus_ = stimulus;
      Look();
    });
  }
  void Start() override { Want({"Another task"}); }
  size_t Choose(const msg::Query& query, size_t option) override {
    wanted_.clear();
    query_id_ = query.id;
    option_ = option;
    Look();
    return option;
  }
  bool Stop() override { return Want({"STOP"}); }
  bool Resume() override { return Want({"Go on", "Yes, go on"}); }
  bool Undo() override { return Want({"Undo"}); }

 protected:
  /// Probability of the class that is meant, and how long a trial takes.
  virtual double sureness() const { return 0.9; }
  virtual Utime trial_us() const { return 1; }

 private:
  bool Want(const std::vector<std::string>& labels) {
    wanted_ = labels;
    query_id_ = 0;
    Look();
    return true;
  }

  std::optional<size_t> Wanted() const {
    if (query_id_ != 0) {
      if (stimulus_->query_id == query_id_) return option_;
      return std::nullopt;
    }
    const auto& labels = stimulus_->labels;
    for (const auto& label : wanted_) {
      const auto found = std::ranges::find(labels, label);
      if (found != labels.end()) return static_cast<size_t>(found - labels.begin());
    }
    return std::nullopt;
  }

  void Look() {
    if (!stimulus_ || stimulus_->trial == decoded_) return;
    const auto wanted = Wanted();
    if (!wanted) return;
    decoded_ = stimulus_->trial;
    const size_t classes = stimulus_->labels.size();
    msg::Decoding decoding;
    decoding.utime = stimulus_->utime;
    decoding.decoder = "hand";
    decoding.device = stimulus_->device;
    decoding.trial = stimulus_->trial;
    decoding.probabilities.assign(classes, (1 - sureness()) / static_cast<double>(classes - 1));
    decoding.probabilities[*wanted] = sureness();
    setup_->loop.After(trial_us(), [this, decoding] {
      if (!setup_->bus.Publish(decoding)) throw std::runtime_error("a DECODING was not sent");
    });
  }

  std::optional<HandSetup> setup_;
  std::optional<msg::Stimulus> stimulus_;
  int64_t decoded_ = 0;
  int64_t query_id_ = 0;  // whose option is wanted; 0: a label
  size_t option_ = 0;
  std::vector<std::string> wanted_;  // labels
};

}  // namespace beckon::ui_bridge::conformance
