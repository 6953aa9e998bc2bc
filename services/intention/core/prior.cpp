#include "services/intention/core/prior.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "services/intention/core/instance_habit.h"
#include "services/intention/core/learner.h"
#include "services/intention/core/tasks.h"

namespace beckon::intention {
namespace {

/// Sessions further back are not looked at: they would not matter and would take time.
constexpr size_t kWindow = 1000;

}  // namespace

std::vector<double> PriorOver(const Situation& situation, const UserHistory& history) {
  std::vector<double> prior;
  if (situation.pairs.empty()) return prior;
  const auto past = std::span(history).last(std::min(history.size(), kWindow));
  const Tasks tasks(situation, past);
  Learner learner(tasks);
  InstanceHabit instances(tasks.categories());
  Presence presence;
  for (const PastSession& session : past) {
    tasks.Look(session, presence);
    const int task = tasks.Find(session.category, session.action);
    const int category = tasks.category(task);
    learner.Learn(task, presence.there, session.utime);
    instances.Learn(category, session.rank, presence.instances[static_cast<size_t>(category)]);
  }

  presence = tasks.Look(situation);
  const std::vector<double> wanted = learner.Predict(presence.there, situation.utime);
  std::vector<std::vector<double>> choice;  // by category, the likeliest instance 1
  for (int c = 0; c < tasks.categories(); ++c) {
    choice.push_back(instances.Predict(c, presence.instances[static_cast<size_t>(c)]));
    const auto most = std::max_element(choice.back().begin(), choice.back().end());
    const double scale = most == choice.back().end() ? 1 : *most;
    for (double& p : choice.back()) p /= scale;
  }
  for (const Pair& pair : situation.pairs) {
    const Instance& object = situation.objects[static_cast<size_t>(pair.object)];
    const int task = tasks.Find(object.category, pair.action);
    prior.push_back(
        wanted[static_cast<size_t>(task)] *
        choice[static_cast<size_t>(tasks.category(task))][static_cast<size_t>(object.rank) - 1]);
  }
  const double sum = std::accumulate(prior.begin(), prior.end(), 0.0);
  for (double& p : prior) p /= sum;
  return prior;
}

void CapPrior(std::vector<double>& prior, double cap) {
  const auto most = std::max_element(prior.begin(), prior.end());
  if (prior.size() < 2 || *most <= cap) return;
  // Only one entry can exceed a cap of at least 1/2.
  const double rest = 1 - *most;
  const double spread = (1 - cap) / std::max(rest, 1e-300);
  const bool others = rest > 1e-12;
  for (auto p = prior.begin(); p != prior.end(); ++p) {
    if (p == most) continue;
    *p = others ? *p * spread : (1 - cap) / static_cast<double>(prior.size() - 1);
  }
  *most = cap;
}

}  // namespace beckon::intention
