#include "services/ui_bridge/speech/phone_decoder.h"

#include <pocketsphinx.h>
#include <sphinxbase/err.h>
#include <sphinxbase/feat.h>
#include <sphinxbase/fsg_model.h>
#include <sphinxbase/ngram_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <utility>

namespace beckon::ui_bridge::speech {
namespace {

constexpr char kPhrases[] = "phrases";
constexpr char kFree[] = "free";
/// A unit of acoustic scores: 2^10 steps of the logarithm to base 1.0001.
constexpr double kNatsPerUnit = 1024 * 1e-4;
constexpr int kFewestFrames = 10;
constexpr int kScoreShift = 10;  // of scores against the logarithm
constexpr double kWordCost = 4;  // nats, of each word of a sequence
constexpr int kStart = 0;        // states of the grammar
constexpr int kAnyWord = 1;

using Cepstrum = std::array<mfcc_t, 13>;

/// Takes away what the microphone and the room add to all frames: the mean over the quiet before
/// and after, too, as in what the model was made of.
void SubtractMean(std::vector<Cepstrum>& cepstra) {
  Cepstrum mean{};
  const auto n = static_cast<float>(cepstra.size());
  for (const auto& cepstrum : cepstra) {
    for (size_t i = 0; i < mean.size(); ++i) mean[i] += cepstrum[i] / n;
  }
  for (auto& cepstrum : cepstra) {
    for (size_t i = 0; i < mean.size(); ++i) cepstrum[i] -= mean[i];
  }
}

std::string WordOf(Phone phone) { return std::string("p") + kPhoneNames[phone]; }

/// "w-S-T-EH-P"
std::string OtherWord(const Pronunciation& sounds) {
  std::string name = "w";
  for (const Phone phone : sounds) name += std::string("-") + kPhoneNames[phone];
  return name;
}

Phone PhoneOf(std::string name) {
  if (const size_t variant = name.find('('); variant != std::string::npos) name.resize(variant);
  if (name.starts_with('p')) name.erase(0, 1);
  return PhoneFromName(name).value_or(kSilence);
}

Pronunciation Sounds(const Alignment& alignment) {
  Pronunciation sounds;
  for (const auto& span : alignment) {
    if (span.phone != kSilence) sounds.push_back(span.phone);
  }
  return sounds;
}

}  // namespace

struct PhoneDecoder::State {
  cmd_ln_t* config = nullptr;
  ps_decoder_t* decoder = nullptr;
  fsg_model_t* grammar = nullptr;
  std::set<std::string> learnt;  // other words
  std::vector<Pronunciation> phrases;
  std::vector<int> ends;  // of each phrase, a state of the grammar

  ~State() {
    if (grammar != nullptr) fsg_model_free(grammar);
    if (decoder != nullptr) ps_free(decoder);
    if (config != nullptr) cmd_ln_free_r(config);
  }

  /// Phrases are made of words of one phone each, so that each phone has a score; other words are
  /// whole, which is faster.
  void Learn(const std::vector<Pronunciation>& words) {
    std::vector<std::pair<std::string, std::string>> fresh;
    for (const auto& word : words) {
      if (learnt.insert(OtherWord(word)).second) fresh.emplace_back(OtherWord(word), ToText(word));
    }
    for (size_t i = 0; i < fresh.size(); ++i)
      ps_add_word(decoder, fresh[i].first.c_str(), fresh[i].second.c_str(), i + 1 == fresh.size());
  }

  void Run(const char* search, std::vector<Cepstrum>& cepstra) {
    std::vector<mfcc_t*> rows;
    for (auto& cepstrum : cepstra) rows.push_back(cepstrum.data());
    ps_set_search(decoder, search);
    ps_start_utt(decoder);
    if (!rows.empty())
      ps_process_cep(decoder, rows.data(), static_cast<int>(rows.size()), FALSE, TRUE);
    ps_end_utt(decoder);
  }

