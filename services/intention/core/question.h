// A yes/no question as a proposition: the wanted action is one of a set and the wanted object one
// of a set.
#pragma once

#include <cstdint>
#include <string>

#include "services/intention/core/situation.h"

namespace beckon::intention {

/// The set of all actions, or of all objects ("any").
inline constexpr uint64_t kAny = ~uint64_t{0};

enum class QuestionKind { kAction, kObject, kFull, kCategory, kSet };

/// "action", "object", "full", "category", "set".
const char* Name(QuestionKind kind);

struct Question {
  QuestionKind kind = QuestionKind::kFull;
  uint64_t actions = kAny;  // bits are indices of Affordances::actions()
  uint64_t objects = kAny;  // bits are indices of Situation::objects
  int pair = -1;  // of a full question: the candidate that a yes accepts; < 0 where it is absent

  /// Whether a user who wants `wanted` means yes.
  bool Holds(const Pair& wanted) const {
    return (actions >> wanted.action & 1) != 0 && (objects >> wanted.object & 1) != 0;
  }
  bool operator==(const Question&) const = default;
};

inline Question AskAction(int action) {
  return {QuestionKind::kAction, uint64_t{1} << action, kAny, -1};
}
inline Question AskObject(int object) {
  return {QuestionKind::kObject, kAny, uint64_t{1} << object, -1};
}
inline Question AskPair(const Situation& situation, int pair) {
  const Pair& wanted = situation.pairs[pair];
  return {QuestionKind::kFull, uint64_t{1} << wanted.action, uint64_t{1} << wanted.object, pair};
}

/// The question in plain English: "Open the nearest carton?".
std::string Text(const Affordances& affordances, const Situation& situation,
                 const Question& question);
/// "the carton", "the nearest mug", "the second mug".
std::string TheObject(const Affordances& affordances, const Situation& situation, int object);
/// "Open the nearest carton".
std::string TaskText(const Affordances& affordances, const Situation& situation, const Pair& pair);
/// "SprayCan" -> "spray can"; "a spray can", "an apple".
std::string Noun(const std::string& category);
std::string WithArticle(const std::string& noun);

}  // namespace beckon::intention
