#include "services/intention/core/affordances.h"

#include <algorithm>

namespace beckon::intention {
namespace {

template <typename Named>
int Find(const std::vector<Named>& sorted, const std::string& name) {
  const auto found =
      std::lower_bound(sorted.begin(), sorted.end(), name,
                       [](const Named& a, const std::string& b) { return a.name < b; });
  return found != sorted.end() && found->name == name ? static_cast<int>(found - sorted.begin())
                                                      : -1;
}

/// Names travel in messages, words stand in sentences.
constexpr size_t kLongest = 64;
constexpr char kUnknown[] = "Unknown";

bool IsText(const std::string& text) {
  return text.size() <= kLongest && std::none_of(text.begin(), text.end(), [](char c) {
           return (c >= 0 && c < ' ') || c == '{' || c == '}' || c == 127;
         });
}

template <typename Named>
Status SortAndCheck(std::vector<Named>& all, const std::string& what, size_t most) {
  if (all.empty()) return Error{"affordances: expected at least one " + what + ", found none"};
  if (all.size() > most) {
    return Error{"affordances: expected at most " + std::to_string(most) + " of " + what +
                 ", found " + std::to_string(all.size())};
  }
  std::sort(all.begin(), all.end(), [](const Named& a, const Named& b) { return a.name < b.name; });
  for (size_t i = 0; i < all.size(); ++i) {
    if (all[i].name.empty()) return Error{"affordances: a " + what + " has no name"};
    if (!IsText(all[i].name)) {
      return Error{"affordances: a " + what + " has a name of " +
                   std::to_string(all[i].name.size()) + " bytes, expected at most " +
                   std::to_string(kLongest) + " without control characters and braces"};
    }
    if (i > 0 && all[i].name == all[i - 1].name) {
      return Error{"affordances: " + what + " '" + all[i].name + "' is there twice"};
    }
  }
  return {};
}

}  // namespace

Result<Affordances> Affordances::Make(std::vector<Action> actions, std::vector<Entry> entries,
                                      std::vector<std::string> unknown) {
  Affordances made;
  if (Status ok = SortAndCheck(actions, "action", kMaxActions); !ok) return ok.error();
  for (const Action& action : actions) {
    if (action.words.empty()) {
      return Error{"affordances: action '" + action.name + "' has no words for questions"};
    }
    if (!IsText(action.words)) {
      return Error{"affordances: the words of action '" + action.name + "' must be at most " +
                   std::to_string(kLongest) + " bytes without control characters and braces"};
    }
  }
  made.actions_ = std::move(actions);
  for (const Entry& entry : entries) {
    if (entry.category == kUnknown) {
      return Error{
          "affordances: 'Unknown' is reserved for objects of no category; what can be done with "
          "them "
          "stands in [unknown]"};
    }
  }
  if (entries.empty()) return Error{"affordances: expected at least one category, found none"};
  if (!unknown.empty()) entries.push_back({kUnknown, std::move(unknown)});
  for (const Entry& entry : entries) {
    Category category{entry.category, {}};
    for (const std::string& name : entry.actions) {
      const int action = made.FindAction(name);
      if (action < 0) {
        return Error{"affordances: category '" + entry.category + "' affords the unknown action '" +
                     name + "'; add it to [actions]"};
      }
      category.actions.push_back(action);
    }
    std::sort(category.actions.begin(), category.actions.end());
    if (std::adjacent_find(category.actions.begin(), category.actions.end()) !=
        category.actions.end()) {
      return Error{"affordances: category '" + entry.category + "' lists an action twice"};
    }
    if (category.actions.empty()) {
      return Error{"affordances: category '" + entry.category + "' affords nothing"};
    }
    made.categories_.push_back(std::move(category));
  }
  if (Status ok = SortAndCheck(made.categories_, "category", kMaxCategories); !ok)
    return ok.error();
  return made;
}

int Affordances::FindCategory(const std::string& name) const { return Find(categories_, name); }
int Affordances::FindAction(const std::string& name) const { return Find(actions_, name); }

int Affordances::unknown() const { return FindCategory(kUnknown); }

Affordances Affordances::Named() const {
  Affordances named = *this;
  std::erase_if(named.categories_, [](const Category& c) { return c.name == kUnknown; });
  return named;
}

bool Affordances::Affords(int category, int action) const {
  if (category < 0 || category >= static_cast<int>(categories_.size())) return false;
  const auto& afforded = categories_[category].actions;
  return std::binary_search(afforded.begin(), afforded.end(), action);
}

int Affordances::pair_count() const {
  int count = 0;
  for (const Category& category : categories_) count += static_cast<int>(category.actions.size());
  return count;
}

}  // namespace beckon::intention
