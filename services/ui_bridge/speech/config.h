// The [speech] section of the configuration.
#pragma once

#include <string>

#include "services/base/config.h"
#include "services/ui_bridge/speech/commands.h"
#include "services/ui_bridge/speech/ears.h"
#include "services/ui_bridge/speech/speaker.h"
#include "services/ui_bridge/speech/turn.h"

namespace beckon::ui_bridge::speech {

struct SpeechConfig {
  SpokenWords words;
  SpeakerConfig speaker;
  EarsConfig ears;
  TurnConfig turn;
  std::string model_file;       // of the judgement; empty: the one that ships
  std::string kind = "choice";  // or "yesno"
  int max_options = 5;          // that are read out
  double false_yes = 0.02;      // of accepted answers; a guess, where learning starts
  double false_no = 0.02;
  double ask_again_s = 20;  // after a question that nobody answers; 0: never
  int ask_again_times = 2;
};

/// Errors are recorded in `table`.
void ReadConfig(ConfigTable table, SpeechConfig& config);

/// Every word can be pronounced. Reads the dictionary, which takes half a second, where words were
/// replaced.
Status CheckWords(const SpeechConfig& config);

}  // namespace beckon::ui_bridge::speech
