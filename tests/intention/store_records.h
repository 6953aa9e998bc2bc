// What the tests of the store remember.
#pragma once

#include <string>

#include "services/intention/core/memory.h"

namespace beckon::intention {

inline SessionRecord Session(const std::string& id, const std::string& user = "ann",
                             Utime utime = 1000) {
  SessionRecord session;
  session.session_id = id;
  session.user = user;
  session.device = "switch";
  session.utime = utime;
  session.category = "Carton";
  session.action = "Open";
  session.questions = 2;
  session.posterior = 1;
  session.present = {{"Carton", 1}, {"Mug", 2}};
  session.answers = {{QuestionKind::kAction, {0, 1}, 1, "switch", AnswerFate::kWithdrawn},
                     {QuestionKind::kFull, {1, 0}, 0, "speech"}};
  return session;
}

inline LabelRecord Label(const std::string& id, Utime utime = 1000) {
  LabelRecord label;
  label.id = id;
  label.session_id = "s1";
  label.user = "ann";
  label.utime = utime;
  label.category = "Tin";
  label.source = "camera";
  label.centroid_W = {0.1, 0.25, 0.05};
  label.extent_W = {0.05, 0.05, 0.125};
  label.probabilities = {{"Can", 0.5f}, {"Tin", 0.25f}};
  return label;
}

inline msg::Task TaskOf(const SessionRecord& session) {
  msg::Task task;
  task.utime = session.utime;
  task.task_id = session.session_id;
  task.user = session.user;
  task.action = session.action;
  task.object = {3, session.category, 1};
  task.pose.object_id = 3;
  task.posterior = 1;
  task.questions = session.questions;
  task.expires_utime = session.utime + 30 * kSecond;
  return task;
}

}  // namespace beckon::intention
