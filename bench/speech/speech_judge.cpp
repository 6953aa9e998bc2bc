// beckon-speech-judge: how well the speech front end understands commands and leaves out what is
// none, in quiet and in noise; and, with --learn, the fit of its judgement. Synthetic voices.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "bench/speech/trial.h"
#include "services/base/app.h"

namespace {

using namespace beckon;
using namespace beckon::bench;
namespace speech = ui_bridge::speech;

struct Options {
  int inside = 60;
  int outside = 60;
  uint64_t seed = 1;
  std::string learn;  // file to write
  std::string model;  // to judge with
  std::string json;
  std::string markdown;
  bool quiet_only = false;
};

/// 95 % interval of a proportion (Wilson).
std::pair<double, double> Interval(int hits, int n) {
  if (n == 0) return {0, 1};
  const double z = 1.96;
  const double p = static_cast<double>(hits) / n;
  const double middle = p + z * z / (2 * n);
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4.0 * n * n));
  return {(middle - half) / (1 + z * z / n), (middle + half) / (1 + z * z / n)};
}

std::string Percent(int hits, int n) {
  const auto [low, high] = Interval(hits, n);
  char text[80];
  std::snprintf(text, sizeof text, "%d / %d = %.0f %% (%.0f-%.0f)", hits, n,
                n == 0 ? 0.0 : 100.0 * hits / n, 100 * low, 100 * high);
  return text;
}

std::string Name(const Condition& condition) {
  if (condition.noise == Noise::kQuiet) return "quiet";
  return std::string(bench::Name(condition.noise)) + " " +
         std::to_string(static_cast<int>(condition.snr_dB)) + " dB";
}

nlohmann::json ToJson(const Tally& t) {
  return {{"inside", t.inside},   {"right", t.right},
          {"wrong", t.wrong},     {"asked_again", t.asked},
          {"outside", t.outside}, {"accepted", t.accepted},
          {"stops", t.stops},     {"stops_missed", t.stops_missed},
          {"others", t.others},   {"false_stops", t.false_stops}};
}

