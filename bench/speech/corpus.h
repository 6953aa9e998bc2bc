// What is said in the experiment: commands and other things, by voices that are either learnt from
// or judged on, never both.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/speech/mouth.h"
#include "services/ui_bridge/speech/commands.h"

namespace beckon::bench {

/// What stands while something is said.
struct Situation {
  std::string name;
  std::optional<msg::Query> query;
};

struct Utterance {
  Voice voice;
  size_t situation = 0;
  std::string text;
  /// Index into CommandsFor(situation); nothing: it is outside the grammar.
  std::optional<size_t> command;
};

struct Corpus {
  std::vector<Situation> situations;
  std::vector<Utterance> inside;
  std::vector<Utterance> outside;
};

enum class Part { kLearn, kJudge };

/// `inside` commands (whole rounds over the phrases, voices in turn) and `outside` other
/// utterances, for learning also such of `words`. The parts share neither voices, nor speeds, nor objects, nor other utterances.
Corpus MakeCorpus(Part part, size_t inside, size_t outside, uint64_t seed,
                  const std::vector<std::string>& words = {});

}  // namespace beckon::bench
