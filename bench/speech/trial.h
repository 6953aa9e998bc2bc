// One utterance through the ears of the speech front end: recorded in noise, found, judged.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bench/speech/corpus.h"
#include "bench/speech/fit.h"
#include "services/ui_bridge/speech/recogniser.h"
#include "services/ui_bridge/speech/turn.h"

namespace beckon::bench {

struct Condition {
  Noise noise = Noise::kQuiet;
  double snr_dB = 50;
};

/// What became of an utterance.
enum class Outcome { kRight, kWrong, kAsked, kStop };

struct Trial {
  const Utterance* utterance = nullptr;
  Outcome outcome =
      Outcome::kAsked;  // kAsked: not understood; kStop: taken for "stop", rightly or not
  bool meant_stop = false;
  Example example;  // of its longest segment
};

struct Tally {
  int inside = 0, right = 0, wrong = 0, asked = 0;
  int outside = 0, accepted = 0;
  int stops = 0, stops_missed = 0, others = 0, false_stops = 0;
  void Add(const Trial& trial);
};

class Trials {
 public:
  Trials(ui_bridge::speech::Recogniser& recogniser, const Corpus& corpus,
         const std::vector<double>& babble)
      : recogniser_(recogniser), corpus_(corpus), babble_(babble) {}

  /// All utterances of the corpus in `condition`, at levels of -12 .. +6 dB.
  Result<std::vector<Trial>> Run(const Condition& condition, uint64_t seed);

 private:
  Result<Trial> RunOne(const Utterance& utterance, const Condition& condition,
                       const std::vector<ui_bridge::speech::Command>& commands,
                       std::mt19937_64& random);

  ui_bridge::speech::Recogniser& recogniser_;
  const Corpus& corpus_;
  const std::vector<double>& babble_;
};

}  // namespace beckon::bench
