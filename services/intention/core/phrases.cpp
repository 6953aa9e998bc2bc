#include "services/intention/core/phrases.h"

#include <algorithm>
#include <cctype>
#include <optional>

namespace beckon::intention {
namespace {

/// A piece of a template: text, or a placeholder with the case it names.
struct Piece {
  std::string text;  // or the placeholder's name
  std::string in;    // its case
  bool placeholder = false;
};

/// Nothing where a brace is left open or alone.
std::optional<std::vector<Piece>> Split(const std::string& text) {
  std::vector<Piece> pieces;
  size_t at = 0;
  while (at < text.size()) {
    const size_t brace = text.find_first_of("{}", at);
    if (brace != at) pieces.push_back({text.substr(at, brace - at), "", false});
    if (brace == std::string::npos) break;
    const size_t close = text.find_first_of("{}", brace + 1);
    if (text[brace] == '}' || close == std::string::npos || text[close] == '{') return {};
    const std::string inner = text.substr(brace + 1, close - brace - 1);
    const size_t dot = inner.find('.');
    pieces.push_back({inner.substr(0, dot), dot == std::string::npos ? "" : inner.substr(dot + 1),
                      /*placeholder=*/true});
    at = close + 1;
  }
  return pieces;
}

/// Bytes of a sentence, so that it fits into a message.
constexpr size_t kLongestText = 1000;

/// The placeholder that may name a case.
constexpr char kCased[] = "object";

std::string Expected(const std::vector<std::string>& placeholders,
                     const std::vector<std::string>& cases) {
  if (placeholders.empty()) return "expected no placeholder";
  std::string text;
  for (const std::string& name : placeholders) {
    text += (text.empty() ? "expected {" : " and {") + name + "}";
    if (name != kCased) continue;
    for (const std::string& in : cases) text += " or {" + name + "." + in + "}";
  }
  return text;
}

std::string Plural(const std::string& noun) {
  const bool hisses =
      noun.ends_with('x') || noun.ends_with('s') || noun.ends_with("ch") || noun.ends_with("sh");
  return noun + (hisses ? "es" : "s");
}

/// "SprayCan" -> "spray can".
NounWord MadeFrom(const Phrases& phrases, const std::string& category) {
  NounWord noun;
  for (size_t i = 0; i < category.size(); ++i) {
    const auto letter = static_cast<unsigned char>(category[i]);
    if (std::isupper(letter) && i > 0) noun.one += ' ';
    noun.one += static_cast<char>(std::tolower(letter));
  }
  noun.many = Plural(noun.one);
  if (!phrases.genders.empty()) noun.gender = phrases.genders.begin()->first;
  for (const auto& [name, gender] : phrases.genders) {
    if (!noun.one.empty() && gender.starts.find(noun.one[0]) != std::string::npos)
      noun.gender = name;
  }
  return noun;
}

}  // namespace

const std::vector<Sentence>& Sentences() {
  static const std::vector<Sentence> sentences = {
      {"questions", "action", &Phrases::action, {"action"}},
      {"questions", "actions", &Phrases::actions, {"actions"}},
      {"questions", "object", &Phrases::object, {"object"}},
      {"questions", "set", &Phrases::set, {"object"}},
      {"questions", "full", &Phrases::full, {"task"}},
      {"questions", "both", &Phrases::both, {"task"}},
      {"questions", "which", &Phrases::which, {}},
      {"questions", "which_action", &Phrases::which_action, {}},
      {"questions", "which_object", &Phrases::which_object, {}},
      {"questions", "what_is_it", &Phrases::what_is_it, {}},
      {"questions", "again", &Phrases::again, {"question"}},
      {"answers", "yes", &Phrases::yes, {}},
      {"answers", "no", &Phrases::no, {}},
      {"answers", "none_of_these", &Phrases::none_of_these, {}},
      {"answers", "something", &Phrases::something, {}},
      {"why", "wanted_last_time", &Phrases::wanted_last_time, {"task"}},
      {"why", "wanted_each_time", &Phrases::wanted_each_time, {"task", "sessions"}},
      {"why", "wanted_often", &Phrases::wanted_often, {"task", "times", "sessions"}},
      {"why", "wanted_before", &Phrases::wanted_before, {"task"}},
      {"why", "only_task", &Phrases::only_task, {}},
      {"why", "likeliest_task", &Phrases::likeliest_task, {"count"}},
      {"why", "halves", &Phrases::halves, {"count"}},
      {"why", "tells_most", &Phrases::tells_most, {"count"}},
      {"why", "settles", &Phrases::settles, {}},
      {"why", "one_follows", &Phrases::one_follows, {}},
      {"why", "more_follow", &Phrases::more_follow, {"count"}},
      {"why", "because", &Phrases::because, {"reason", "outlook"}},
      {"why", "looks_like", &Phrases::looks_like, {"objects"}},
      {"why", "looks", &Phrases::looks, {"object", "percent"}},
      {"why", "looks_unclear", &Phrases::looks_unclear, {}},
      {"why", "looks_wrong", &Phrases::looks_wrong, {}},
      {"session", "done", &Phrases::done, {"task"}},
      {"session", "waiting_for_picture", &Phrases::waiting_for_picture, {}},
      {"session", "waiting_for_table", &Phrases::waiting_for_table, {}},
      {"session", "waiting_for_objects", &Phrases::waiting_for_objects, {}},
      {"session", "waiting_for_poses", &Phrases::waiting_for_poses, {}},
      {"session", "nothing_to_do", &Phrases::nothing_to_do, {}},
      {"session", "none_of_the_tasks", &Phrases::none_of_the_tasks, {}},
      {"session", "start_again", &Phrases::start_again, {}},
      {"session", "taken_over", &Phrases::taken_over, {}},
      {"session", "object_moved", &Phrases::object_moved, {"object"}},
      {"session", "object_gone", &Phrases::object_gone, {"object"}},
      {"session", "looking_for", &Phrases::looking_for, {"object"}},
      {"session", "out_of_sight", &Phrases::out_of_sight, {"object"}},
      {"session", "not_remembered", &Phrases::not_remembered, {"reason"}},
      {"session", "cancelled", &Phrases::cancelled, {}},
      {"session", "stopped", &Phrases::stopped, {}},
      {"session", "no_robot", &Phrases::no_robot, {}},
      {"session", "revoked", &Phrases::revoked, {}}};
  return sentences;
}

Status CheckTemplate(const std::string& text, const std::vector<std::string>& placeholders,
                     const std::vector<std::string>& cases) {
  constexpr size_t kLongest = 300;
  if (text.empty()) return Error{"is empty, expected a text"};
  if (text.size() > kLongest) return Error{"is longer than " + std::to_string(kLongest) + " bytes"};
  if (std::any_of(text.begin(), text.end(), [](char c) { return c >= 0 && c < ' '; }))
    return Error{"holds a line break or another control character, expected one line"};
  const auto pieces = Split(text);
  const std::string expected = Expected(placeholders, cases);
  if (!pieces) return Error{"a brace has no partner, " + expected};
  const auto is = [](const std::string& name) {
    return [name](const auto& other) { return other == name; };
  };
  for (const Piece& piece : *pieces) {
    if (!piece.placeholder) continue;
    const std::string shown = "{" + piece.text + (piece.in.empty() ? "" : "." + piece.in) + "}";
    const bool known = std::any_of(placeholders.begin(), placeholders.end(), is(piece.text));
    const bool case_known =
        piece.in.empty() ||
        (piece.text == kCased && std::any_of(cases.begin(), cases.end(), is(piece.in)));
    if (!known || !case_known) return Error{"unknown placeholder " + shown + ", " + expected};
  }
  for (const std::string& name : placeholders) {
    const bool used = std::any_of(pieces->begin(), pieces->end(), [&](const Piece& piece) {
      return piece.placeholder && piece.text == name;
    });
    if (!used) return Error{"{" + name + "} is missing, " + expected};
  }
  return {};
}

std::string Fill(const Phrases& phrases, const std::string& text, const Values& values) {
  std::string filled;
  for (const Piece& piece : Split(text).value_or(std::vector<Piece>{})) {
    if (!piece.placeholder) filled += piece.text;
    for (const auto& [name, by_case] : values) {
      if (!piece.placeholder || name != piece.text || by_case.empty()) continue;
      const auto form = by_case.find(piece.in.empty() ? phrases.cases.front() : piece.in);
      filled += form == by_case.end() ? by_case.begin()->second : form->second;
    }
  }
  return filled;
}

std::string Fill(const Phrases& phrases, const std::string& text, const std::string& placeholder,
                 const std::string& value) {
  return Fill(phrases, text, {{placeholder, {{"", value}}}});
}

std::string Finished(std::string text) {
  if (text.empty()) return text;
  const auto first = static_cast<unsigned char>(text[0]);
  const auto second = static_cast<unsigned char>(text.size() > 1 ? text[1] : 0);
  if (first < 0x80) text[0] = static_cast<char>(std::toupper(first));
  // UTF-8 of U+00E0..U+00FE but the division sign.
  if (first == 0xC3 && second >= 0xA0 && second <= 0xBE && second != 0xB7)
    text[1] = static_cast<char>(second - 0x20);
  if (text.size() <= kLongestText) return text;
  size_t end = kLongestText;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

NounWord NounOf(const Phrases& phrases, const std::string& category) {
  const auto found = phrases.nouns.find(category);
  return found == phrases.nouns.end() ? MadeFrom(phrases, category) : found->second;
}

VerbWords VerbOf(const Phrases& phrases, const Action& action) {
  const auto found = phrases.verbs.find(action.name);
  if (found != phrases.verbs.end()) return found->second;
  // {object} stays for the task to fill in.
  const auto with_words = [&](std::string text) {
    static const std::string kWords = "{words}";
    for (size_t at = text.find(kWords); at != std::string::npos;
         at = text.find(kWords, at + action.words.size())) {
      text.replace(at, kWords.size(), action.words);
    }
    return text;
  };
  const VerbWords& other = phrases.other_verb;
  return {with_words(other.any), with_words(other.bare), with_words(other.task)};
}

std::string ANoun(const Phrases& phrases, const std::string& category) {
  const NounWord noun = NounOf(phrases, category);
  const std::string& in = phrases.cases.front();
  return Fill(phrases, phrases.genders.at(noun.gender).forms.at(in).a, "noun",
              noun.one_in.contains(in) ? noun.one_in.at(in) : noun.one);
}

std::vector<std::string> MissingWords(const Phrases& phrases, const Affordances& affordances) {
  std::vector<std::string> missing;
  if (phrases.names_are_words) return missing;
  for (const Category& category : affordances.categories()) {
    if (!phrases.nouns.contains(category.name))
      missing.push_back("[nouns] lacks " + category.name + ", it is called '" +
                        NounOf(phrases, category.name).one + "'");
  }
  for (const Action& action : affordances.actions()) {
    if (!phrases.verbs.contains(action.name))
      missing.push_back("[verbs] lacks " + action.name + ", it is called '" +
                        VerbOf(phrases, action).bare + "'");
  }
  return missing;
}

}  // namespace beckon::intention
