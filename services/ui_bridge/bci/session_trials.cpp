#include "services/ui_bridge/bci/session_trials.h"

#include <algorithm>
#include <utility>

namespace beckon::ui_bridge::bci {
namespace {

constexpr size_t kMostQuestions = 500;

/// What an object is called when it is asked about has to be what it is: "the box" is not a carton
/// that was taken for a box.
bool IsWanted(const msg::ObjectRef& object, const msg::Task& task) {
  return object.object_id == task.object.object_id && object.category == task.object.category;
}

bool NamesWanted(const std::vector<msg::ObjectRef>& objects, const msg::Task& task) {
  return std::any_of(objects.begin(), objects.end(),
                     [&](const msg::ObjectRef& object) { return IsWanted(object, task); });
}

bool Holds(const msg::Option& option, const msg::Query& query, const msg::Task& task) {
  if (option.actions.empty() && option.objects.empty()) return false;  // "none of these"
  if (!option.actions.empty() &&
      std::count(option.actions.begin(), option.actions.end(), task.action) == 0)
    return false;
  if (option.objects.empty()) return true;
  const int id = task.object.object_id;
  return NamesWanted(query.objects, task) &&
         std::count(option.objects.begin(), option.objects.end(), id) > 0;
}

std::optional<size_t> RightCategory(const msg::Query& query, const msg::Task& task) {
  if (query.objects.size() != 1 || query.objects[0].object_id != task.object.object_id) return {};
  for (size_t i = 0; i < query.options.size(); ++i)
    if (query.options[i].category == task.object.category) return i;
  for (size_t i = 0; i < query.options.size(); ++i)
    if (query.options[i].category == msg::kUnknownCategory) return i;
  return {};
}

}  // namespace

std::optional<size_t> RightOption(const msg::Query& query, const msg::Task& task) {
  if (query.kind == msg::QueryKind::kWhatIsIt) return RightCategory(query, task);
  if (query.kind != msg::QueryKind::kChoice) {
    const bool action =
        query.any_action || std::count(query.actions.begin(), query.actions.end(), task.action) > 0;
    const bool object = query.any_object || NamesWanted(query.objects, task);
    return action && object ? 0 : 1;
  }
  for (size_t i = 0; i < query.options.size(); ++i)
    if (Holds(query.options[i], query, task)) return i;
  if (query.options.empty()) return {};
  const msg::Option& last = query.options.back();
  if (!last.actions.empty() || !last.objects.empty()) return {};
  return query.options.size() - 1;
}

void SessionTrials::Add(const msg::Query& query, std::vector<std::vector<double>> trials) {
  if (questions_.size() < kMostQuestions) questions_.push_back({query, std::move(trials)});
}

std::vector<KnownTrial> SessionTrials::Confirm(const msg::Task& task) {
  std::vector<KnownTrial> known;
  for (Asked& asked : questions_) {
    if (asked.query.session_id != task.task_id) continue;
    const auto meant = RightOption(asked.query, task);
    if (!meant) continue;
    for (auto& trial : asked.trials) known.push_back({*meant, std::move(trial)});
  }
  questions_.clear();
  return known;
}

bool RunWatch::IsAnother(const msg::Scene& scene) {
  const bool another = scene.seq < seq_ && scene.utime > utime_;
  if (scene.seq < seq_ && !another) return false;  // a late copy
  seq_ = scene.seq;
  utime_ = scene.utime;
  return another;
}

}  // namespace beckon::ui_bridge::bci
