// How an interview follows what stands on the table.
#include <algorithm>
#include <bit>
#include <tuple>

#include "services/intention/core/interview.h"

namespace beckon::intention {
namespace {

/// How far behind the furthest a gone object is put, so that it is in no set of nearest ones.
constexpr double kBehind_m = 0.001;
/// Below this posterior a candidate is ruled out.
constexpr double kRuledOut = 1e-9;

auto Shown(const msg::ObjectRef& object) {
  return std::tie(object.object_id, object.category, object.instance);
}

bool SaySame(const msg::Query& a, const msg::Query& b) {
  return a.kind == b.kind && a.text == b.text && a.any_action == b.any_action &&
         a.actions == b.actions && a.any_object == b.any_object &&
         std::ranges::equal(a.objects, b.objects, {}, Shown, Shown) &&
         std::ranges::equal(a.options, b.options, [](const auto& x, const auto& y) {
           return x.text == y.text && x.objects == y.objects;
         });
}

}  // namespace

uint64_t Interview::OnTable() const {
  uint64_t mask = 0;
  for (size_t i = 0; i < input_.table.size(); ++i) {
    if (!input_.table[i].gone) mask |= uint64_t{1} << i;
  }
  return mask;
}

/// A gone object affords nothing and stands behind all others.
Situation Interview::SituationNow() const {
  std::vector<Thing> things;
  double furthest_m = 0, rightmost_m = 0;
  for (size_t i = 0; i < input_.table.size(); ++i) {
    const Eigen::Vector3d& place = input_.table[i].object.centroid_W;
    things.push_back({opinions_[i].category, std::hypot(place.x(), place.y()), place.x()});
    furthest_m = std::max(furthest_m, things[i].distance_m);
    rightmost_m = std::max(rightmost_m, things[i].lateral_m);
  }
  for (size_t i = 0; i < input_.table.size(); ++i) {
    if (input_.table[i].gone) things[i] = {-1, furthest_m + kBehind_m, rightmost_m + kBehind_m};
  }
  return MakeSituation(affordances_, things, input_.utime);
}

/// To refuse all that is on offer is a sure no to the objects that are there.
void Interview::Apply(const RefusedAll& step) {
  refused_ = step.objects;
  Heard no;
  no.question = AskYesNo(QuestionKind::kSet, {kAny, step.objects, -1});
  no.evidence.said = no.question.none();
  no.evidence.likelihood.resize(2);
  no.evidence.likelihood[0].fill(0);
  no.evidence.likelihood[1].fill(1);
  evidence_.push_back(std::move(no));
}

bool Interview::RefusedEverything() const {
  return refused_ != 0 && std::ranges::all_of(situation_.pairs, [this](const Pair& pair) {
           return (refused_ >> pair.object & 1) != 0;
         });
}

bool Interview::ChoseTheGone(const Heard& step) const {
  if (step.evidence.said == step.question.none()) return false;
  return (step.question.options[step.evidence.said].objects & OnTable()) == 0;
}

size_t Interview::Outdated() const {
  const auto later =
      std::ranges::find_if(evidence_, [this](const Heard& step) { return step.look >= went_at_; });
  return std::max(relabelled_at_, static_cast<size_t>(later - evidence_.begin()));
}

void Interview::Look(std::vector<TableObject> table) {
  ++looks_;
  uint64_t arrived = 0;
  for (size_t i = 0; i < table.size(); ++i) {
    const TableObject* before = i < input_.table.size() ? &input_.table[i] : nullptr;
    const bool came = !table[i].gone && (before == nullptr || before->gone);
    const bool moved = before == nullptr || before->object.centroid_W != table[i].object.centroid_W;
    if (before == nullptr) moved_at_.push_back(looks_);
    if (came || moved) moved_at_[i] = looks_;
    if (came) arrived |= uint64_t{1} << i;
    if (before != nullptr && table[i].gone && !before->gone) went_at_ = looks_;
  }
  input_.table = std::move(table);
  Reconsider(arrived);
}

void Interview::Doubt(int object) {
  moved_at_[object] = ++looks_;
  Recompute();
}

void Interview::Reconsider(uint64_t arrived) {
  const Asked before = asked_;
  Recompute();
  // A task follows an answer, never a change of the table.
  const auto* accepted = std::get_if<AcceptedTask>(&asked_.outcome);
  if (accepted != nullptr && !std::holds_alternative<AcceptedTask>(before.outcome))
    Doubt(accepted->object);
  if (StillStands(before, arrived)) {
    asked_ = before;
    asked_.question = Resolved(before.question, looks_);
  }
}

bool Interview::StillStands(const Asked& asked, uint64_t arrived) const {
  const auto* query = std::get_if<msg::Query>(&asked.outcome);
  if (query == nullptr) return false;
  if (asked.object < 0) return TaskStillStands(asked, arrived);
  return !input_.table[asked.object].gone && !opinions_[asked.object].settled &&
         Shown(Ref(asked.object)) == Shown(query->objects.front());
}

/// Its words are true, it is about the same objects, and each of its options is possible. One that
/// would accept a task speaks of an object at its place.
bool Interview::TaskStillStands(const Asked& asked, uint64_t arrived) const {
  const uint64_t on_table = OnTable();
  for (const Proposition& option : asked.question.options) {
    if (!IsPossible(option)) return false;
    for (size_t i = 0; option.objects != kAny && i < input_.table.size(); ++i) {
      if ((option.objects >> i & 1) == 0) continue;
      if ((on_table >> i & 1) == 0) return false;
      if ((situation_.MaskOf(opinions_[i].category) & arrived) != 0) return false;
      if (option.pair >= 0 && moved_at_[i] > asked.look) return false;
    }
  }
  return SaySame(TaskWords(Resolved(asked.question, looks_)), std::get<msg::Query>(asked.outcome));
}

bool Interview::IsPossible(const Proposition& option) const {
  for (size_t i = 0; i < situation_.pairs.size(); ++i) {
    const bool ruled_out = i < belief_.posterior.size() && belief_.posterior[i] < kRuledOut;
    if (!ruled_out && option.Holds(situation_.pairs[i])) return true;
  }
  return false;
}

bool Interview::StartOver() {
  if (std::exchange(started_over_, true)) return false;
  std::vector<Step> labels;
  for (Step& step : steps_) {
    if (auto* heard = std::get_if<Heard>(&step)) dropped_.push_back(std::move(*heard));
    if (std::holds_alternative<WhatIsIt>(step)) labels.push_back(std::move(step));
  }
  steps_ = std::move(labels);
  Recompute();
  return true;
}

int Interview::asked_object() const {
  if (asked_.object >= 0 || asked_.question.options.size() != 1) return asked_.object;
  const uint64_t objects = asked_.question.options.front().objects;
  return std::has_single_bit(objects) ? std::countr_zero(objects) : -1;
}

bool Interview::HasMoved(const TableObject& now, int object) const {
  return input_.table[object].object.centroid_W != now.object.centroid_W;
}

std::string Interview::Say(const std::string& sentence, int object) const {
  return ObjectText(affordances_, situation_, object, sentence, input_.phrases);
}

}  // namespace beckon::intention
