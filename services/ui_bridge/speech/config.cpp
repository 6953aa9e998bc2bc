#include "services/ui_bridge/speech/config.h"

#include <algorithm>

#include "services/ui_bridge/speech/dictionary.h"
#include "services/ui_bridge/speech/grammar.h"

namespace beckon::ui_bridge::speech {
namespace {

constexpr size_t kMostWords = 16;
constexpr size_t kFewestPhones = 2;  // of a command; in a phrase a word may be "a"

/// Words as a user writes them become phrases; pronunciations between slashes stay.
void ReadWords(ConfigTable& table, const std::string& key, std::vector<std::string>& phrases) {
  std::vector<std::string> given = phrases;
  table.Get(key, given);
  if (given == phrases) return;
  if (given.empty() || given.size() > kMostWords)
    return table.Fail(key, "expected 1 to 16 words or pronunciations");
  phrases.clear();
  for (const auto& text : given) {
    if (text.starts_with('/')) {
      const bool closed = text.size() > 2 && text.ends_with('/');
      const auto sounds = closed
                              ? ParsePronunciation(text.substr(1, text.size() - 2))
                              : Result<Pronunciation>(Error{"'" + text + "' has no second slash"});
      if (!sounds) return table.Fail(key, sounds.error().message);
      if (sounds->size() < kFewestPhones)
        return table.Fail(key, "'" + text + "' is too short to be told from a noise");
      phrases.push_back(text);
    } else if (const std::string phrase = Normalised(text); !phrase.empty()) {
      phrases.push_back(phrase);
    } else {
      return table.Fail(key, "'" + text + "' has no letter");
    }
  }
}

void ReadAllWords(ConfigTable table, SpokenWords& words) {
  ReadWords(table, "yes", words.yes);
  ReadWords(table, "no", words.no);
  ReadWords(table, "stop", words.stop);
  ReadWords(table, "undo", words.undo);
  ReadWords(table, "none", words.none);
  ReadWords(table, "resume", words.resume);
  ReadWords(table, "start", words.start);
  ReadWords(table, "repeat", words.repeat);
  table.Get("number", words.number);
  words.number = Normalised(words.number);
}

void ReadCommand(ConfigTable& table, const std::string& key, std::vector<std::string>& command,
                 bool may_be_empty) {
  table.Get(key, command);
  const bool none = command.empty() || command.front().empty();
  if (none && !may_be_empty) table.Fail(key, "expected a program and its arguments");
  if (none) command.clear();
}

}  // namespace

void ReadConfig(ConfigTable table, SpeechConfig& config) {
  ReadAllWords(table.Section("words"), config.words);
  auto& espeak = config.speaker.espeak;
  table.Get("voice", espeak.voice);
  table.Get("words_per_minute", espeak.words_per_minute, 80, 450);
  table.Get("pitch", espeak.pitch, 0, 99);
  table.Get("volume", espeak.volume, 0, 200);
  table.Get("espeak", espeak.program);
  ReadCommand(table, "play", config.speaker.play, /*may_be_empty=*/true);
  auto& source = config.ears.source;
  ReadCommand(table, "record", source.command, /*may_be_empty=*/false);
  table.Get("input", source.input);
  table.Get("retry_s", source.retry_s, 0.05, 3600);
  table.Get("retry_most_s", source.retry_most_s, 0.05, 3600);
  source.retry_most_s = std::max(source.retry_most_s, source.retry_s);
  table.Get("onset_db", config.ears.segmenter.onset_dB, 3, 40);
  table.Get("hold_db", config.ears.segmenter.hold_dB, 2, 40);
  table.Get("pause_frames", config.ears.segmenter.pause_frames, 5, 100);
  table.Get("end_frames", config.ears.segmenter.end_frames, 10, 200);
  table.Get("echo_margin_db", config.ears.echo.margin_dB, 0, 40);
  table.Get("model", config.ears.recogniser.model_folder);
  table.Get("judgement", config.model_file);
  table.Get("accept", config.turn.accept, 0.05, 0.999);
  table.Get("stop", config.turn.stop, 0.01, 0.999);
  table.Get("resume", config.turn.resume, 0.05, 0.999);
  table.Get("kind", config.kind, {"choice", "yesno"});
  table.Get("max_options", config.max_options, 2, 12);
  table.Get("false_yes", config.false_yes, 0, 0.5);
  table.Get("false_no", config.false_no, 0, 0.5);
  table.Get("ask_again_s", config.ask_again_s, 0, 3600);
  table.Get("ask_again_times", config.ask_again_times, 0, 100);
  config.ears.recogniser.espeak = espeak;
}

Status CheckWords(const SpeechConfig& config) {
  auto lexicon = LoadLexicon(config.ears.recogniser.model_folder);
  if (!lexicon) return lexicon.error();
  for (const auto& word :
       MissingWords({{CommandKind::kOption, 0, AllPhrases(config.words)}}, *lexicon)) {
    if (auto sounds = PronounceByEspeak(config.speaker.espeak, word); !sounds) {
      return Error{"[speech.words]: '" + word + "' is in no dictionary, and " +
                   sounds.error().message + "; give it as phones, e.g. \"/Y EH S/\""};
    }
  }
  return {};
}

}  // namespace beckon::ui_bridge::speech
