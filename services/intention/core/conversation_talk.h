// What the conversation holds of a running session and of a published task; for its own files only.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "services/intention/core/conversation.h"

namespace beckon::intention {

/// A running session: waits for a scene, then for its poses, then asks (interview is there).
struct Conversation::Talk {
  std::string session_id;
  std::string user;
  std::string device;
  std::string waits_for;  // in words; empty once it asks
  std::optional<SceneFollower> table;
  Utime scene_utime = 0;                 // of its first scene
  Utime ask_by = 0;                      // with or without poses
  std::vector<std::string> remembered;   // by object of the table: its category, or empty
  std::map<int, msg::ObjectPose> poses;  // by object of the table
  std::map<int, LabelRecord> told;       // to perception, by object of the table
  std::unique_ptr<Interview> interview;
  std::optional<msg::Query> query;  // nothing while it waits
  int64_t put = 0;                  // Interview::put of the query
  std::string notice;               // what happened, to be said with the next query
  Utime query_sent = 0;
  Utime announced = 0;
};

struct Conversation::PendingTask {
  msg::Task task;
  Utime sent = 0;
  SceneFollower table;
  int object = 0;  // of the table
  std::optional<msg::TaskStatus> revoked;
  bool told = false;  // published, in this run or maybe an earlier one
};

}  // namespace beckon::intention
