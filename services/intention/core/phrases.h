// The words that the user reads, in any language: templates with {placeholders}, nouns and verbs
// with the forms that the language needs. The defaults are English, as questions.en.toml.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "services/base/result.h"
#include "services/intention/core/affordances.h"

namespace beckon::intention {

/// A category's word. {one} and {many} may differ from case to case ("Mensch",
/// dative "Menschen").
struct NounWord {
  std::string gender;  // a key of Phrases::genders
  std::string one;
  std::string many;
  std::map<std::string, std::string> one_in;   // by case, where it differs from `one`
  std::map<std::string, std::string> many_in;  // by case, where it differs from `many`

  bool operator==(const NounWord&) const = default;
};

/// How a noun of a gender stands in a sentence, in one case.
struct NounForms {
  std::string the;     // {noun}: "the {noun}"
  std::string ranked;  // {noun} {rank}: "the {rank} {noun}"
  std::string a;       // {noun}: "a {noun}"
  std::string one_of;  // {nouns}: "one of the {nouns}"

  bool operator==(const NounForms&) const = default;
};

struct Gender {
  std::string starts;  // a noun made from a name is of this gender if it starts with one of these
  std::map<std::string, NounForms> forms;  // by case

  bool operator==(const Gender&) const = default;
};

/// Several objects that share no category, in one case; {count} is how many.
struct GroupForms {
  std::string nearest;
  std::string farthest;
  std::string left;
  std::string right;
  std::string outlined;  // the front end outlines them

  bool operator==(const GroupForms&) const = default;
};

/// An action's words.
struct VerbWords {
  std::string any;   // "drink from something"
  std::string bare;  // "drink from", as it stands in a list of actions
  std::string task;  // {object}: "drink from {object}"

  bool operator==(const VerbWords&) const = default;
};

/// Templates begin in lower case; a finished sentence is capitalised. {object} stands in the
/// language's first case, {object.dative} in that one.
struct Phrases {
  std::vector<std::string> cases;  // names; the first is that of {object}
  std::map<std::string, Gender> genders;
  std::string numbered;                      // {noun} {number}: "{noun} number {number}"
  std::map<std::string, GroupForms> groups;  // by case
  std::vector<std::string> ranks;    // [0] "nearest", [1] "second", ...; further ones are numbered
  std::vector<std::string> numbers;  // [0] "one", ...; further ones are in digits
  std::string list_comma, list_or;   // "a, b or c"
  /// Whether the names of categories are words of this language: "SprayCan" -> "spray can".
  bool names_are_words = true;
  std::map<std::string, NounWord> nouns;   // by category; "Unknown" is always there
  std::map<std::string, VerbWords> verbs;  // by action
  VerbWords other_verb;  // of other actions; {words} are those of affordances.toml

  // Questions
  std::string action;   // {action}, as VerbWords::any
  std::string actions;  // {actions}, a list of VerbWords::bare
  std::string object;   // {object}: one object, or one of a category
  std::string set;      // {object}: one of a group
  std::string full;     // {task}
  std::string both;     // {task}: of several objects or actions
  std::string which;    // of a choice
  std::string which_action;
  std::string which_object;
  std::string what_is_it;
  std::string again;  // {question}: it was asked before
  std::string yes, no, none_of_these, something;
  // Why a question is asked: a reason and what comes of it
  std::string wanted_last_time, wanted_each_time;  // {task}; {task} {sessions}
  std::string wanted_often;                        // {task} {times} {sessions}
  std::string wanted_before;                       // {task}
  std::string only_task;
  std::string likeliest_task, halves, tells_most;  // {count}: tasks that are possible
  std::string settles, one_follows, more_follow;   // {count}: questions
  std::string because;                             // {reason} {outlook}
  std::string looks_like;                          // {objects}
  std::string looks;                               // {object} {percent}
  std::string looks_unclear, looks_wrong;
  // Sessions
  std::string done;  // {task}
  std::string waiting_for_picture, waiting_for_table, waiting_for_objects, waiting_for_poses;
  std::string nothing_to_do;  // with these objects
  std::string none_of_the_tasks;
  std::string start_again;
  std::string taken_over;      // another machine asked until now
  std::string object_moved;    // {object}: "{object} has moved."
  std::string object_gone;     // {object}
  std::string looking_for;     // {object}: the session waits until it is seen
  std::string out_of_sight;    // {object}
  std::string not_remembered;  // {reason}
  std::string cancelled, stopped, no_robot, revoked;

  bool operator==(const Phrases&) const = default;
};

/// The defaults.
const Phrases& English();

/// A sentence of the phrases: where the file has it, and what stands in it. Every placeholder must
/// be used; those of `cased` may name a case.
struct Sentence {
  const char* section;
  const char* key;
  std::string Phrases::*text;
  std::vector<std::string> placeholders;
};
const std::vector<Sentence>& Sentences();

/// Whether a template uses each of `placeholders` and no other; the error says what was expected.
/// {object} may name one of `cases`.
Status CheckTemplate(const std::string& text, const std::vector<std::string>& placeholders,
                     const std::vector<std::string>& cases);

/// Values of placeholders. A noun phrase has a value a case.
using Values = std::vector<std::pair<std::string, std::map<std::string, std::string>>>;

/// A template with its placeholders replaced; values that it does not name are left out.
std::string Fill(const Phrases& phrases, const std::string& text, const Values& values);
/// The same for one placeholder without cases.
std::string Fill(const Phrases& phrases, const std::string& text, const std::string& placeholder,
                 const std::string& value);
/// A sentence as it is shown: its first letter large (ASCII and Latin-1), cut at 1000 bytes.
std::string Finished(std::string text);

/// The word for a category ("Unknown" too); made from its name where the file has none.
NounWord NounOf(const Phrases& phrases, const std::string& category);
/// "a spray can".
std::string ANoun(const Phrases& phrases, const std::string& category);
VerbWords VerbOf(const Phrases& phrases, const Action& action);
/// What the phrases lack for these affordances, a line each; empty where the words are complete.
std::vector<std::string> MissingWords(const Phrases& phrases, const Affordances& affordances);

}  // namespace beckon::intention
