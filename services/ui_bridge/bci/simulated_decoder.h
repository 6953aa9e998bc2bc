// A decoder without a brain, on the bus: hears STIMULUS, knows what its user wants, answers
// DECODING.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "services/base/bus.h"
#include "services/base/run_loop.h"
#include "services/ui_bridge/bci/simulated_decoding.h"
#include "services/ui_bridge/simulated_user.h"

namespace beckon::ui_bridge::bci {

struct SimulatedDecoderConfig {
  SimulatedUserConfig user;
  std::string truth_file;  // as beckon-capture --truth writes it; empty: none
  std::string name = "simulated";
  std::string device;     // of the front end that is answered; empty: any
  double accuracy = 0.7;  // of single trials, above chance
  double sharpness = 1;   // above 1: surer than it ought to be
  double rate = 2;        // decodings a second, > 0
  double dropout = 0;     // 0..1, chance that a trial is not decoded
  double duplicate = 0;   // 0..1, chance that a decoding is sent twice
  int stop_after = 0;     // attends to stop from this trial on, until stopped; 0 = never
  uint64_t seed = 1;
};

class SimulatedDecoder {
 public:
  /// All must outlive it.
  SimulatedDecoder(const SimulatedDecoderConfig& config, Bus& bus, RunLoop& loop,
                   const Clock& clock);
  void Begin();
  int64_t decoded() const { return decoded_; }

 private:
  void Hear(const msg::Stimulus& stimulus);
  void Decode(const msg::Stimulus& stimulus);
  /// Class that the user attends to; empty: none.
  std::optional<size_t> Attended(const msg::Stimulus& stimulus);
  std::optional<size_t> Wanted(const msg::Query& query);
  bool LookAtTruth();

  const SimulatedDecoderConfig config_;
  Bus& bus_;
  RunLoop& loop_;
  const Clock& clock_;
  SimulatedUser user_;
  std::mt19937_64 random_;
  std::map<size_t, SimulatedDecoding> decodings_;  // by number of classes
  std::map<int64_t, msg::Query> queries_;          // the latest, by id
  std::map<std::string, int64_t> heard_;           // the latest trial, by device
  bool truth_read_ = false;
  bool stopping_ = false;
  int64_t decoded_ = 0;
};

}  // namespace beckon::ui_bridge::bci
