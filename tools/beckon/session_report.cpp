#include "tools/beckon/session_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace beckon::tool {
namespace {

using nlohmann::ordered_json;

double Milliseconds(Utime from, Utime to) { return static_cast<double>(to - from) * 1e-3; }

ordered_json Number(double value, int decimals) {
  const double scale = std::pow(10, decimals);
  return std::round(value * scale) / scale;
}

ordered_json Vector(const Eigen::Vector3d& v) {
  return {Number(v.x(), 4), Number(v.y(), 4), Number(v.z(), 4)};
}

ordered_json TaskJson(const msg::Task& task) {
  ordered_json json{
      {"action", task.action},
      {"category", task.object.category},
      {"instance", task.object.instance},
      {"position_W", Vector(task.has_pose ? task.pose.X_WO.translation() : task.centroid_W)},
      {"centroid_W", Vector(task.centroid_W)},
      {"posterior", Number(task.posterior, 6)},
      {"has_pose", task.has_pose},
      {"grasps", task.has_pose ? task.pose.grasps.size() : 0}};
  if (task.has_pose) {
    const auto& a = task.pose.semi_axes;
    json["semi_axes"] = Vector({a[0], a[1], a[2]});
  }
  return json;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

bool IsCorrect(const SessionRecord& record, const Want& want, const SceneTruth& truth) {
  if (!record.task) return false;
  const msg::Task& task = *record.task;
  if (task.action != want.action || task.object.category != want.category) return false;
  if (!truth.known) return true;
  const auto meant = truth.FirstInstance(want.category, task.X_WC);
  return meant && truth.At(task.X_WC.inverse() * task.centroid_W) == meant;
}

std::string ReportLine(const SessionRecord& record, const Want* want, const SceneTruth& truth) {
  ordered_json json{{"session", record.number},
                    {"questions", record.answers.size()},
                    {"category_questions", record.CategoryQuestions()}};
  json["task"] = record.task ? TaskJson(*record.task) : ordered_json(nullptr);
  json["correct"] =
      want != nullptr ? ordered_json(IsCorrect(record, *want, truth)) : ordered_json(nullptr);
  if (want != nullptr) json["wanted"] = want->Text();
  if (!record.task) json["outcome"] = record.outcome;
  ordered_json ms{{"session", Number(Milliseconds(record.requested, record.ended), 1)}};
  if (record.first_query)
    ms["to_first_query"] = Number(Milliseconds(record.requested, *record.first_query), 1);
  if (!record.answer_to_query_ms.empty())
    ms["answer_to_query_p50"] = Number(Median(record.answer_to_query_ms), 3);
  json["ms"] = std::move(ms);
  json["answers"] = ordered_json::array();
  for (const auto& given : record.answers) {
    json["answers"].push_back(
        {{"kind", msg::Name(given.kind)}, {"question", given.question}, {"answer", given.answer}});
  }
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string Complaint(const SessionRecord& record, const Want& want) {
  const std::string head =
      "session " + std::to_string(record.number) + ": wanted " + want.Text() + ", ";
  if (!record.task) return head + "got no task: " + record.outcome;
  const auto& object = record.task->object;
  return head + "got " + record.task->action + ":" + object.category + " (instance " +
         std::to_string(object.instance) + " of what was recognised)";
}

}  // namespace beckon::tool
