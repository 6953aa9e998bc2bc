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

void Tasks::Present(const PastSession& past, std::vector<int>& present) const {
  present.assign(names_.size(), past.present.empty() ? -1 : 0);
  for (size_t c = 0; c < names_.size(); ++c) {
    const auto name = static_cast<size_t>(names_[c]);
    if (name < past.present.size()) present[c] = past.present[name];
    if (names_[c] == past.category && present[c] == 0) present[c] = -1;
  }
}

std::vector<int> Tasks::Present(const Situation& situation) const {
  std::vector<int> present(names_.size(), 0);
  for (const Instance& object : situation.objects) {
    const auto found = std::find(names_.begin(), names_.end(), object.category);
    if (found != names_.end()) ++present[static_cast<size_t>(found - names_.begin())];
  }
  return present;
}

}  // namespace beckon::intention
