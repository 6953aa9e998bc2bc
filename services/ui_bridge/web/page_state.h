// What the page is shown, and the JSON it is shown as (docs/front-ends/web-api.md, "state").
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.h"

namespace beckon::ui_bridge::web {

enum class Phase { kIdle, kRunning, kStopped };

struct PageState {
  std::optional<msg::Query> query;
  bool answered = false;  // the query: by one of the pages, or on its way
  std::optional<msg::Task> task;
  std::optional<msg::TaskStatus> task_status;  // of `task`
  Phase phase = Phase::kIdle;
  msg::SessionKind event = msg::SessionKind::kIdle;  // the latest
  std::string event_text;
  bool stopping = false;  // a stop was asked for, intention has not said yet that it heard
  std::string notice;     // a line for the user; empty = none
  std::string user;
  bool intention_silent = false;  // nothing is heard of it
  std::optional<msg::Highlight> highlight;
  bool scanning = false;                  // by this page's own scanner
  std::vector<std::string> controls;      // that the scanner offers besides options
  std::optional<int> trial_seconds_left;  // of settings on trial, rounded up
  int64_t settings_rev = 0;
  int64_t profile_rev = 0;
};

/// All but `frame_seq`, `scene` and `rev`.
nlohmann::ordered_json ToJson(const PageState& state);

/// Objects with their outlines, and superquadrics in the camera frame: those of `poses` whose
/// object is in `scene`, in the frame `scene` was seen in. Without `seq`.
nlohmann::ordered_json ToJson(const msg::Scene& scene, const msg::Poses* poses);

nlohmann::ordered_json ToJson(const msg::Profile& profile);

}  // namespace beckon::ui_bridge::web