  std::vector<Cepstrum> Analyse(std::span<const int16_t> samples) {
    fe_t* front = ps_get_fe(decoder);
    std::vector<Cepstrum> cepstra(samples.size() / kSamplesPerFrame + 8);
    std::vector<mfcc_t*> rows;
    for (auto& cepstrum : cepstra) rows.push_back(cepstrum.data());
    const int16_t* at = samples.data();
    size_t left = samples.size();
    auto n = static_cast<int32>(rows.size());
    int32 unused = 0;
    fe_start_stream(front);
    fe_start_utt(front);
    fe_process_frames(front, &at, &left, rows.data(), &n, &unused);
    int32 last = 0;
    if (n < static_cast<int32>(rows.size())) fe_end_utt(front, rows[static_cast<size_t>(n)], &last);
    cepstra.resize(static_cast<size_t>(n + last));
    return cepstra;
  }

  Alignment Read() {
    Alignment alignment;
    for (ps_seg_t* segment = ps_seg_iter(decoder); segment != nullptr;
         segment = ps_seg_next(segment)) {
      Span span;
      int32 score = 0;
      int32 language = 0;
      int32 backoff = 0;
      ps_seg_frames(segment, &span.begin, &span.end);
      ++span.end;
      ps_seg_prob(segment, &score, &language, &backoff);
      span.score = score * kNatsPerUnit;
      span.phone = PhoneOf(ps_seg_word(segment));
      if (span.end > span.begin) alignment.push_back(span);
    }
    return alignment;
  }
};

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

Result<std::vector<std::string>> FrequentWords(const std::string& model_folder,
                                               const Lexicon& lexicon, size_t n) {
  const std::string path = model_folder + "/en-us.lm.bin";
  const std::unique_ptr<logmath_t, int (*)(logmath_t*)> logs(logmath_init(1.0001, 0, FALSE),
                                                             logmath_free);
  const std::unique_ptr<ngram_model_t, int (*)(ngram_model_t*)> language(
      ngram_model_read(nullptr, path.c_str(), NGRAM_AUTO, logs.get()), ngram_model_free);
  if (language == nullptr) return Error{path + ": no language model; install pocketsphinx-en-us"};
  std::vector<std::pair<int32, std::string>> words;
  const auto known = static_cast<int32>(ngram_model_get_counts(language.get())[0]);
  for (int32 i = 0; i < known; ++i) {
    const char* word = ngram_word(language.get(), i);
    if (word == nullptr || lexicon.Find(word).empty()) continue;
    int32 used = 0;
    words.emplace_back(-ngram_ng_score(language.get(), i, nullptr, 0, &used), word);
  }
  std::ranges::sort(words);
  std::vector<std::string> frequent;
  for (auto& [score, word] : words) {
    if (frequent.size() == n) break;
    frequent.push_back(std::move(word));
  }
  return frequent;
}

PhoneDecoder::PhoneDecoder(std::unique_ptr<State> state) : state_(std::move(state)) {}
PhoneDecoder::~PhoneDecoder() = default;

Result<std::unique_ptr<PhoneDecoder>> PhoneDecoder::Open(const std::string& model_folder) {
  err_set_logfp(nullptr);
  auto state = std::make_unique<State>();
  // compallsen: scores of different passes are relative to the same. Beams so wide that only
  // hopeless phrases are given up. Fillers only where the grammar has them.
  state->config = cmd_ln_init(nullptr, ps_args(), TRUE, "-hmm", (model_folder + "/en-us").c_str(),
                              "-compallsen", "yes", "-fsgusefiller", "no", "-fsgusealtpron", "no",
                              "-beam", "1e-200", "-pbeam", "1e-200", "-wbeam", "1e-200",
                              "-bestpath", "no", "-pl_window", "0", "-remove_silence", "no",
                              "-allphone_ci", "yes", "-remove_noise", "yes", nullptr);
  state->decoder = state->config == nullptr ? nullptr : ps_init(state->config);
  if (state->decoder == nullptr) {
    return Error{model_folder +
                 "/en-us: no acoustic model for PocketSphinx; install "
                 "pocketsphinx-en-us, or set [speech] model"};
  }
  // Normalising is done here, over all of a segment. Its flag would be overruled by the model's
  // feat.params, and a second mean, over the frames that are compared, ruins all scores.
  ps_get_feat(state->decoder)->cmn = CMN_NONE;
  for (Phone phone = 0; phone < kPhones; ++phone) {
    ps_add_word(state->decoder, WordOf(phone).c_str(), kPhoneNames[phone], phone + 1 == kPhones);
  }
  if (ps_set_allphone_file(state->decoder, kFree, nullptr) != 0)
    return Error{"PocketSphinx does not decode free phones"};
  return std::unique_ptr<PhoneDecoder>(new PhoneDecoder(std::move(state)));
}

Status PhoneDecoder::SetPhrases(const std::vector<Pronunciation>& phrases,
                                const std::vector<Pronunciation>& words) {
  size_t n_states = 2;
  for (const auto& phrase : phrases) n_states += phrase.size();
  logmath_t* logs = ps_get_logmath(state_->decoder);
  fsg_model_t* grammar = fsg_model_init(kPhrases, logs, 1.0F, static_cast<int32>(n_states));
  int next = 2;
  const auto add = [&](const Pronunciation& sounds) {
    int from = kStart;
    for (const Phone phone : sounds) {
      fsg_model_trans_add(grammar, from, next, 0,
                          fsg_model_word_add(grammar, WordOf(phone).c_str()));
      from = next++;
    }
    return from;
  };
  // No silence: it fits speech nearly as well as phones do, and would explain away what was said.
  std::vector<int> ends;
  for (const auto& phrase : phrases) ends.push_back(add(phrase));
  const auto cost = static_cast<int32>(-kWordCost / std::log(logmath_get_base(logs)));
  state_->Learn(words);
  for (const auto& word : words) {
    fsg_model_trans_add(grammar, kAnyWord, kAnyWord, cost >> kScoreShift,
                        fsg_model_word_add(grammar, OtherWord(word).c_str()));
  }
  fsg_model_null_trans_add(grammar, kStart, kAnyWord, 0);
  glist_free(fsg_model_null_trans_closure(grammar, nullptr));
  grammar->start_state = kStart;
  grammar->final_state = kAnyWord;
  if (ps_set_fsg(state_->decoder, kPhrases, grammar) != 0) {
    fsg_model_free(grammar);
    return Error{"PocketSphinx refuses a grammar of " + std::to_string(phrases.size()) +
                 " phrases"};
  }
  if (state_->grammar != nullptr) fsg_model_free(state_->grammar);
  state_->grammar = grammar;
  state_->phrases = phrases;
  state_->ends = std::move(ends);
  return {};
}

Acoustics PhoneDecoder::Decode(std::span<const int16_t> samples, int begin, int end) {
  Acoustics acoustics;
  auto cepstra = state_->Analyse(samples);
  SubtractMean(cepstra);
  const auto n = static_cast<int>(cepstra.size());
  end = std::clamp(end, 0, n);
  begin = std::clamp(begin, 0, end);
  cepstra = {cepstra.begin() + begin, cepstra.begin() + end};
  if (end - begin < kFewestFrames) return acoustics;
  state_->Run(kFree, cepstra);
  acoustics.free = state_->Read();
  acoustics.frames = acoustics.free.empty() ? 0 : acoustics.free.back().end;
  if (state_->grammar == nullptr) return acoustics;
  state_->Run(kPhrases, cepstra);
  state_->grammar->final_state = kAnyWord;
  if (const auto words = state_->Read(); !words.empty() && words.back().end == acoustics.frames) {
    acoustics.other_words = 0;
    for (const auto& word : words) *acoustics.other_words += word.score;
  }
  // The search keeps the history of every state, and looks for the best path to the final one.
  // Where no path ends there it gives another one.
  for (size_t i = 0; i < state_->ends.size(); ++i) {
    state_->grammar->final_state = state_->ends[i];
    auto alignment = state_->Read();
    if (Sounds(alignment) == state_->phrases[i]) {
      acoustics.phrases.emplace_back(std::move(alignment));
    } else {
      acoustics.phrases.emplace_back();
    }
  }
  return acoustics;
}

}  // namespace beckon::ui_bridge::speech
