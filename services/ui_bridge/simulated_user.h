// A user who wants one action on one kind of object, sees what it sees, and answers accordingly:
// what tests, the headless demo and measurements put in a person's place.
#pragma once

#include <optional>
#include <random>
#include <string>
#include <variant>

#include "lcmtypes/messages.h"
#include "services/base/scene_truth.h"

namespace beckon::ui_bridge {

struct SimulatedUserConfig {
  std::string action;    // e.g. "Open"
  std::string category;  // e.g. "Carton"; the nearest instance is wanted
  double flip = 0;       // 0..1, chance that a yes/no answer or a choice comes out wrong
  uint64_t seed = 1;     // of those chances
};

/// Index of the option taken.
struct Choose {
  size_t option;
};
/// Nothing on offer is right, and no option says so.
struct RefuseAll {};
/// The scene is not known yet: ask again when it is.
struct CannotTell {};
/// What is wanted is not on the table, or no object of the scene shows it.
struct GiveUp {
  std::string reason;
};
using Response = std::variant<Choose, RefuseAll, CannotTell, GiveUp>;

/// With ground truth it sees each object's true category (the truth within 6 cm of its centroid),
/// and wants the nearest of its category. Without, it goes by what was recognised: the nearest
/// object taken for the wanted category, else the one with the highest probability of it; asked
/// what that one is it says the wanted category, and of others the likeliest option.
class SimulatedUser {
 public:
  explicit SimulatedUser(SimulatedUserConfig config);

  void SetTruth(SceneTruth truth) { truth_ = std::move(truth); }
  /// The newest scene. What is wanted is chosen when a session's first question comes; from then on
  /// it is known by its place, then by its id.
  void SeeScene(const msg::Scene& scene);
  /// Call between sessions.
  void ForgetSession();

  Response Respond(const msg::Query& query);

  /// The object wanted in this session (scene_object_t.id), once a question was answered.
  std::optional<int> wanted_object() const { return wanted_id_; }

 private:
  std::optional<int> ChooseObject(const msg::Scene& scene) const;
  /// Looks at the newest scene, where the wanted object is in it.
  void LookAgain();
  /// Why ChooseObject found nothing.
  std::string WhyNoneIsWanted() const;
  /// What the user sees in an object; empty where it cannot say (nothing of the truth is there).
  std::string TrueCategory(int object_id) const;
  Response SayWhatItIs(const msg::Query& query) const;
  bool IsWanted(const msg::ObjectRef& object) const;
  Response AnswerProposition(const msg::Query& query);
  Response AnswerChoice(const msg::Query& query);
  bool Slips();

  SimulatedUserConfig config_;
  std::mt19937_64 engine_;
  SceneTruth truth_;
  std::optional<msg::Scene> newest_;
  std::optional<msg::Scene> scene_;  // that it goes by
  std::optional<int> wanted_id_;
};

}  // namespace beckon::ui_bridge
