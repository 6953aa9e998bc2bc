#include "services/ui_bridge/speech/judgement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beckon::ui_bridge::speech {
namespace {

constexpr int kShortestPhone = 3;  // frames: the model has three states
constexpr double kUsualPhone = 8;  // frames
constexpr double kLongPhone = 20;  // frames
constexpr double kMostOdds = 12;   // of a phrase: no judgement is surer

/// Sum of the free phones' likelihood up to each frame.
std::vector<double> Cumulated(const Acoustics& acoustics) {
  std::vector<double> sum(static_cast<size_t>(acoustics.frames) + 1, 0);
  for (const auto& span : acoustics.free) {
    const double each = span.score / (span.end - span.begin);
    for (int t = span.begin; t < span.end && t < acoustics.frames; ++t)
      sum[static_cast<size_t>(t) + 1] = sum[static_cast<size_t>(t)] + each;
  }
  return sum;
}

double Total(const Alignment& alignment) {
  double total = 0;
  for (const auto& span : alignment) total += span.score;
  return total;
}

/// Where the free phones say that something is said.
std::pair<int, int> SpokenFrames(const Acoustics& acoustics) {
  int begin = acoustics.frames;
  int end = 0;
  for (const auto& span : acoustics.free) {
    if (span.phone == kSilence) continue;
    begin = std::min(begin, span.begin);
    end = std::max(end, span.end);
  }
  return {std::min(begin, end), end};
}

Pronunciation Sounds(const Alignment& alignment) {
  Pronunciation sounds;
  for (const auto& span : alignment) {
    if (span.phone != kSilence) sounds.push_back(span.phone);
  }
  return sounds;
}

/// The best score among phrases that `takes` accepts; nothing where none is aligned.
template <typename Takes>
std::optional<double> BestScore(const Acoustics& acoustics, const Grammar& grammar, Takes takes) {
  std::optional<double> best;
  for (size_t i = 0; i < acoustics.phrases.size(); ++i) {
    if (!acoustics.phrases[i] || !takes(grammar.phrases[i])) continue;
    const double score = Total(*acoustics.phrases[i]);
    if (!best || score > *best) best = score;
  }
  return best;
}

double Margin(double score, const std::optional<double>& other, double frames) {
  return other ? std::clamp((score - *other) / frames, -kMarginCap, kMarginCap) : kMarginCap;
}

}  // namespace

Features Measure(const Acoustics& acoustics, const Grammar& grammar, size_t phrase) {
  const Alignment& alignment = *acoustics.phrases[phrase];
  const auto free = Cumulated(acoustics);
  const auto against_free = [&](const Span& span) {
    const auto end = static_cast<size_t>(std::min(span.end, acoustics.frames));
    const auto begin = std::min(static_cast<size_t>(span.begin), end);
    return span.score - (free[end] - free[begin]);
  };
  auto [first, last] = SpokenFrames(acoustics);
  std::vector<double> phones;
  double squeezed = 0;
  double longest = 0;
  for (const auto& span : alignment) {
    const int frames = span.end - span.begin;
    if (span.phone == kSilence) continue;
    first = std::min(first, span.begin);
    last = std::max(last, span.end);
    phones.push_back(against_free(span) / frames);
    squeezed += frames <= kShortestPhone ? 1 : 0;
    longest = std::max(longest, std::log(frames / kLongPhone));
  }
  const double n = static_cast<double>(phones.size());
  const double frames = std::max(10, last - first);
  const double score = Total(alignment);
  const auto command = grammar.phrases[phrase].command;
  Features features{};
  features[kWhole] = (score - free.back()) / frames;
  for (const double phone : phones) features[kMeanPhone] += phone / n;
  std::ranges::sort(phones);
  features[kWorstPhone] = phones[0];
  features[kSecondWorst] = phones[std::min<size_t>(1, phones.size() - 1)];
  features[kSqueezed] = squeezed / n;
  features[kLongest] = longest;
  features[kPace] = std::abs(std::log(frames / (kUsualPhone * n)));
  features[kRival] = Margin(
      score, BestScore(acoustics, grammar, [](const Phrase& other) { return !other.command; }),
      frames);
  features[kOther] = Margin(
      score,
      BestScore(acoustics, grammar,
                [&](const Phrase& other) { return other.command && other.command != command; }),
      frames);
  features[kWord] = Margin(score, acoustics.other_word, frames);
  features[kSentence] = Margin(score, acoustics.other_words, frames);
  features[kHeardApart] = Distance(Sounds(acoustics.free), grammar.phrases[phrase].sounds) / n;
  features[kLength] = std::log(n);
  return features;
}

double LogOdds(const Features& features, const JudgementModel& model) {
  double odds = model.bias;
  for (size_t i = 0; i < kFeatures; ++i) odds += model.weights[i] * features[i];
  return odds;
}

Heard Judge(const Acoustics& acoustics, const Grammar& grammar, const JudgementModel& model) {
  Heard heard;
  heard.commands.assign(grammar.commands.size(), 0);
  constexpr double kNever = -std::numeric_limits<double>::infinity();
  std::vector<double> odds(grammar.commands.size(), kNever);
  double best = kNever;
  for (size_t i = 0; i < acoustics.phrases.size(); ++i) {
    const auto command = grammar.phrases[i].command;
    if (!command || !acoustics.phrases[i]) continue;
    const double own =
        std::clamp(LogOdds(Measure(acoustics, grammar, i), model), -kMostOdds, kMostOdds);
    odds[*command] = std::max(odds[*command], own);
    if (own > best) {
      best = own;
      heard.best = command;
      heard.phrase = i;
    }
  }
  double sum = 1;
  for (const double own : odds) sum += std::exp(own);
  for (size_t i = 0; i < odds.size(); ++i) heard.commands[i] = std::exp(odds[i]) / sum;
  heard.none = 1 / sum;
  return heard;
}

std::vector<double> OptionLikelihoods(const Heard& heard, const Grammar& grammar, size_t n) {
  std::vector<double> likelihoods(n, 0);
  double largest = 0;
  for (size_t i = 0; i < grammar.commands.size() && i < heard.commands.size(); ++i) {
    const auto& command = grammar.commands[i];
    if (command.kind != CommandKind::kOption || command.option >= n) continue;
    likelihoods[command.option] += heard.commands[i];
    largest = std::max(largest, likelihoods[command.option]);
  }
  if (largest <= 0) return {};
  const double spread = heard.none / static_cast<double>(n);
  for (double& likelihood : likelihoods) likelihood = (likelihood + spread) / (largest + spread);
  return likelihoods;
}

}  // namespace beckon::ui_bridge::speech
