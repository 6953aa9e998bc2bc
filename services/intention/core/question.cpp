// The words of questions.
#include "services/intention/core/question.h"

#include <bit>
#include <vector>

namespace beckon::intention {
namespace {

/// Noun phrases and verbs, by case.
using Forms = std::map<std::string, std::string>;

std::vector<int> Members(uint64_t mask, size_t count) {
  std::vector<int> members;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    if (mask >> i & 1) members.push_back(i);
  }
  return members;
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

/// Says things about a situation.
class Speaker {
 public:
  Speaker(const Affordances& affordances, const Situation& situation, const Phrases& phrases)
      : affordances_(affordances), situation_(situation), phrases_(phrases) {}

  /// "the second mug"
  Forms One(int object) const {
    const Instance& instance = situation_.objects[object];
    const bool known = instance.category >= 0;
    const std::string category =
        known ? affordances_.categories()[instance.category].name : "Unknown";
    const bool alone = !known || std::popcount(situation_.MaskOf(instance.category)) == 1;
    return OfCategory(category, alone ? 0 : instance.rank);
  }

  /// "the mug" (rank 0), "the second mug", "mug number 13"
  Forms OfCategory(const std::string& category, int rank) const {
    const NounWord noun = NounOf(phrases_, category);
    Forms forms;
    for (const std::string& in : phrases_.cases) {
      const NounForms& said = NounFormsOf(noun, in);
      const Forms one = {{"", noun.one_in.contains(in) ? noun.one_in.at(in) : noun.one}};
      if (rank > static_cast<int>(phrases_.ranks.size())) {
        forms[in] = Fill(phrases_, phrases_.numbered,
                         {{"noun", one}, {"number", {{"", std::to_string(rank)}}}});
      } else if (rank > 0) {
        forms[in] = Fill(phrases_, said.ranked,
                         {{"noun", one}, {"rank", {{"", phrases_.ranks[rank - 1]}}}});
      } else {
        forms[in] = Fill(phrases_, said.the, {{"noun", one}});
      }
    }
    return forms;
  }

  /// "the carton", "one of the mugs", "one of the three objects nearest to you", "the carton or the
  /// mug", "something"
  Forms Some(uint64_t objects) const {
    const auto members = Members(objects, situation_.objects.size());
    if (objects == kAny || members.empty()) return EveryCase(phrases_.something);
    if (members.size() == 1) return One(members[0]);
    const int category = situation_.objects[members[0]].category;
    if (category >= 0 && situation_.MaskOf(category) == objects) return OneOf(category);
    if (const auto group = GroupOf(objects); group != &GroupForms::outlined || members.size() > 2)
      return Group(group, members.size());
    const Forms first = One(members[0]), second = One(members[1]);
    Forms forms;
    for (const std::string& in : phrases_.cases) forms[in] = Listed({first.at(in), second.at(in)});
    return forms;
  }

  std::string Task(int action, const Forms& object) const {
    return Fill(phrases_, VerbOf(phrases_, affordances_.actions()[action]).task,
                {{"object", object}});
  }

  /// "open one of the mugs", "drink from the mug or grasp the mug"
  std::string Tasks(const Proposition& asked) const {
    const Forms object = Some(asked.objects);
    std::vector<std::string> tasks;
    for (const int action : Actions(asked)) {
      tasks.push_back(asked.objects == kAny ? VerbOf(phrases_, affordances_.actions()[action]).any
                                            : Task(action, object));
    }
    return Listed(tasks);
  }

  /// Of a yes/no question, not capitalised.
  std::string Ask(const Proposition& asked) const {
    const auto actions = Actions(asked);
    const auto objects = Members(asked.objects, situation_.objects.size());
    if (asked.actions == kAny) {
      const bool group = objects.size() != 1 && !IsCategory(asked.objects);
      return Fill(phrases_, group ? phrases_.set : phrases_.object,
                  {{"object", Some(asked.objects)}});
    }
    if (asked.objects != kAny) {
      const bool full = actions.size() == 1 && objects.size() == 1;
      return Fill(phrases_, full ? phrases_.full : phrases_.both, "task", Tasks(asked));
    }
    if (actions.size() == 1) return Fill(phrases_, phrases_.action, "action", Tasks(asked));
    std::vector<std::string> words;
    for (const int action : actions)
      words.push_back(VerbOf(phrases_, affordances_.actions()[action]).bare);
    return Fill(phrases_, phrases_.actions, "actions", Listed(words));
  }

  /// Of a choice.
  std::string Which(const Question& question) const {
    bool actions = true, objects = true;
    for (const Proposition& option : question.options) {
      actions &= option.objects == kAny;
      objects &= option.actions == kAny;
    }
    return actions == objects ? phrases_.which
           : actions          ? phrases_.which_action
                              : phrases_.which_object;
  }

 private:
  std::vector<int> Actions(const Proposition& asked) const {
    return Members(asked.actions, affordances_.actions().size());
  }

