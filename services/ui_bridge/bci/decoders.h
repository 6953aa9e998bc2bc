// The decoders that were heard, each with its calibration for the user in front of them, and what
// the front end announces of the one that counts.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"
#include "services/ui_bridge/bci/bci_config.h"
#include "services/ui_bridge/bci/calibration.h"

namespace beckon::ui_bridge::bci {

class Decoders {
 public:
  /// `folder`: of the calibration files.
  Decoders(const BciConfig& config, std::string folder, std::string user);

  /// Another user: calibrations are theirs from now on.
  void SetUser(const std::string& user);
  /// Makes `decoder` the one that counts; reads its calibration where it was not read yet.
  DecoderModel Choose(const std::string& decoder);
  /// Adds to the calibration of the one that counts and saves it. How to read it from now on.
  DecoderModel Learn(std::vector<KnownTrial> trials);
  /// How long a trial took, s.
  void Time(double trial_s);

  /// utime and device are left out.
  const msg::Interface& interface() const { return interface_; }
  const Calibration& calibration() const { return calibrations_.at(decoder_); }
  double trial_s() const { return trial_s_; }
  /// Warnings since the last call, for the log.
  std::vector<std::string> TakeWarnings();

 private:
  std::string PathOf(const std::string& decoder) const;
  void Describe();

  const BciConfig config_;
  const size_t classes_;
  const std::string folder_;
  std::string user_;
  std::string decoder_;
  std::map<std::string, Calibration> calibrations_;
  double trial_s_;
  double described_s_ = 0;  // trial_s_ that interface_ was made with
  msg::Interface interface_;
  std::vector<std::string> warnings_;
};

}  // namespace beckon::ui_bridge::bci
