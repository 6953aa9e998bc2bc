#include "services/ui_bridge/simulated_user.h"

#include <algorithm>
#include <utility>

namespace beckon::ui_bridge {
namespace {

/// An object this near to where it was is the same one, whatever its id.
constexpr double kSamePlace_m = 0.05;

const msg::SceneObject* Find(const msg::Scene& scene, int id) {
  const auto found = std::ranges::find(scene.objects, id, &msg::SceneObject::id);
  return found == scene.objects.end() ? nullptr : &*found;
}

float Probability(const msg::SceneObject& object, const std::string& category) {
  for (const auto& entry : object.probabilities) {
    if (entry.category == category) return entry.probability;
  }
  return object.category == category ? 1.f : 0.f;
}

double Distance(const msg::SceneObject& object) { return object.centroid_W.head<2>().norm(); }

/// The option that says that none of the others is right: it stands for nothing, or, where it is
/// asked what an object is, for the unknown category.
std::optional<size_t> NoneOption(const msg::Query& query) {
  for (size_t i = query.options.size(); i-- > 0;) {
    const auto& option = query.options[i];
    if (option.category == msg::kUnknownCategory) return i;
    if (option.category.empty() && option.actions.empty() && option.objects.empty()) return i;
  }
  return {};
}

Response NoneOf(const msg::Query& query) {
  if (const auto none = NoneOption(query)) return Choose{*none};
  return RefuseAll{};
}

}  // namespace

SimulatedUser::SimulatedUser(SimulatedUserConfig config)
    : config_(std::move(config)), engine_(config_.seed) {}

void SimulatedUser::SeeScene(const msg::Scene& scene) {
  if (scene.has_table) newest_ = scene;
}

void SimulatedUser::ForgetSession() {
  scene_.reset();
  wanted_id_.reset();
}

Response SimulatedUser::Respond(const msg::Query& query) {
  if (!scene_) {
    if (!newest_) return CannotTell{};
    scene_ = newest_;
  }
  if (!wanted_id_) {
    wanted_id_ = ChooseObject(*scene_);
    if (!wanted_id_) return GiveUp{WhyNoneIsWanted()};
  }
  LookAgain();
  switch (query.kind) {
    case msg::QueryKind::kWhatIsIt:
      return SayWhatItIs(query);
    case msg::QueryKind::kChoice:
      return AnswerChoice(query);
    default:
      return AnswerProposition(query);
  }
}

void SimulatedUser::LookAgain() {
  const auto* wanted = Find(*scene_, *wanted_id_);
  const auto away_m = [&](const msg::SceneObject& object) {
    return (object.centroid_W - wanted->centroid_W).norm();
  };
  const auto& objects = newest_->objects;
  const auto nearest = std::ranges::min_element(objects, {}, away_m);
  if (nearest == objects.end()) return;
  if (away_m(*nearest) <= kSamePlace_m) {
    wanted_id_ = nearest->id;
  } else if (Find(*newest_, *wanted_id_) == nullptr) {
    return;
  }
  scene_ = newest_;
}

std::optional<int> SimulatedUser::ChooseObject(const msg::Scene& scene) const {
  const msg::SceneObject* best = nullptr;
  for (const auto& object : scene.objects) {
    const bool right = truth_.known ? TrueCategory(object.id) == config_.category
                                    : object.category == config_.category;
    if (right && (best == nullptr || Distance(object) < Distance(*best))) best = &object;
  }
  if (best != nullptr) return best->id;
  if (truth_.known) return {};
  float highest = 0;
  for (const auto& object : scene.objects) {
    if (const float p = Probability(object, config_.category); p > highest) {
      highest = p;
      best = &object;
    }
  }
  if (best == nullptr) return {};
  return best->id;
}

std::string SimulatedUser::WhyNoneIsWanted() const {
  if (!truth_.known) return "no object on the table is taken for a " + config_.category;
  if (std::ranges::count(truth_.objects, config_.category, &TruthObject::category) == 0)
    return "no object on the table is a " + config_.category + " (by the scene's ground truth)";
  return "no segment of the scene shows the wanted " + config_.category +
         " apart from its neighbours";
}

std::string SimulatedUser::TrueCategory(int object_id) const {
  const auto* object = Find(*scene_, object_id);
  if (object == nullptr) return {};
  const auto match = truth_.At(scene_->X_WC.inverse() * object->centroid_W);
  return match ? truth_.objects[*match].category : std::string();
}

Response SimulatedUser::SayWhatItIs(const msg::Query& query) const {
  const int id = query.objects.empty() ? 0 : query.objects.front().object_id;
  std::optional<size_t> chosen;
  if (truth_.known || id == *wanted_id_) {
    const std::string seen = truth_.known ? TrueCategory(id) : config_.category;
    for (size_t i = 0; i < query.options.size() && !chosen; ++i) {
      if (!seen.empty() && query.options[i].category == seen) chosen = i;
    }
  } else if (const auto* object = Find(*scene_, id)) {
    float highest = 0;
    for (size_t i = 0; i < query.options.size(); ++i) {
      if (query.options[i].category.empty()) continue;
      if (const float p = Probability(*object, query.options[i].category); p > highest) {
        highest = p;
        chosen = i;
      }
    }
  }
  if (chosen) return Choose{*chosen};
  return NoneOf(query);
}

// The object must be the wanted one and be called what it is: "the box" is not a carton that was
// taken for a box. Refusing it is what leads to the question what it is.
bool SimulatedUser::IsWanted(const msg::ObjectRef& object) const {
  return object.object_id == *wanted_id_ && object.category == config_.category;
}

Response SimulatedUser::AnswerProposition(const msg::Query& query) {
  const bool action = query.any_action || std::ranges::count(query.actions, config_.action) > 0;
  const bool object = query.any_object || std::ranges::any_of(query.objects, [this](const auto& o) {
                        return IsWanted(o);
                      });
  const bool yes = (action && object) != Slips();
  return Choose{yes ? size_t{0} : size_t{1}};  // options are Yes, No in this order
}

// Where several options hold the first is meant.
Response SimulatedUser::AnswerChoice(const msg::Query& query) {
  const auto wanted =
      std::ranges::find_if(query.objects, [this](const auto& o) { return IsWanted(o); });
  const auto holds = [&](const msg::Option& option) {
    if (option.actions.empty() && option.objects.empty()) return false;
    const bool action =
        option.actions.empty() || std::ranges::count(option.actions, config_.action) > 0;
    const bool object =
        option.objects.empty() || (wanted != query.objects.end() &&
                                   std::ranges::count(option.objects, wanted->object_id) > 0);
    return action && object;
  };
  std::optional<size_t> meant;
  const auto first = std::ranges::find_if(query.options, holds);
  if (first != query.options.end()) meant = static_cast<size_t>(first - query.options.begin());
  if (!meant) meant = NoneOption(query);
  if (!meant) return RefuseAll{};
  if (Slips())
    *meant = (*meant + 1 + engine_() % (query.options.size() - 1)) % query.options.size();
  return Choose{*meant};
}

bool SimulatedUser::Slips() {
  constexpr double kUnit = 0x1p-53;
  return static_cast<double>(engine_() >> 11) * kUnit < config_.flip;
}

}  // namespace beckon::ui_bridge
