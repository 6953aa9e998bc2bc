#include "services/intention/core/tasks.h"

#include <algorithm>
#include <array>

namespace beckon::intention {

Tasks::Tasks(const Situation& situation, std::span<const PastSession> past)
    : number_(static_cast<size_t>(kMaxCategories) * kMaxActions, -1) {
  const auto note = [&](int category, int action) {
    number_[static_cast<size_t>(category * kMaxActions + action)] = 0;
  };
  for (const Pair& pair : situation.pairs) {
    note(situation.objects[static_cast<size_t>(pair.object)].category, pair.action);
  }
  for (const PastSession& session : past) note(session.category, session.action);

  std::array<int, kMaxActions> actions;
  actions.fill(-1);
  for (int category = 0; category < kMaxCategories; ++category) {
    const size_t before = category_.size();
    for (int action = 0; action < kMaxActions; ++action) {
      int& number = number_[static_cast<size_t>(category * kMaxActions + action)];
      if (number < 0) continue;
      number = count();
      if (actions[static_cast<size_t>(action)] < 0) {
        actions[static_cast<size_t>(action)] = actions_++;
      }
      category_.push_back(static_cast<int>(names_.size()));
      action_.push_back(actions[static_cast<size_t>(action)]);
    }
    if (category_.size() == before) continue;
    names_.push_back(category);
    first_.push_back(static_cast<int>(before));
  }
  first_.push_back(count());
}

void Tasks::Look(const PastSession& past, Presence& presence) const {
  const size_t n = names_.size();
  presence.instances.assign(n, past.present.empty() ? Presence::kNotRecorded : 0);
  presence.there.assign(n, 1);
  for (size_t c = 0; c < n; ++c) {
    const auto name = static_cast<size_t>(names_[c]);
    int& instances = presence.instances[c];
    if (name < past.present.size()) instances = past.present[name];
    if (names_[c] == past.category && instances == 0) instances = Presence::kNotRecorded;
    if (instances == 0) presence.there[c] = 0;
  }
}

Presence Tasks::Look(const Situation& situation) const {
  Presence presence;
  for (const int name : names_) {
    const auto instances =
        std::count_if(situation.objects.begin(), situation.objects.end(),
                      [name](const Instance& object) { return object.category == name; });
    presence.instances.push_back(static_cast<int>(instances));
    presence.there.push_back(instances > 0 ? 1 : 0);
  }
  return presence;
}

}  // namespace beckon::intention
