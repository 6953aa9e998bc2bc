// English, as questions.en.toml has it too.
#include "services/intention/core/phrases.h"

namespace beckon::intention {
namespace {

Phrases MakeEnglish() {
  Phrases p;
  p.cases = {"plain"};
  p.genders["a"] = {
      "", {{"plain", {"the {noun}", "the {rank} {noun}", "a {noun}", "one of the {nouns}"}}}};
  p.genders["an"] = {
      "aeiou", {{"plain", {"the {noun}", "the {rank} {noun}", "an {noun}", "one of the {nouns}"}}}};
  p.numbered = "{noun} number {number}";
  p.groups["plain"] = {
      "one of the {count} objects nearest to you", "one of the {count} objects furthest from you",
      "one of the {count} objects furthest to the left",
      "one of the {count} objects furthest to the right", "one of the {count} outlined objects"};
  p.ranks = {"nearest", "second",  "third",  "fourth", "fifth",
             "sixth",   "seventh", "eighth", "ninth",  "tenth"};
  p.numbers = {"one",   "two",   "three", "four", "five",   "six",
               "seven", "eight", "nine",  "ten",  "eleven", "twelve"};
  p.list_comma = ", ";
  p.list_or = " or ";
  p.nouns["Unknown"] = {"an", "unknown object", "unknown objects", {}, {}};
  p.other_verb = {"{words} something", "{words}", "{words} {object}"};
  p.action = "do you want to {action}?";
  p.actions = "do you want to {actions} something?";
  p.object = "is it about {object}?";
  p.set = "is it {object}?";
  p.full = "{task}?";
  p.both = "do you want to {task}?";
  p.which = "which one?";
  p.which_action = "what do you want to do?";
  p.which_object = "which one is it about?";
  p.what_is_it = "what is this object?";
  p.again = "once more, to be sure: {question}";
  p.yes = "yes";
  p.no = "no";
  p.none_of_these = "none of these";
  p.something = "something";
  p.wanted_last_time = "you wanted to {task} last time";
  p.wanted_each_time = "you wanted to {task} in each of the last {sessions} sessions";
  p.wanted_often = "you wanted to {task} in {times} of the last {sessions} sessions";
  p.wanted_before = "you wanted to {task} before";
  p.only_task = "it is the only task left";
  p.likeliest_task = "of {count} tasks that are possible this is the likeliest";
  p.halves = "{count} tasks are possible and either answer rules out about half";
  p.tells_most = "{count} tasks are possible and this tells most about which it is";
  p.settles = "a yes settles it";
  p.one_follows = "about one more question will follow";
  p.more_follow = "about {count} more questions will follow";
  p.because = "{reason}; {outlook}.";
  p.looks_like = "it looks like {objects}; your answer is remembered.";
  p.looks = "{object} ({percent} %)";
  p.looks_unclear = "I cannot tell what it is; your answer is remembered.";
  p.looks_wrong =
      "none of the tasks that I know was right, so an object may be another than I took it for.";
  p.done = "{task}.";
  p.waiting_for_picture = "waiting for a picture of the table.";
  p.waiting_for_table = "waiting until the table is in view.";
  p.waiting_for_objects = "waiting for objects on the table.";
  p.waiting_for_poses = "waiting for the objects' poses.";
  p.nothing_to_do = "I know of nothing to do with the objects on the table. Nothing was done.";
  p.none_of_the_tasks = "it is none of the tasks that I know for these objects. Nothing was done.";
  p.start_again = "I am not sure what you want. Let us start again.";
  p.taken_over = "the machine that asked you fell silent. Let us start again.";
  p.object_moved = "{object} has moved.";
  p.object_gone = "{object} is gone.";
  p.looking_for = "making sure that {object} is still there.";
  p.out_of_sight = "{object} is out of sight.";
  p.not_remembered = "it could not be remembered, so nothing was done: {reason}";
  p.cancelled = "cancelled.";
  p.stopped = "stopped. Only \"resume\" leads on.";
  p.no_robot = "no robot took the task in time.";
  p.revoked = "the user stopped everything.";
  return p;
}

}  // namespace

const Phrases& English() {
  static const Phrases english = MakeEnglish();
  return english;
}

}  // namespace beckon::intention