  const NounForms& NounFormsOf(const NounWord& noun, const std::string& in) const {
    return phrases_.genders.at(noun.gender).forms.at(in);
  }

  bool IsCategory(uint64_t objects) const {
    const auto members = Members(objects, situation_.objects.size());
    if (objects == kAny || members.empty()) return false;
    const int category = situation_.objects[members[0]].category;
    return category >= 0 && situation_.MaskOf(category) == objects;
  }

  Forms OneOf(int category) const {
    const NounWord noun = NounOf(phrases_, affordances_.categories()[category].name);
    Forms forms;
    for (const std::string& in : phrases_.cases) {
      const std::string& many = noun.many_in.contains(in) ? noun.many_in.at(in) : noun.many;
      forms[in] = Fill(phrases_, NounFormsOf(noun, in).one_of, "nouns", many);
    }
    return forms;
  }

  /// What all objects of a set have in common and the others have not.
  std::string GroupForms::*GroupOf(uint64_t objects) const {
    const auto distance = [](const Instance& o) { return o.distance_m; };
    const auto lateral = [](const Instance& o) { return o.lateral_m; };
    if (IsPrefix(situation_, objects, distance)) return &GroupForms::nearest;
    if (IsPrefix(situation_, objects, [&](const Instance& o) { return -distance(o); }))
      return &GroupForms::farthest;
    if (!situation_.has_lateral) return &GroupForms::outlined;
    if (IsPrefix(situation_, objects, lateral)) return &GroupForms::left;
    if (IsPrefix(situation_, objects, [&](const Instance& o) { return -lateral(o); }))
      return &GroupForms::right;
    return &GroupForms::outlined;
  }

  Forms Group(std::string GroupForms::*group, size_t count) const {
    const std::string number =
        count <= phrases_.numbers.size() ? phrases_.numbers[count - 1] : std::to_string(count);
    Forms forms;
    for (const auto& [in, said] : phrases_.groups)
      forms[in] = Fill(phrases_, said.*group, "count", number);
    return forms;
  }

  Forms EveryCase(const std::string& text) const {
    Forms forms;
    for (const std::string& in : phrases_.cases) forms[in] = text;
    return forms;
  }

  /// "a", "a or b", "a, b or c".
  std::string Listed(const std::vector<std::string>& parts) const {
    std::string text;
    for (size_t i = 0; i < parts.size(); ++i) {
      if (i > 0) text += i + 1 == parts.size() ? phrases_.list_or : phrases_.list_comma;
      text += parts[i];
    }
    return text;
  }

  const Affordances& affordances_;
  const Situation& situation_;
  const Phrases& phrases_;
};

std::string Raw(const Affordances& affordances, const Situation& situation,
                const Question& question, const Phrases& phrases) {
  const Speaker speaker(affordances, situation, phrases);
  if (question.kind == QuestionKind::kChoice) return speaker.Which(question);
  return question.options.empty() ? phrases.which : speaker.Ask(question.options.front());
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

std::string TheObject(const Affordances& affordances, const Situation& situation, int object,
                      const Phrases& phrases) {
  return Speaker(affordances, situation, phrases).One(object).at(phrases.cases.front());
}

std::string ObjectText(const Affordances& affordances, const Situation& situation, int object,
                       const std::string& sentence, const Phrases& phrases) {
  const Speaker speaker(affordances, situation, phrases);
  return Finished(Fill(phrases, sentence, {{"object", speaker.One(object)}}));
}

std::string TaskText(const Affordances& affordances, const Situation& situation, const Pair& pair,
                     const Phrases& phrases) {
  const Speaker speaker(affordances, situation, phrases);
  return Finished(speaker.Task(pair.action, speaker.One(pair.object)));
}

std::string TaskText(const Affordances& affordances, const std::string& action,
                     const std::string& category, const Phrases& phrases) {
  const Situation nothing;
  const Speaker speaker(affordances, nothing, phrases);
  const int known = affordances.FindAction(action);
  if (known < 0) return action + " " + category;
  return Finished(speaker.Task(known, speaker.OfCategory(category, 0)));
}

std::string OptionText(const Affordances& affordances, const Situation& situation,
                       const Proposition& option, const Phrases& phrases) {
  const Speaker speaker(affordances, situation, phrases);
  const bool object_only = option.actions == kAny;
  return Finished(object_only ? speaker.Some(option.objects).at(phrases.cases.front())
                              : speaker.Tasks(option));
}

std::string Text(const Affordances& affordances, const Situation& situation,
                 const Question& question, const Phrases& phrases) {
  return Finished(Raw(affordances, situation, question, phrases));
}

std::string TextAgain(const Affordances& affordances, const Situation& situation,
                      const Question& question, const Phrases& phrases) {
  return Finished(
      Fill(phrases, phrases.again, "question", Raw(affordances, situation, question, phrases)));
}

}  // namespace beckon::intention
