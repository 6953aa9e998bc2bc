#include "bench/speech/trial.h"

#include <algorithm>

#include "services/ui_bridge/speech/segmenter.h"

namespace beckon::bench {
namespace {

namespace speech = ui_bridge::speech;

std::vector<speech::Segment> Segments(const Sound& sound) {
  speech::Segmenter segmenter;
  std::vector<speech::Segment> segments;
  for (size_t i = 0; i + speech::kSamplesPerFrame <= sound.size(); i += speech::kSamplesPerFrame) {
    auto segment = segmenter.Push({sound.data() + i, speech::kSamplesPerFrame});
    if (segment && segment->ended) segments.push_back(*std::move(segment));
  }
  return segments;
}

/// The best phrase of each command, measured.
Example Measured(const speech::Acoustics& acoustics, const speech::Grammar& grammar,
                 std::optional<size_t> said) {
  std::map<size_t, std::pair<double, size_t>> best;
  for (size_t i = 0; i < acoustics.phrases.size(); ++i) {
    const auto command = grammar.phrases[i].command;
    if (!command || !acoustics.phrases[i]) continue;
    double score = 0;
    for (const auto& span : *acoustics.phrases[i]) score += span.score;
    const auto known = best.find(*command);
    if (known == best.end() || score > known->second.first) best[*command] = {score, i};
  }
  Example example;
  for (const auto& [command, phrase] : best) {
    if (command == said) example.said = example.commands.size();
    example.commands.push_back(speech::Measure(acoustics, grammar, phrase.second));
  }
  return example;
}

}  // namespace

void Tally::Add(const Trial& trial) {
  if (trial.utterance->command) {
    ++inside;
    right += trial.outcome == Outcome::kRight ? 1 : 0;
    asked += trial.outcome == Outcome::kAsked ? 1 : 0;
    wrong += trial.outcome == Outcome::kWrong || trial.outcome == Outcome::kStop ? 1 : 0;
  } else {
    ++outside;
    accepted += trial.outcome == Outcome::kAsked ? 0 : 1;
  }
  if (trial.meant_stop) {
    ++stops;
    stops_missed += trial.outcome == Outcome::kRight ? 0 : 1;
  } else {
    ++others;
    false_stops += trial.outcome == Outcome::kStop ? 1 : 0;
  }
}

Result<std::vector<Trial>> Trials::Run(const Condition& condition, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Trial> trials;
  for (size_t s = 0; s < corpus_.situations.size(); ++s) {
    const auto& query = corpus_.situations[s].query;
    const auto commands = speech::CommandsFor(query ? &*query : nullptr, {});
    if (auto set = recogniser_.Expect(commands); !set) return set.error();
    for (const auto* some : {&corpus_.inside, &corpus_.outside}) {
      for (const auto& utterance : *some) {
        if (utterance.situation != s) continue;
        auto trial = RunOne(utterance, condition, commands, random);
        if (!trial) return trial.error();
        trials.push_back(*std::move(trial));
      }
    }
  }
  return trials;
}

Result<Trial> Trials::RunOne(const Utterance& utterance, const Condition& condition,
                             const std::vector<speech::Command>& commands,
                             std::mt19937_64& random) {
  auto said = Speak(utterance.voice, utterance.text);
  if (!said) return said.error();
  const double gain_dB = static_cast<double>(random() % 19) - 12;
  const auto sound = Record(*said, condition.noise, condition.snr_dB, gain_dB, babble_, random);
  Trial trial;
  trial.utterance = &utterance;
  trial.meant_stop =
      utterance.command && commands[*utterance.command].kind == speech::CommandKind::kStop;
  size_t longest = 0;
  for (const auto& segment : Segments(sound)) {
    const auto acoustics = recogniser_.Listen(segment);
    if (segment.samples.size() > longest) {
      longest = segment.samples.size();
      trial.example = Measured(acoustics, recogniser_.grammar(), utterance.command);
    }
    if (trial.outcome != Outcome::kAsked) continue;  // the first that is understood counts
    const auto heard = recogniser_.Weigh(acoustics);
    const auto decision = speech::Decide(heard, recogniser_.grammar(), true, commands.size(), {});
    if (decision.kind == speech::Decision::Kind::kStop) {
      trial.outcome = trial.meant_stop ? Outcome::kRight : Outcome::kStop;
    } else if (decision.kind == speech::Decision::Kind::kCommand) {
      trial.outcome = heard.best == utterance.command ? Outcome::kRight : Outcome::kWrong;
    }
  }
  return trial;
}

}  // namespace beckon::bench
