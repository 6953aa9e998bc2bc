#include "bench/speech/corpus.h"

#include <algorithm>
#include <random>

#include "services/ui_bridge/speech/lexicon.h"

namespace beckon::bench {
namespace {

namespace speech = ui_bridge::speech;
using Texts = std::vector<std::string>;

const Texts& VoiceNames(Part part) {
  static const Texts learn = [] {
    Texts names;
    for (const char* accent : {"en-us", "en-gb", "en-gb-scotland", "en-gb-x-gbcwmd"}) {
      for (const char* variant : {"", "+m1", "+m3", "+m5", "+m8", "+f1", "+f3", "+f5", "+klatt",
                                  "+klatt3", "+Andy", "+Annie", "+Michael", "+Linda"})
        names.push_back(std::string(accent) + variant);
    }
    return names;
  }();
  static const Texts judge = {"en-gb-x-rp",    "en-029",      "en-us-nyc", "en-us+f2",
                              "en-gb+m2",      "en-us+m7",    "en-gb+f4",  "en-gb-x-gbclan+m4",
                              "en-gb-x-rp+f2", "en-us-nyc+m6"};
  return part == Part::kLearn ? learn : judge;
}

const Texts& Others(Part part) {
  static const Texts learn = {"table",
                              "window",
                              "go",
                              "now",
                              "shop",
                              "guess",
                              "less",
                              "nose",
                              "note",
                              "top",
                              "step",
                              "yet",
                              "mess",
                              "show",
                              "though",
                              "stock",
                              "stuff",
                              "steep",
                              "nest",
                              "start of the week",
                              "under",
                              "undone",
                              "assume",
                              "consume",
                              "cartoon",
                              "garden",
                              "rug",
                              "fan",
                              "man",
                              "eleven",
                              "twenty",
                              "number",
                              "please",
                              "thank you",
                              "good morning",
                              "what time is it",
                              "hmm",
                              "uh",
                              "oh",
                              "I am hungry",
                              "could you close the door",
                              "it is cold in here",
                              "where is my phone",
                              "the weather is fine today",
                              "can you hear me",
                              "I will call you later",
                              "let us go home",
                              "who is there",
                              "that was nice",
                              "did you see the game",
                              "turn the light on",
                              "my leg hurts",
                              "she went to the station",
                              "I need a blanket",
                              "what did you say",
                              "come over here",
                              "we had soup for lunch",
                              "the cat is on the sofa",
                              "happy birthday",
                              "not now",
                              "maybe",
                              "perhaps later",
                              "I do not know",
                              "of course",
                              "sure",
                              "all right",
                              "wait a minute",
                              "one moment",
                              "hello there",
                              "excuse me",
                              "television",
                              "radio",
                              "newspaper",
                              "water",
                              "coffee",
                              "pillow",
                              "glasses",
                              "kitchen",
                              "banana",
                              "elephant",
                              "computer",
                              "seven",
                              "box of",
                              "open sesame",
                              "move over",
                              "drink up",
                              "grass",
                              "most of these",
                              "done with these",
                              "repair",
                              "report",
                              "receive",
                              "zoo",
                              "reason",
                              "smart",
                              "dart",
                              "yesterday",
                              "nobody",
                              "nothing",
                              "stopwatch",
                              "unstoppable",
                              "knowing",
                              "yellow",
                              "know how"};
  static const Texts judge = {"chair",
                              "mirror",
                              "so",
                              "know it all",
                              "chop",
                              "stab",
                              "bless",
                              "dress",
                              "low",
                              "nor",
                              "nut",
                              "stay",
                              "stone",
                              "spot",
                              "yard",
                              "yesteryear",
                              "noon",
                              "nine",
                              "until",
                              "onto",
                              "wonder",
                              "presume",
                              "costume",
                              "heart",
                              "stark",
                              "defeat",
                              "complete",
                              "a cart",
                              "bottom",
                              "bold",
                              "tune",
                              "pushing",
                              "cap",
                              "tab",
                              "hug",
                              "fin",
                              "cupboard",
                              "Thursday",
                              "thirty five",
                              "sorry",
                              "good night",
                              "how are you",
                              "ah",
                              "er",
                              "mhm",
                              "I would like some tea",
                              "please shut up",
                              "the radio is too loud",
                              "have you seen my keys",
                              "it might rain tonight",
                              "are you listening",
                              "see you tomorrow",
                              "my sister lives in London",
                              "who was on the phone",
                              "what a lovely day",
                              "do you want sugar",
                              "turn it down a little",
                              "the nurse comes at ten",
                              "he sold his old car",
                              "I cannot find my shoes",
                              "tell me a story",
                              "put it over there",
                              "we should leave soon",
                              "the dog wants to go out",
                              "merry Christmas",
                              "later",
                              "I suppose so",
                              "probably",
                              "exactly",
                              "fine",
                              "hold on",
                              "just a second",
                              "good afternoon",
                              "pardon",
                              "garage",
                              "magazine",
                              "pencil",
                              "curtain",
                              "blanket",
                              "apple",
                              "crocodile",
                              "keyboard",
                              "eighteen",
                              "pour me a glass",
                              "squeeze in",
                              "push off",
                              "open wide",
                              "one of them",
                              "some of those",
                              "retreat",
                              "repaint",
                              "release",
                              "star",
                              "party",
                              "snow",
                              "toast",
                              "stomp",
                              "stops the bus",
                              "nowhere",
                              "notice",
                              "yes man",
                              "undergo",
                              "the bottle broke",
                              "two thirds",
                              "number plate"};
  return part == Part::kLearn ? learn : judge;
}

msg::Query Choice(msg::QueryKind kind, const Texts& options) {
  msg::Query query;
  query.kind = kind;
  for (const auto& text : options) {
    msg::Option option;
    option.text = text;
    query.options.push_back(option);
  }
  return query;
}

std::vector<Situation> Situations(Part part) {
  const bool learn = part == Part::kLearn;
  const Texts tasks = learn ? Texts{"Open the carton", "Move the nearest mug", "Drink from the can",
                                    "Grasp the spray can", "None of these"}
                            : Texts{"Pour from the bottle", "Squeeze the tube",
                                    "Push the second bowl", "Open the tin", "None of these"};
  const Texts names = learn ? Texts{"Bottle", "Bowl", "Box", "Carton", "None of these"}
                            : Texts{"Mug", "Cup", "Tube", "Spray can", "None of these"};
  std::vector<Situation> situations = {{"yes/no", Choice(msg::QueryKind::kFull, {"Yes", "No"})},
                                       {"tasks", Choice(msg::QueryKind::kChoice, tasks)},
                                       {"names", Choice(msg::QueryKind::kWhatIsIt, names)},
                                       {"nothing asked", std::nullopt}};
  if (!learn) return situations;
  for (const Texts& more : {Texts{"Close the lid", "Lift the glass", "Fetch the towel",
                                  "Put down the knife", "None of these"},
                            Texts{"Turn the page", "Hold the phone", "Shake the jar",
                                  "Give me the first book", "None of these"}}) {
    situations.push_back({"more tasks", Choice(msg::QueryKind::kChoice, more)});
  }
  for (const Texts& more : {Texts{"Plate", "Kettle", "Basket", "Jar", "None of these"},
                            Texts{"Knife", "Towel", "Jug", "Teapot", "None of these"},
                            Texts{"Can", "Glass", "Pen", "Shoe", "None of these"}}) {
    situations.push_back({"more names", Choice(msg::QueryKind::kWhatIsIt, more)});
  }
  return situations;
}

Voice Draw(Part part, size_t turn, std::mt19937_64& random) {
  const auto& names = VoiceNames(part);
  const auto speed = part == Part::kLearn ? 120 + 30 * (random() % 3) : 135 + 30 * (random() % 3);
  const auto pitch = part == Part::kLearn ? 35 + 15 * (random() % 3) : 30 + 12 * (random() % 4);
  return {names[turn % names.size()], static_cast<int>(speed), static_cast<int>(pitch)};
}

}  // namespace

Corpus MakeCorpus(Part part, size_t inside, size_t outside, uint64_t seed, const Texts& words) {
  Corpus corpus;
  corpus.situations = Situations(part);
  std::mt19937_64 random(seed);
  std::vector<Utterance> phrases;
  for (size_t s = 0; s < corpus.situations.size(); ++s) {
    const auto& query = corpus.situations[s].query;
    const auto commands = speech::CommandsFor(query ? &*query : nullptr, {});
    for (size_t c = 0; c < commands.size(); ++c) {
      // What is possible at any time counts once, with the yes/no question.
      if (s > 0 && commands[c].kind != speech::CommandKind::kOption &&
          commands[c].kind != speech::CommandKind::kResume &&
          commands[c].kind != speech::CommandKind::kStart) {
        continue;
      }
      for (const auto& phrase : commands[c].phrases) {
        Utterance utterance;
        utterance.situation = s;
        utterance.text = phrase;
        utterance.command = c;
        phrases.push_back(utterance);
      }
    }
  }
  while (corpus.inside.size() < inside) {
    std::ranges::shuffle(phrases, random);
    for (size_t i = 0; i < phrases.size() && corpus.inside.size() < inside; ++i) {
      corpus.inside.push_back(phrases[i]);
      corpus.inside.back().voice = Draw(part, random() % 64, random);
    }
  }
  Texts others = Others(part);
  if (!words.empty()) {
    // Half of it is words of the dictionary, one or some at a time.
    const auto& unseen = Others(Part::kJudge);
    const size_t n = 2 * others.size();
    while (others.size() < n) {
      std::string text = words[random() % words.size()];
      if (random() % 4 == 0) text += " " + words[random() % std::min<size_t>(600, words.size())];
      const bool said = std::ranges::any_of(phrases, [&](const auto& p) { return p.text == text; });
      if (!said && std::ranges::find(unseen, text) == unseen.end()) others.push_back(text);
    }
  }
  while (corpus.outside.size() < outside) {
    std::ranges::shuffle(others, random);
    for (size_t i = 0; i < others.size() && corpus.outside.size() < outside; ++i) {
      const size_t situation = random() % 2 == 0 ? 0 : random() % corpus.situations.size();
      corpus.outside.push_back({Draw(part, random() % 64, random), situation, others[i], {}});
    }
  }
  return corpus;
}

}  // namespace beckon::bench
