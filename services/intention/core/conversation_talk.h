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
  std::optional<msg::Scene> scene;
  Utime ask_by = 0;                      // with or without poses
  std::map<int, msg::ObjectPose> poses;  // by index of the scene's object
  std::unique_ptr<Interview> interview;
  std::optional<msg::Query> query;
  Utime query_sent = 0;
  Utime announced = 0;
};

struct Conversation::PendingTask {
  msg::Task task;
  Utime sent = 0;
};

}  // namespace beckon::intention