/// Of the dictionary, to learn what is no command from.
Result<std::vector<std::string>> CommonWords() {
  const std::string folder = speech::kModelFolder;
  const auto lexicon = speech::LoadLexicon(folder);
  if (!lexicon) return lexicon.error();
  const auto frequent = speech::FrequentWords(folder, *lexicon);
  if (!frequent) return frequent.error();
  std::vector<std::string> words;
  for (size_t i = 0; i < std::min<size_t>(6'000, frequent->size()); ++i)
    words.push_back((*frequent)[i].word);
  return words;
}

Status Learn(const Options& options, speech::Recogniser& recogniser,
             const std::vector<double>& babble) {
  const auto words = CommonWords();
  if (!words) return words.error();
  const Corpus corpus = MakeCorpus(Part::kLearn, static_cast<size_t>(options.inside),
                                   static_cast<size_t>(options.outside), options.seed, *words);
  Trials trials(recogniser, corpus, babble);
  std::vector<Example> examples;
  for (const Condition& condition :
       {Condition{}, Condition{Noise::kWhite, 20}, Condition{Noise::kBabble, 20}}) {
    auto run = trials.Run(condition, options.seed + 1);
    if (!run) return run.error();
    for (auto& trial : *run) {
      if (!trial.example.commands.empty()) examples.push_back(trial.example);
    }
  }
  std::ofstream(options.learn) << speech::ToToml(Fit(examples, 3));
  std::printf("fitted to %zu utterances: %s\n", examples.size(), options.learn.c_str());
  return {};
}

Status JudgeAll(const Options& options, speech::Recogniser& recogniser,
                const std::vector<double>& babble) {
  const Corpus corpus = MakeCorpus(Part::kJudge, static_cast<size_t>(options.inside),
                                   static_cast<size_t>(options.outside), options.seed + 1000);
  Trials trials(recogniser, corpus, babble);
  std::vector<Condition> conditions{{}};
  for (const Noise noise : {Noise::kWhite, Noise::kBabble}) {
    for (const double snr_dB : {20.0, 10.0, 5.0}) conditions.push_back({noise, snr_dB});
  }
  if (options.quiet_only) conditions.resize(1);
  nlohmann::json json = {{"seed", options.seed}};
  std::string table =
      "| noise | commands right | wrong | asked again | outside accepted | stop missed | false "
      "stop "
      "|\n|---|---|---|---|---|---|---|\n";
  std::string questions =
      "| asked, in quiet | commands right | wrong | outside accepted |\n|---|---|---|---|\n";
  std::string voices = "| voice, in quiet | commands right | outside accepted |\n|---|---|---|\n";
  for (const auto& condition : conditions) {
    auto run = trials.Run(condition, options.seed + 2);
    if (!run) return run.error();
    Tally all;
    std::map<std::string, Tally> by_voice;
    std::map<std::string, Tally> by_question;
    for (const auto& trial : *run) {
      all.Add(trial);
      by_voice[trial.utterance->voice.name].Add(trial);
      by_question[corpus.situations[trial.utterance->situation].name].Add(trial);
    }
    json["conditions"][Name(condition)] = ToJson(all);
    table += "| " + Name(condition) + " | " + Percent(all.right, all.inside) + " | " +
             std::to_string(all.wrong) + " | " + std::to_string(all.asked) + " | " +
             Percent(all.accepted, all.outside) + " | " + std::to_string(all.stops_missed) + " / " +
             std::to_string(all.stops) + " | " + Percent(all.false_stops, all.others) + " |\n";
    std::fprintf(stderr, "%s: %s right, %s accepted\n", Name(condition).c_str(),
                 Percent(all.right, all.inside).c_str(),
                 Percent(all.accepted, all.outside).c_str());
    if (condition.noise != Noise::kQuiet) continue;
    for (const auto& [question, tally] : by_question) {
      json["questions"][question] = ToJson(tally);
      questions += "| " + question + " | " + Percent(tally.right, tally.inside) + " | " +
                   std::to_string(tally.wrong) + " | " + Percent(tally.accepted, tally.outside) +
                   " |\n";
    }
    for (const auto& [voice, tally] : by_voice) {
      json["voices"][voice] = ToJson(tally);
      voices += "| " + voice + " | " + Percent(tally.right, tally.inside) + " | " +
                Percent(tally.accepted, tally.outside) + " |\n";
    }
  }
  const std::string tables = table + "\n" + questions + "\n" + voices;
  std::cout << tables;
  if (!options.json.empty()) std::ofstream(options.json) << json.dump(2) << "\n";
  if (!options.markdown.empty()) std::ofstream(options.markdown) << tables;
  return {};
}

Status Run(const Options& options) {
  speech::RecogniserConfig config;
  if (options.learn.empty()) {
    auto judgement = speech::LoadJudgement(options.model.empty() ? SharedFile("speech_model.toml")
                                                                 : options.model);
    if (!judgement) return judgement.error();
    config.judgement = *judgement;
  }
  auto recogniser = speech::Recogniser::Open(config);
  if (!recogniser) return recogniser.error();
  auto babble = Babble(30, options.seed + 3);
  if (!babble) return babble.error();
  return options.learn.empty() ? JudgeAll(options, **recogniser, *babble)
                               : Learn(options, **recogniser, *babble);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Judges the speech front end on synthetic speech.", "beckon-speech-judge");
  Options options;
  app.add_option("--commands", options.inside, "Commands said")->check(CLI::Range(1, 100'000));
  app.add_option("--others", options.outside, "Utterances outside the grammar")
      ->check(CLI::Range(0, 100'000));
  app.add_option("--seed", options.seed, "Of everything that is drawn");
  app.add_option("--learn", options.learn, "Fit the judgement and write it")->type_name("FILE");
  app.add_option("--model", options.model, "Judge with this, not the shipped one")
      ->type_name("FILE");
  app.add_option("--json", options.json, "Write the counts")->type_name("FILE");
  app.add_option("--markdown", options.markdown, "Write the tables")->type_name("FILE");
  app.add_flag("--quiet-only", options.quiet_only, "Leave the noises out");
  CLI11_PARSE(app, argc, argv);
  if (auto done = Run(options); !done) {
    std::fprintf(stderr, "beckon-speech-judge: %s\n", done.error().message.c_str());
    return 1;
  }
  return 0;
}
