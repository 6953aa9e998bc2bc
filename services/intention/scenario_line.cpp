#include "services/intention/scenario_line.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "services/intention/json_lines.h"

namespace beckon::intention {
namespace {

using nlohmann::json;

/// Farther away than anything on a table.
constexpr double kMostMetres = 1000;
/// The year 9999.
constexpr Utime kMostUtime = 253'402'300'800 * kSecond;

std::string Found(const json& value) {
  const std::string text = value.is_structured()
                               ? std::string("a list or an object")
                               : value.dump(-1, ' ', true, json::error_handler_t::replace);
  return ", found " + Plain(text);
}

/// A key of an object that must be there; throws what is wrong, in words.
const json& Need(const json& object, const char* key, const std::string& where) {
  if (!object.is_object()) throw where + " must be an object with '" + key + "'" + Found(object);
  const auto found = object.find(key);
  if (found == object.end()) throw where + " lacks '" + key + "'";
  return *found;
}

double NeedMetres(const json& object, const char* key, const std::string& where, double least) {
  const json& value = Need(object, key, where);
  const double metres = value.is_number() ? value.get<double>() : NAN;
  if (!(metres >= least && metres <= kMostMetres)) {
    const std::string from = least < 0 ? "-1000" : "0";
    throw where + ": '" + key + "' must be a number of metres from " + from + " to 1000" +
        Found(value);
  }
  return metres;
}

std::string NeedText(const json& object, const char* key, const std::string& where) {
  const json& value = Need(object, key, where);
  if (!value.is_string()) throw where + ": '" + key + "' must be a text" + Found(value);
  return value.get<std::string>();
}

template <typename Named>
std::string Names(const std::vector<Named>& all) {
  std::string names;
  for (const Named& one : all) names += (names.empty() ? "" : ", ") + one.name;
  return names;
}

int NeedCategory(const json& object, const Affordances& affordances, const std::string& where) {
  const std::string name = NeedText(object, "category", where);
  const int category = affordances.FindCategory(name);
  if (category >= 0) return category;
  throw where + ": unknown category '" + Plain(name) + "', expected one of " +
      Names(affordances.categories());
}

int NeedAction(const json& object, const Affordances& affordances, const std::string& where) {
  const std::string name = NeedText(object, "action", where);
  const int action = affordances.FindAction(name);
  if (action >= 0) return action;
  throw where + ": unknown action '" + Plain(name) + "', expected one of " +
      Names(affordances.actions());
}

std::vector<Thing> ParseScene(const json& scene, const Affordances& affordances) {
  const std::string expected =
      "'scene' must be a list of 1 to " + std::to_string(kMaxThings) + " objects";
  if (!scene.is_array()) throw expected + Found(scene);
  if (scene.empty() || scene.size() > kMaxThings)
    throw expected + ", found " + std::to_string(scene.size());
  std::vector<Thing> things;
  bool all_lateral = true;
  for (const json& object : scene) {
    const std::string where = "object " + std::to_string(things.size() + 1) + " of 'scene'";
    Thing thing;
    thing.category = NeedCategory(object, affordances, where);
    thing.distance_m = NeedMetres(object, "distance_m", where, 0);
    const bool has_lateral = object.contains("lateral_m");
    if (has_lateral) thing.lateral_m = NeedMetres(object, "lateral_m", where, -kMostMetres);
    all_lateral &= has_lateral;
    things.push_back(thing);
  }
  for (Thing& thing : things) thing.lateral_m = all_lateral ? thing.lateral_m : 0;
  return things;
}

Utime ParseUtime(const json& value) {
  const bool right = value.is_number_integer() && value >= 0 && value <= kMostUtime;
  if (!right) throw "'utime' must be a whole number of microseconds since the epoch" + Found(value);
  return value.get<Utime>();
}

/// What is wanted must be possible.
void CheckWant(const ScenarioSession& session, const Affordances& affordances) {
  const Category& category = affordances.categories()[session.want_category];
  int present = 0;
  for (const Thing& thing : session.scene) present += thing.category == session.want_category;
  if (session.want_rank > present) {
    throw "'want': " + category.name + " " + std::to_string(session.want_rank) +
        " is not in the scene, which has " + (present == 0 ? "none" : std::to_string(present));
  }
  if (affordances.Affords(session.want_category, session.want_action)) return;
  std::string afforded;
  for (const int action : category.actions)
    afforded += (afforded.empty() ? "" : ", ") + affordances.actions()[action].name;
  throw "'want': a " + category.name + " affords " + afforded + "; not " +
      affordances.actions()[session.want_action].name;
}

}  // namespace

Result<ScenarioSession> ParseScenarioSession(const json& line, const Affordances& affordances) {
  try {
    ScenarioSession session;
    session.user = NeedText(line, "user", "the session");
    session.scene = ParseScene(Need(line, "scene", "the session"), affordances);
    if (line.contains("utime")) session.utime = ParseUtime(line.at("utime"));
    const json& want = Need(line, "want", "the session");
    session.want_category = NeedCategory(want, affordances, "'want'");
    session.want_action = NeedAction(want, affordances, "'want'");
    const json& instance = Need(want, "instance", "'want'");
    const bool counted = instance.is_number_integer() && instance >= 1 && instance <= 1'000'000;
    if (!counted)
      throw "'want': 'instance' must be a whole number from 1, the nearest" + Found(instance);
    session.want_rank = instance.get<int>();
    CheckWant(session, affordances);
    return session;
  } catch (const std::string& what) {
    return Error{what};
  }
}

}  // namespace beckon::intention
