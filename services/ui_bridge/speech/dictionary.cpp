#include "services/ui_bridge/speech/dictionary.h"

#include <sphinxbase/err.h>
#include <sphinxbase/ngram_model.h>

#include <algorithm>
#include <fstream>
#include <memory>

namespace beckon::ui_bridge::speech {

Result<Lexicon> LoadLexicon(const std::string& model_folder) {
  const std::string path = model_folder + "/cmudict-en-us.dict";
  std::ifstream file(path);
  if (!file) {
    return Error{path + ": cannot be read; install pocketsphinx-en-us, or set [speech] model"};
  }
  Lexicon lexicon;
  for (std::string line; std::getline(file, line);) {
    const size_t blank = line.find(' ');
    if (blank == std::string::npos) continue;
    auto sounds = ParsePronunciation(line.substr(blank));
    if (!sounds) continue;
    lexicon.Add(line.substr(0, line.find_first_of(" (")), *sounds);
  }
  if (lexicon.size() == 0) return Error{path + ": holds no pronunciation"};
  return lexicon;
}

Result<std::vector<FrequentWord>> FrequentWords(const std::string& model_folder,
                                                const Lexicon& lexicon) {
  err_set_logfp(nullptr);
  const std::string path = model_folder + "/en-us.lm.bin";
  const std::unique_ptr<logmath_t, int (*)(logmath_t*)> logs(logmath_init(1.0001, 0, FALSE),
                                                             logmath_free);
  const std::unique_ptr<ngram_model_t, int (*)(ngram_model_t*)> language(
      ngram_model_read(nullptr, path.c_str(), NGRAM_AUTO, logs.get()), ngram_model_free);
  if (language == nullptr) return Error{path + ": no language model; install pocketsphinx-en-us"};
  std::vector<FrequentWord> words;
  const auto known = static_cast<int32>(ngram_model_get_counts(language.get())[0]);
  for (int32 i = 0; i < known; ++i) {
    const char* word = ngram_word(language.get(), i);
    if (word == nullptr || lexicon.Find(word).empty()) continue;
    int32 used = 0;
    const int32 score = ngram_ng_score(language.get(), i, nullptr, 0, &used);
    words.push_back({word, logmath_log_to_ln(logs.get(), score)});
  }
  std::ranges::stable_sort(words, std::greater<>(), &FrequentWord::log_probability);
  return words;
}

}  // namespace beckon::ui_bridge::speech
