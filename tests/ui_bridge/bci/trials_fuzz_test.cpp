// Whatever comes in whatever order: rules that always hold.
#include <limits>
#include <map>
#include <random>

#include "tests/ui_bridge/bci/trials_fixture.h"

namespace beckon::ui_bridge::bci {
namespace {

class TrialsFuzzTest : public TrialsTest {
 protected:
  size_t Below(size_t n) { return static_cast<size_t>(random_() % n); }

  double Odd() {
    static const std::vector<double> kOdd = {0,   1,        0.5,       -0.1,   1e-300, 1e300,
                                             NAN, INFINITY, -INFINITY, 1.0005, 0.25};
    return kOdd[Below(kOdd.size())];
  }

  msg::Decoding AnyDecoding() {
    auto decoding = Decoding(Below(trials_->layout().labels.size()), 0.3 + 0.69 * Uniform01());
    switch (Below(8)) {
      case 0:
        decoding.trial += static_cast<int64_t>(Below(5)) - 2;
        break;
      case 1:
        decoding.trial = static_cast<int64_t>(random_());
        break;
      case 2:
        decoding.device = Below(2) == 0 ? "" : "other";
        break;
      case 3:
        decoding.decoder = "net";
        break;
      case 4:
        decoding.probabilities.resize(Below(70), Odd());
        break;
      case 5:
        decoding.probabilities[Below(decoding.probabilities.size())] = Odd();
        break;
      default:
        break;
    }
    return decoding;
  }

  double Uniform01() { return static_cast<double>(random_() >> 11) * 0x1.0p-53; }

  void Something() {
    static const std::vector<msg::SessionKind> kEvents = {
        msg::SessionKind::kIdle, msg::SessionKind::kBegun, msg::SessionKind::kConfirmed,
        msg::SessionKind::kAbandoned, msg::SessionKind::kStopped};
    switch (Below(150)) {
      case 0:
        standing_ = ++id_;
        return trials_->Present(Question(id_, 2 + Below(6)), now_);
      case 1:
        standing_ = 0;
        return trials_->Withdraw(now_);
      case 2:
        if (Below(3) == 0) return trials_->Stop(now_);
        return;
      case 3:
        return trials_->TogglePause(now_);
      case 4: {
        const auto event = kEvents[Below(kEvents.size())];
        if (event != msg::SessionKind::kBegun) standing_ = 0;
        stopped_ = event == msg::SessionKind::kStopped;
        return trials_->OnSession(event, now_);
      }
      default:
        trials_->OnDecoding(AnyDecoding(), now_);
    }
  }

  std::mt19937_64 random_{11};
  int64_t id_ = 0;
  int64_t standing_ = 0;  // the question that stands
  bool stopped_ = false;
};

TEST_F(TrialsFuzzTest, AnswersAreOfTheQuestionThatStandsOnceAndOfItsSize) {
  int64_t answers = 0, decoded = 0;
  for (int round = 0; round < 60; ++round) {
    config_.layout.controls = {Control::kUndo, Control::kPause, Control::kStop};
    config_.layout.rows = 2 + round % 3;
    config_.layout.columns = 3;
    config_.invite = round % 2 == 0;
    out_ = {};
    standing_ = 0;
    stopped_ = false;
    Begin();
    std::map<int64_t, int> times;
    for (int step = 0; step < 6000; ++step) {
      const size_t before = out_.answers.size();
      Something();
      Pass(0.05 * static_cast<double>(Below(8)));
      for (size_t i = before; i < out_.answers.size(); ++i) {
        EXPECT_EQ(out_.answered[i], standing_);
        EXPECT_FALSE(stopped_);
        EXPECT_EQ(++times[out_.answered[i]], 1);
        double sum = 0;
        for (const double p : out_.answers[i]) {
          EXPECT_GE(p, 0);
          sum += p;
        }
        EXPECT_NEAR(sum, 1, 1e-9);
      }
    }
    for (size_t i = 1; i < out_.stimuli.size(); ++i)
      ASSERT_GT(out_.stimuli[i].trial, out_.stimuli[i - 1].trial);
    for (const auto& stimulus : out_.stimuli)
      ASSERT_EQ(stimulus.labels.size(), static_cast<size_t>(stimulus.rows * stimulus.columns));
    answers += static_cast<int64_t>(out_.answers.size());
    decoded += trials_->counters().decoded;
  }
  EXPECT_GT(answers, 100);  // it did happen
  EXPECT_GT(decoded, 10'000);
}

}  // namespace
}  // namespace beckon::ui_bridge::bci
