// Questions as propositions about what is wanted: "the action is one of a set and the object one of
// a set". A yes/no question puts one of them to the user, a choice several.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/intention/core/phrases.h"
#include "services/intention/core/situation.h"

namespace beckon::intention {

/// The set of all actions, or of all objects ("any").
inline constexpr uint64_t kAny = ~uint64_t{0};

enum class QuestionKind { kAction, kObject, kFull, kCategory, kSet, kChoice };

/// "action", "object", "full", "category", "set", "choice".
const char* Name(QuestionKind kind);

/// The wanted action is one of `actions` and the wanted object one of `objects`.
struct Proposition {
  uint64_t actions = kAny;  // bits are indices of Affordances::actions()
  uint64_t objects = kAny;  // bits are indices of Situation::objects
  int pair = -1;  // of one action and one object: the candidate that saying so accepts; < 0 where
                  // it is absent

  bool Holds(const Pair& wanted) const {
    return (actions >> wanted.action & 1) != 0 && (objects >> wanted.object & 1) != 0;
  }
  bool operator==(const Proposition&) const = default;
};

/// What is put to the user. The answers are its options in their order and, last, "none of them":
/// a yes/no question has one option ("Yes") and "No". Where several options hold the first is
/// meant.
struct Question {
  QuestionKind kind = QuestionKind::kFull;
  std::vector<Proposition> options;

  int answers() const { return static_cast<int>(options.size()) + 1; }
  /// The last answer: "No", "None of these".
  int none() const { return static_cast<int>(options.size()); }
  /// Index of the answer that a user means who wants `wanted`.
  int Meant(const Pair& wanted) const {
    int answer = 0;
    while (answer < none() && !options[answer].Holds(wanted)) ++answer;
    return answer;
  }
  /// The candidate that an answer accepts, or < 0.
  int Accepts(int answer) const { return answer < none() ? options[answer].pair : -1; }
  bool operator==(const Question&) const = default;
};

inline Question AskYesNo(QuestionKind kind, const Proposition& proposition) {
  return {kind, {proposition}};
}
inline Question AskAction(int action) {
  return AskYesNo(QuestionKind::kAction, {uint64_t{1} << action, kAny, -1});
}
inline Question AskObject(int object) {
  return AskYesNo(QuestionKind::kObject, {kAny, uint64_t{1} << object, -1});
}
/// "It is this pair."
inline Proposition PairProposition(const Situation& situation, int pair) {
  const Pair& wanted = situation.pairs[pair];
  return {uint64_t{1} << wanted.action, uint64_t{1} << wanted.object, pair};
}
inline Question AskPair(const Situation& situation, int pair) {
  return AskYesNo(QuestionKind::kFull, PairProposition(situation, pair));
}

/// The question as the user reads it: "Open the nearest carton?".
std::string Text(const Affordances& affordances, const Situation& situation,
                 const Question& question, const Phrases& phrases = English());
/// A question that was asked before: "Once more, to be sure: open the nearest carton?".
std::string TextAgain(const Affordances& affordances, const Situation& situation,
                      const Question& question, const Phrases& phrases = English());
/// An option of a choice: "Open the carton", "Pour from something", "The second mug".
std::string OptionText(const Affordances& affordances, const Situation& situation,
                       const Proposition& option, const Phrases& phrases = English());
/// "the carton", "the nearest mug", "the second mug", in the language's first case.
std::string TheObject(const Affordances& affordances, const Situation& situation, int object,
                      const Phrases& phrases = English());
/// A sentence with {object}: "The second mug has moved."
std::string ObjectText(const Affordances& affordances, const Situation& situation, int object,
                       const std::string& sentence, const Phrases& phrases);
/// "Open the nearest carton".
std::string TaskText(const Affordances& affordances, const Situation& situation, const Pair& pair,
                     const Phrases& phrases = English());
/// The same of a task that is remembered without its scene: "Open the carton".
std::string TaskText(const Affordances& affordances, const std::string& action,
                     const std::string& category, const Phrases& phrases);

inline std::string Noun(const std::string& category) { return NounOf(English(), category).one; }
inline std::string WithArticle(const std::string& noun) { return ANoun(English(), noun); }

}  // namespace beckon::intention
