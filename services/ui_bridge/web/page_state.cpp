#include "services/ui_bridge/web/page_state.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace beckon::ui_bridge::web {
namespace {

using Json = nlohmann::ordered_json;

/// 1/10 mm, 1/1000 of a ratio: nobody sees more, and unseen noise makes no new state.
double Rounded(double value) { return std::round(value * 1e4) / 1e4; }

const char* Name(Phase phase) {
  switch (phase) {
    case Phase::kIdle:
      return "idle";
    case Phase::kRunning:
      return "running";
    case Phase::kStopped:
      return "stopped";
  }
  return "";
}

const char* EventName(msg::SessionKind kind) {
  switch (kind) {
    case msg::SessionKind::kBegun:
      return "begun";
    case msg::SessionKind::kConfirmed:
      return "confirmed";
    case msg::SessionKind::kAbandoned:
      return "abandoned";
    case msg::SessionKind::kStopped:
      return "stopped";
    default:
      return "idle";
  }
}

Json ObjectsJson(const std::vector<msg::ObjectRef>& objects) {
  Json list = Json::array();
  for (const auto& object : objects)
    list.push_back({{"category", object.category},
                    {"instance", object.instance},
                    {"object_id", object.object_id}});
  return list;
}

Json OptionsJson(const msg::Query& query) {
  Json list = Json::array();
  for (size_t i = 0; i < query.options.size(); ++i) {
    const msg::Option& option = query.options[i];
    Json entry = {{"text", option.text},       {"category", option.category},
                  {"actions", option.actions}, {"objects", option.objects},
                  {"probability", nullptr},    {"questions_left", nullptr},
                  {"seconds_left", nullptr}};
    if (i < query.prospects.size()) {
      entry["probability"] = query.prospects[i].probability;
      entry["questions_left"] = query.prospects[i].questions_left;
      entry["seconds_left"] = query.prospects[i].seconds_left;
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json LikeliestJson(const msg::Query& query) {
  Json list = Json::array();
  for (const auto& candidate : query.likeliest)
    list.push_back({{"action", candidate.action},
                    {"category", candidate.object.category},
                    {"instance", candidate.object.instance},
                    {"object_id", candidate.object.object_id},
                    {"prior", candidate.prior},
                    {"posterior", candidate.posterior},
                    {"times", candidate.times},
                    {"sessions_ago", candidate.sessions_ago}});
  return list;
}

Json QueryJson(const msg::Query& query, bool answered) {
  const bool any_action = query.any_action, any_object = query.any_object;
  return {{"id", query.id},
          {"kind", msg::Name(query.kind)},
          {"text", query.text},
          {"yes_if",
           {{"actions", any_action ? Json(nullptr) : Json(query.actions)},
            {"objects", any_object ? Json(nullptr) : ObjectsJson(query.objects)}}},
          {"about", ObjectsJson(query.objects)},
          {"options", OptionsJson(query)},
          {"answered", answered},
          {"questions_asked", query.questions_asked},
          {"expected_questions", query.expected_questions},
          {"expected_seconds", query.expected_seconds},
          {"n_candidates", query.n_candidates},
          {"best_posterior", query.best_posterior},
          {"why", query.why},
          {"information_bits", query.information_bits},
          {"likeliest", LikeliestJson(query)}};
}

Json TaskJson(const msg::Task& task, const std::optional<msg::TaskStatus>& status) {
  const Eigen::Vector3d p_W = task.has_pose ? task.pose.X_WO.translation() : task.centroid_W;
  return {{"task_id", task.task_id},
          {"action", task.action},
          {"category", task.object.category},
          {"instance", task.object.instance},
          {"object_id", task.object.object_id},
          {"position_W", {p_W.x(), p_W.y(), p_W.z()}},
          {"questions", task.questions},
          {"state", status ? Json(Name(status->state)) : Json(nullptr)},
          {"text", status ? status->text : std::string()}};
}

Json HighlightJson(const msg::Highlight& highlight) {
  return {{"device", highlight.device},    {"query_id", highlight.query_id},
          {"options", highlight.options},  {"controls", highlight.controls},
          {"pressed", highlight.pressed},  {"paused", highlight.paused},
          {"dwell_ms", highlight.dwell_ms}};
}

Json ObjectJson(const msg::SceneObject& object) {
  Json outline = Json::array();
  for (const auto& [u, v] : object.outline_px) outline.push_back({u, v});
  return {{"id", object.id},
          {"category", object.category},
          {"confidence", std::round(static_cast<double>(object.confidence) * 100) / 100},
          {"ask_user", object.ask_user},
          {"outline_px", std::move(outline)}};
}

Json ShapeJson(int object_id, const Pose& X_CO, const msg::ObjectPose& pose) {
  const Eigen::Vector3d p = X_CO.translation();
  Eigen::Quaterniond q(X_CO.rotation());
  if (q.w() < 0) q.coeffs() *= -1;
  Json axes = Json::array(), epsilon = Json::array(), taper = Json::array();
  for (const double a : pose.semi_axes) axes.push_back(Rounded(a));
  for (const double e : pose.epsilon) epsilon.push_back(Rounded(e));
  for (const double k : pose.taper) taper.push_back(Rounded(k));
  return {{"object_id", object_id},
          {"position_C", {Rounded(p.x()), Rounded(p.y()), Rounded(p.z())}},
          {"rotation_C", {Rounded(q.w()), Rounded(q.x()), Rounded(q.y()), Rounded(q.z())}},
          {"semi_axes", std::move(axes)},
          {"epsilon", std::move(epsilon)},
          {"taper", std::move(taper)},
          {"converged", pose.converged}};
}

}  // namespace

Json ToJson(const PageState& state) {
  const auto& left = state.trial_seconds_left;
  return {{"query", state.query ? QueryJson(*state.query, state.answered) : Json(nullptr)},
          {"task", state.task ? TaskJson(*state.task, state.task_status) : Json(nullptr)},
          {"stopped", state.phase == Phase::kStopped},
          {"stopping", state.stopping},
          {"phase", Name(state.phase)},
          {"event", {{"kind", EventName(state.event)}, {"text", state.event_text}}},
          {"notice", state.notice},
          {"user", state.user},
          {"intention_silent", state.intention_silent},
          {"highlight", state.highlight ? HighlightJson(*state.highlight) : Json(nullptr)},
          {"scanning", state.scanning},
          {"controls", state.controls},
          {"settings_trial", left ? Json{{"seconds_left", *left}} : Json(nullptr)},
          {"settings_rev", state.settings_rev},
          {"profile_rev", state.profile_rev}};
}

Json ToJson(const msg::Scene& scene, const msg::Poses* poses) {
  Json objects = Json::array(), shapes = Json::array();
  for (const auto& object : scene.objects) objects.push_back(ObjectJson(object));
  const Pose X_CW = scene.X_WC.inverse();
  for (size_t i = 0; poses != nullptr && i < poses->poses.size(); ++i) {
    const msg::ObjectPose& pose = poses->poses[i];
    if (std::ranges::count(scene.objects, pose.object_id, &msg::SceneObject::id) > 0)
      shapes.push_back(ShapeJson(pose.object_id, X_CW * pose.X_WO, pose));
  }
  const Intrinsics& k = scene.intrinsics;
  return {{"width", scene.width},
          {"height", scene.height},
          {"intrinsics", {{"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx}, {"cy", k.cy}}},
          {"has_table", scene.has_table},
          {"objects", std::move(objects)},
          {"superquadrics", std::move(shapes)}};
}

Json ToJson(const msg::Profile& profile) {
  Json recent = Json::array();
  for (const auto& session : profile.recent)
    recent.push_back({{"utime", session.utime},
                      {"action", session.action},
                      {"category", session.category},
                      {"instance", session.instance},
                      {"questions", session.questions},
                      {"device", session.device}});
  return {{"user", profile.user},
          {"users", profile.users},
          {"n_sessions", profile.n_sessions},
          {"recent", std::move(recent)}};
}

}  // namespace beckon::ui_bridge::web
