#include "tools/beckon/catalogue.h"

#include <algorithm>

#include "services/base/config.h"

namespace beckon::tool {
namespace {

template <typename Range, typename Name>
std::string Join(const Range& range, Name name) {
  std::string text;
  for (const auto& entry : range) text += (text.empty() ? "" : ", ") + name(entry);
  return text;
}

}  // namespace

Result<Catalogue> Catalogue::Load(const std::string& path) {
  auto table = ConfigTable::Load(path);
  if (!table) return table.error();
  Catalogue catalogue;
  auto categories = table->Section("categories");
  for (const auto& category : categories.Keys())
    categories.Get(category, catalogue.actions_[category]);
  if (catalogue.actions_.empty()) return Error{path + ": [categories] is empty or absent"};
  return catalogue;
}

Result<Want> Catalogue::ParseWant(const std::string& text) const {
  const size_t colon = text.find(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == text.size()) {
    return Error{"--want '" + text + "': expected ACTION:CATEGORY, e.g. --want Open:Carton"};
  }
  Want want{text.substr(0, colon), text.substr(colon + 1)};
  const auto found = actions_.find(want.category);
  if (found == actions_.end()) {
    return Error{"--want '" + text + "': there is no category '" + want.category + "'; there are " +
                 Join(actions_, [](const auto& entry) { return entry.first; })};
  }
  if (std::ranges::count(found->second, want.action) == 0) {
    return Error{"--want '" + text + "': '" + want.action + "' does not go with a " +
                 want.category + "; " +
                 Join(found->second, [](const auto& action) { return action; }) + " do"};
  }
  return want;
}

Result<Want> Catalogue::Suggest(const SceneTruth& truth) const {
  const TruthObject* nearest = nullptr;
  for (const auto& object : truth.objects) {
    const auto found = actions_.find(object.category);
    if (found == actions_.end() || found->second.empty()) continue;
    if (object.category == "Carton" && std::ranges::count(found->second, "Open") > 0)
      return Want{"Open", "Carton"};
    if (nearest == nullptr || object.centroid_C.norm() < nearest->centroid_C.norm())
      nearest = &object;
  }
  if (nearest == nullptr)
    return Error{
        "the scene holds nothing of affordances.toml; say what is wanted by --want "
        "ACTION:CATEGORY"};
  const auto& actions = actions_.at(nearest->category);
  const bool graspable = std::ranges::count(actions, "Grasp") > 0;
  return Want{graspable ? "Grasp" : actions.front(), nearest->category};
}

size_t Catalogue::pairs() const {
  size_t n = 0;
  for (const auto& [category, actions] : actions_) n += actions.size();
  return n;
}

std::vector<std::string> Catalogue::categories() const {
  std::vector<std::string> names;
  for (const auto& [category, actions] : actions_) names.push_back(category);
  return names;
}

}  // namespace beckon::tool
