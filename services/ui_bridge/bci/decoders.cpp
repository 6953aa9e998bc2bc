#include "services/ui_bridge/bci/decoders.h"

#include <cmath>
#include <utility>

#include "services/ui_bridge/bci/announcement.h"
#include "services/ui_bridge/bci/calibration_file.h"

namespace beckon::ui_bridge::bci {
namespace {

constexpr double kNewest = 0.1;        // weight of the latest trial's time
constexpr double kWorthTelling = 0.1;  // change of the time of a trial
constexpr size_t kMostDecoders = 16;   // that are remembered

}  // namespace

Decoders::Decoders(const BciConfig& config, std::string folder, std::string user)
    : config_(config),
      classes_(Classes(config.trials.layout)),
      folder_(std::move(folder)),
      user_(std::move(user)),
      trial_s_(config.trial_s) {
  Choose(config.trials.decoder);
}

std::string Decoders::PathOf(const std::string& decoder) const {
  return folder_ + "/" + CalibrationFileName(user_, decoder, classes_);
}

void Decoders::SetUser(const std::string& user) {
  if (user == user_) return;
  user_ = user;
  calibrations_.clear();
  Choose(decoder_);
}

DecoderModel Decoders::Choose(const std::string& decoder) {
  decoder_ = decoder;
  if (!calibrations_.contains(decoder)) {
    if (calibrations_.size() >= kMostDecoders) calibrations_.clear();
    auto loaded = decoder.empty()
                      ? LoadedCalibration{Calibration(classes_, config_.calibration), ""}
                      : LoadCalibration(PathOf(decoder), classes_, config_.calibration);
    if (!loaded.warning.empty()) warnings_.push_back(std::move(loaded.warning));
    calibrations_.emplace(decoder, std::move(loaded.calibration));
  }
  Describe();
  return calibration().Fit();
}

DecoderModel Decoders::Learn(std::vector<KnownTrial> trials) {
  Calibration& calibration = calibrations_.at(decoder_);
  for (KnownTrial& trial : trials) calibration.Add(std::move(trial));
  if (auto saved = SaveCalibration(PathOf(decoder_), calibration); !saved)
    warnings_.push_back(saved.error().message);
  Describe();
  return calibration.Fit();
}

void Decoders::Time(double trial_s) {
  trial_s_ += kNewest * (trial_s - trial_s_);
  if (std::abs(trial_s_ - described_s_) > kWorthTelling * described_s_) Describe();
}

void Decoders::Describe() {
  described_s_ = trial_s_;
  interface_ = Announce(config_.trials, calibration(), trial_s_);
}

std::vector<std::string> Decoders::TakeWarnings() { return std::exchange(warnings_, {}); }

}  // namespace beckon::ui_bridge::bci
