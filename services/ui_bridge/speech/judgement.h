// From likelihoods of sounds to likelihoods of commands, and of "none of them". A grammar alone
// takes whatever is said for one of its phrases; here each phrase has to hold against any sequence
// of phones, against words that sound alike, and phone by phone.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "services/ui_bridge/speech/acoustics.h"
#include "services/ui_bridge/speech/grammar.h"

namespace beckon::ui_bridge::speech {

/// What is measured of a phrase. All per frame of 10 ms in nats unless said otherwise; "against
/// free" means minus the likelihood of the free phones in the same frames.
enum Feature : size_t {
  kWhole,        // the whole segment against free, per frame of speech
  kWorstPhone,   // the worst phone against free
  kSecondWorst,  // the next one
  kMeanPhone,    // mean over the phones, each per frame
  kSqueezed,     // share of phones that are as short as can be
  kLongest,      // the longest phone: log(frames / 20), at least 0
  kPace,         // |log(frames of speech / (8 x phones))|
  kRival,        // against the best phrase that means nothing, within +-kMarginCap
  kOther,        // against the best phrase of another command, likewise
  kWord,         // against the best other word of the dictionary, likewise
  kSentence,     // against the best sequence of other words, likewise
  kHeardApart,   // Distance between the free phones and the phrase, a phone
  kLength,       // log(phones)
  kFeatures
};
inline constexpr std::array<const char*, kFeatures> kFeatureNames = {
    "whole", "worst_phone", "second_worst", "mean_phone", "squeezed",    "longest", "pace",
    "rival", "other",       "word",         "sentence",   "heard_apart", "length"};
inline constexpr double kMarginCap = 3;

using Features = std::array<double, kFeatures>;

/// Each phrase has a log-odds, bias + weights . features, of having been said. What is shipped in
/// speech_model.toml was fitted to synthetic speech by beckon-speech-judge.
struct JudgementModel {
  double bias = 0;
  Features weights{};
};

/// What was heard, as probabilities that sum to 1: odds of the commands against each other and
/// against 1 for "none of them".
struct Heard {
  double none = 1;               // none of the commands was said
  std::vector<double> commands;  // of Grammar::commands
  std::optional<size_t> best;    // the likeliest command, if anything fits
  std::optional<size_t> phrase;  // its phrase
};

double LogOdds(const Features& features, const JudgementModel& model);

/// `phrase` needs an alignment.
Features Measure(const Acoustics& acoustics, const Grammar& grammar, size_t phrase);

Heard Judge(const Acoustics& acoustics, const Grammar& grammar, const JudgementModel& model);

/// How likely what was heard is under each of `n` options of a question, largest 1: `none` speaks
/// for all alike. Nothing where no option was heard.
std::vector<double> OptionLikelihoods(const Heard& heard, const Grammar& grammar, size_t n);

}  // namespace beckon::ui_bridge::speech
