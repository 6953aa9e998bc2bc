#include "tools/beckon/top_json.h"

#include <nlohmann/json.hpp>

namespace beckon::tool {
namespace {

using nlohmann::ordered_json;

template <typename T>
ordered_json OrNull(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

double Seconds(Utime us) { return static_cast<double>(us) / kSecond; }

ordered_json ToJson(const TopRow& row) {
  ordered_json json{{"service", row.service},
                    {"host", row.host},
                    {"pid", row.pid},
                    {"build", row.build},
                    {"state", row.state},
                    {"silent", row.silent},
                    {"heard_s", Seconds(row.heard_us)},
                    {"uptime_s", row.uptime_s},
                    {"cpu_percent", OrNull(row.cpu_percent)},
                    {"rss_kb", OrNull(row.rss_kb)},
                    {"received_per_s", OrNull(row.in_per_s)},
                    {"sent_per_s", OrNull(row.out_per_s)},
                    {"frames_per_s", OrNull(row.frames_per_s)},
                    {"drops", row.drops},
                    {"drops_per_s", OrNull(row.drops_per_s)},
                    {"age_us", OrNull(row.age_us)},
                    {"handler_us", OrNull(row.handler_us)},
                    {"refused_per_s", row.refused_per_s}};
  json["refused"] = ordered_json::object();
  for (const auto& refused : row.refused)
    json["refused"][refused.reason] = {{"total", refused.total}, {"per_s", refused.per_s}};
  return json;
}

ordered_json ToJson(const TopTalk& talk) {
  return {{"user", talk.user},           {"state", talk.state},
          {"text", talk.text},           {"kind", talk.kind},
          {"questions", talk.questions}, {"since_s", Seconds(talk.since_us)},
          {"silent", talk.silent}};
}

}  // namespace

std::string TopJson(const std::vector<TopRow>& rows, const TopTalks& talks) {
  ordered_json json;
  json["processes"] = ordered_json::array();
  for (const auto& row : rows) json["processes"].push_back(ToJson(row));
  json["talks"] = ordered_json::array();
  for (const auto& talk : talks.talks) json["talks"].push_back(ToJson(talk));
  json["last_task"] = nullptr;
  if (talks.last_task) {
    json["last_task"] = {{"user", talks.last_task->user},
                         {"task", talks.last_task->task},
                         {"state", talks.last_task->state},
                         {"since_s", Seconds(talks.last_task->since_us)}};
  }
  json["stopped"] = talks.stopped;
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace beckon::tool
