// Which action can be done with which category of object.
#pragma once

#include <string>
#include <vector>

#include "services/base/result.h"

namespace beckon::intention {

/// Sets of actions and of objects are 64-bit masks.
inline constexpr int kMaxActions = 64;
inline constexpr int kMaxCategories = 64;

struct Action {
  std::string name;   // "Drink"
  std::string words;  // "drink from", as it stands before "the mug?"
};

struct Category {
  std::string name;          // "SprayCan"
  std::vector<int> actions;  // indices, ascending
};

/// Categories and actions in alphabetical order; elsewhere they go by their index here.
class Affordances {
 public:
  struct Entry {
    std::string category;
    std::vector<std::string> actions;
  };

  /// Fails on an empty table, a doubled or empty name, an action without words, a category that
  /// affords nothing, the reserved name "Unknown", and more than 64 of either.
  /// `unknown`: what can be done with any object, also one of no category; where there is
  /// something, "Unknown" is a category like the others.
  static Result<Affordances> Make(std::vector<Action> actions, std::vector<Entry> entries,
                                  std::vector<std::string> unknown = {});
  /// The same without what can be done with objects of no category.
  Affordances Named() const;

  const std::vector<Category>& categories() const { return categories_; }
  const std::vector<Action>& actions() const { return actions_; }

  /// Index of a name, or -1.
  int FindCategory(const std::string& name) const;
  int FindAction(const std::string& name) const;
  bool Affords(int category, int action) const;
  /// Index of the category of objects that are of no other, or -1 where nothing can be done with
  /// them.
  int unknown() const;
  /// Whether an index is that of a category proper: not -1, not unknown().
  bool IsNamed(int category) const { return category >= 0 && category != unknown(); }
  /// Number of (category, action) pairs.
  int pair_count() const;

 private:
  std::vector<Action> actions_;
  std::vector<Category> categories_;
};

}  // namespace beckon::intention
