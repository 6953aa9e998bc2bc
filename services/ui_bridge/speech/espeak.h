// espeak-ng as a child process: sound of text, and phones of words. Never through a shell.
#pragma once

#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/ui_bridge/speech/lexicon.h"
#include "services/ui_bridge/speech/sound.h"

namespace beckon::ui_bridge::speech {

struct EspeakConfig {
  std::string program = "espeak-ng";
  std::string voice = "en-us";  // as espeak-ng -v takes it
  int words_per_minute = 160;   // 80 .. 450
  int pitch = 50;               // 0 .. 99
  int volume = 100;             // 0 .. 200
};

/// Blocks until the child has ended, some tens of milliseconds for a sentence; kills it after 10 s.
Result<Wave> SpeakToWave(const EspeakConfig& config, const std::string& text);

/// How espeak-ng's voice `accent` says a word, whatever the voice of `config` is.
Result<Pronunciation> PronounceByEspeak(const EspeakConfig& config, const std::string& word,
                                        const std::string& accent = "en-us");

/// Standard output of a program that is given no input. The error names the program, and how it
/// ended.
Result<std::vector<uint8_t>> OutputOf(const std::vector<std::string>& command, int timeout_ms);

}  // namespace beckon::ui_bridge::speech
