// The words of questions.
#include "services/intention/core/question.h"

#include <bit>
#include <cctype>
#include <vector>

namespace beckon::intention {
namespace {

std::string Plural(const std::string& noun) {
  const bool hisses =
      noun.ends_with('x') || noun.ends_with('s') || noun.ends_with("ch") || noun.ends_with("sh");
  return noun + (hisses ? "es" : "s");
}

std::string Capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// "a", "a or b", "a, b or c".
std::string Listed(const std::vector<std::string>& parts) {
  std::string text;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? " or " : ", ";
    text += parts[i];
  }
  return text;
}

std::string Ordinal(int n) {
  static const char* const kWords[] = {"",      "nearest", "second", "third", "fourth", "fifth",
                                       "sixth", "seventh", "eighth", "ninth", "tenth"};
  if (n <= 10) return kWords[n];
  const bool teen = n % 100 >= 11 && n % 100 <= 13;
  const char* suffix = teen          ? "th"
                       : n % 10 == 1 ? "st"
                       : n % 10 == 2 ? "nd"
                       : n % 10 == 3 ? "rd"
                                     : "th";
  return std::to_string(n) + suffix;
}

std::vector<int> Members(uint64_t mask, int count) {
  std::vector<int> members;
  for (int i = 0; i < count; ++i) {
    if (mask >> i & 1) members.push_back(i);
  }
  return members;
}

std::string ActionWords(const Affordances& affordances, uint64_t actions) {
  std::vector<std::string> words;
  for (const int action : Members(actions, static_cast<int>(affordances.actions().size()))) {
    words.push_back(affordances.actions()[action].words);
  }
  return Listed(words);
}

/// Whether the set is all objects up to some value of `key`, in ascending order.
template <typename Key>
bool IsPrefix(const Situation& situation, uint64_t objects, Key key) {
  for (size_t in = 0; in < situation.objects.size(); ++in) {
    if ((objects >> in & 1) == 0) continue;
    for (size_t out = 0; out < situation.objects.size(); ++out) {
      if ((objects >> out & 1) != 0) continue;
      if (key(situation.objects[out]) <= key(situation.objects[in])) return false;
    }
  }
  return true;
}

std::string SetText(const Affordances& affordances, const Situation& situation, uint64_t objects) {
  const int count = std::popcount(objects);
  if (count > 1) {
    const std::string number = std::to_string(count);
    if (IsPrefix(situation, objects, [](const Instance& o) { return o.distance_m; })) {
      return "Is it one of the " + number + " objects nearest to you?";
    }
    if (situation.has_lateral &&
        IsPrefix(situation, objects, [](const Instance& o) { return o.lateral_m; })) {
      return "Is it one of the " + number + " objects furthest to the left?";
    }
  }
  std::vector<std::string> names;
  for (const int object : Members(objects, static_cast<int>(situation.objects.size()))) {
    names.push_back(TheObject(affordances, situation, object));
  }
  return "Is it one of these: " + Listed(names) + "?";
}

}  // namespace

const char* Name(QuestionKind kind) {
  switch (kind) {
    case QuestionKind::kAction:
      return "action";
    case QuestionKind::kObject:
      return "object";
    case QuestionKind::kFull:
      return "full";
    case QuestionKind::kCategory:
      return "category";
    case QuestionKind::kSet:
      return "set";
    case QuestionKind::kChoice:
      return "choice";
  }
  return "full";
}

std::string Noun(const std::string& category) {
  std::string noun;
  for (size_t i = 0; i < category.size(); ++i) {
    const auto letter = static_cast<unsigned char>(category[i]);
    if (std::isupper(letter) && i > 0) noun += ' ';
    noun += static_cast<char>(std::tolower(letter));
  }
  return noun;
}

std::string WithArticle(const std::string& noun) {
  const bool vowel = !noun.empty() && std::string("aeiou").find(noun[0]) != std::string::npos;
  return (vowel ? "an " : "a ") + noun;
}

std::string TheObject(const Affordances& affordances, const Situation& situation, int object) {
  const Instance& instance = situation.objects[object];
  if (instance.category < 0) return "the unknown object";
  const std::string noun = Noun(affordances.categories()[instance.category].name);
  if (std::popcount(situation.MaskOf(instance.category)) == 1) return "the " + noun;
  return "the " + Ordinal(instance.rank) + " " + noun;
}

std::string TaskText(const Affordances& affordances, const Situation& situation, const Pair& pair) {
  return Capitalised(affordances.actions()[pair.action].words) + " " +
         TheObject(affordances, situation, pair.object);
}

std::string OptionText(const Affordances& affordances, const Situation& situation,
                       const Proposition& option) {
  if (option.pair >= 0) return TaskText(affordances, situation, situation.pairs[option.pair]);
  if (option.objects == kAny) {
    return Capitalised(ActionWords(affordances, option.actions)) + " something";
  }
  std::vector<std::string> names;
  for (const int object : Members(option.objects, static_cast<int>(situation.objects.size()))) {
    names.push_back(TheObject(affordances, situation, object));
  }
  return Capitalised(Listed(names));
}

std::string Text(const Affordances& affordances, const Situation& situation,
                 const Question& question) {
  if (question.kind == QuestionKind::kChoice || question.options.empty()) return "Which is it?";
  const Proposition& asked = question.options.front();
  const auto objects = Members(asked.objects, static_cast<int>(situation.objects.size()));
  switch (question.kind) {
    case QuestionKind::kAction:
      return "Do you want to " + ActionWords(affordances, asked.actions) + " something?";
    case QuestionKind::kObject:
      if (!objects.empty())
        return "Is it about " + TheObject(affordances, situation, objects[0]) + "?";
      break;
    case QuestionKind::kFull:
      if (asked.pair >= 0)
        return TaskText(affordances, situation, situation.pairs[asked.pair]) + "?";
      break;
    case QuestionKind::kCategory:
      if (!objects.empty()) {
        const int category = situation.objects[objects[0]].category;
        return "Is it about one of the " + Plural(Noun(affordances.categories()[category].name)) +
               "?";
      }
      break;
    case QuestionKind::kSet:
      return SetText(affordances, situation, asked.objects);
    case QuestionKind::kChoice:
      break;
  }
  return "Is it something else?";
}

}  // namespace beckon::intention
