// Which actions go with which category, as this program needs to know it: to check and to choose
// what a simulated user wants.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "services/base/result.h"
#include "services/base/scene_truth.h"

namespace beckon::tool {

struct Want {
  std::string action;
  std::string category;
  std::string Text() const { return action + ":" + category; }
};

class Catalogue {
 public:
  /// From an affordances.toml.
  static Result<Catalogue> Load(const std::string& path);

  /// "Open:Carton"; fails where the form is wrong or the pair is not in the catalogue, and says
  /// what is.
  Result<Want> ParseWant(const std::string& text) const;
  /// What a user might want of a scene: to open the carton where there is one, else to grasp what
  /// is nearest to the camera. Fails where the scene holds nothing of the catalogue.
  Result<Want> Suggest(const SceneTruth& truth) const;

  size_t pairs() const;
  /// In alphabetical order.
  std::vector<std::string> categories() const;

 private:
  std::map<std::string, std::vector<std::string>> actions_;  // by category
};

}  // namespace beckon::tool
