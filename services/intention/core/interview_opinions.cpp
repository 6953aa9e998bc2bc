// What an interview takes the objects to be, and which of them it asks about next.
#include <algorithm>
#include <tuple>

#include "services/intention/core/interview.h"

namespace beckon::intention {
namespace {

/// Categories offered for an object in doubt before the known tasks are asked about.
constexpr size_t kFirstOffers = 4;
/// A choice is taken once it has this share of the likelihood.
constexpr double kDecided = 0.9;

}  // namespace

void Interview::StartOpinions() {
  opinions_.assign(input_.table.size(), {});
  for (size_t i = 0; i < opinions_.size(); ++i) {
    const auto& [object, remembered, gone] = input_.table[i];
    Opinion& opinion = opinions_[i];
    opinion.remembered = !remembered.empty();
    opinion.in_doubt = object.ask_user && !opinion.remembered;
    const std::string& name = opinion.remembered ? remembered : object.category;
    const int category = affordances_.FindCategory(name);
    opinion.category = opinion.in_doubt ? -1 : category < 0 ? affordances_.unknown() : category;
  }
}

void Interview::Apply(const WhatIsIt& step) {
  ++labels_;
  Opinion& opinion = opinions_[step.object];
  if (opinion.offered != step.offer || opinion.share.empty()) {
    opinion.offered = step.offer;
    opinion.share.assign(step.likelihoods.size(), 1.0);
  }
  double sum = 0;
  for (size_t i = 0; i < step.likelihoods.size(); ++i)
    sum += opinion.share[i] *= step.likelihoods[i];
  if (!(sum > 0)) return opinion.share.clear();  // contradictory: ask again
  for (double& share : opinion.share) share /= sum;
  const auto best = std::max_element(opinion.share.begin(), opinion.share.end());
  if (*best < kDecided) return;
  const auto chosen = static_cast<size_t>(best - opinion.share.begin());
  opinion.share.clear();
  if (chosen == step.offer.size()) return Refuse(step.object, step.offer);
  opinion.settled = true;
  Relabel(step.object, step.offer[chosen]);
}

void Interview::Refuse(int object, const std::vector<int>& categories) {
  Opinion& opinion = opinions_[object];
  opinion.refused.insert(opinion.refused.end(), categories.begin(), categories.end());
  opinion.settled = Left(object).empty();
  const bool was_refused = std::count(categories.begin(), categories.end(), opinion.category) > 0;
  // Nothing is done with an object in doubt before it was asked about.
  const bool was_in_doubt = opinion.category < 0 && opinion.refused.size() >= FirstOffers(object);
  if (was_refused || was_in_doubt || opinion.settled) Relabel(object, -1);
}

void Interview::Relabel(int object, int category) {
  Opinion& opinion = opinions_[object];
  if (category < 0) category = affordances_.unknown();
  if (opinion.category == category) return;
  opinion.category = category;
  // Where nothing can be done with an unknown object, what was refused stays refused.
  if (category < 0) return;
  // Answers about what the object was taken for say nothing of it any more. A no still speaks of
  // the other objects in question.
  const uint64_t others = ~(uint64_t{1} << object);
  std::vector<Heard> kept;
  for (Heard step : evidence_) {
    bool mentions = false, others_left = false;
    for (Proposition& option : step.question.options) {
      const bool named = option.objects != kAny && (option.objects & ~others) != 0;
      if (named) option.objects &= others;
      mentions |= named;
      others_left |= option.objects != 0;
    }
    const bool says_none = step.evidence.said == step.question.none();
    if (!mentions || (says_none && others_left)) kept.push_back(std::move(step));
  }
  evidence_ = std::move(kept);
  relabelled_at_ = evidence_.size();
  refused_ = 0;
}

std::vector<int> Interview::Left(int object) const {
  const auto& refused = opinions_[object].refused;
  std::vector<int> left;
  const auto add = [&](int category) {
    if (!affordances_.IsNamed(category) || std::count(refused.begin(), refused.end(), category) > 0)
      return;
    if (std::count(left.begin(), left.end(), category) == 0) left.push_back(category);
  };
  for (const auto& p : input_.table[object].object.probabilities) {
    add(affordances_.FindCategory(p.category));
  }
  for (int i = 0; i < static_cast<int>(affordances_.categories().size()); ++i) add(i);
  return left;
}

size_t Interview::FirstOffers(int object) const {
  const auto& probabilities = input_.table[object].object.probabilities;
  const bool has_opinion = std::any_of(
      probabilities.begin(), probabilities.end(),
      [&](const auto& p) { return affordances_.IsNamed(affordances_.FindCategory(p.category)); });
  const size_t all = affordances_.categories().size() - (affordances_.unknown() < 0 ? 0 : 1);
  return has_opinion ? kFirstOffers : all;
}

std::vector<int> Interview::Offer(int object) const {
  const Opinion& opinion = opinions_[object];
  if (opinion.settled) return {};
  std::vector<int> offer = Left(object);
  size_t most = std::max(1, Device(input_.device).max_options - 1);
  const size_t first = FirstOffers(object);
  if (!opinion.remembered && opinion.refused.size() < first) {
    most = std::min(most, first - opinion.refused.size());
  }
  if (offer.size() > most) offer.resize(most);
  return offer;
}

int Interview::NextInDoubt() const {
  int next = -1;
  for (int i = 0; i < static_cast<int>(opinions_.size()); ++i) {
    const Opinion& opinion = opinions_[i];
    if (input_.table[i].gone || !opinion.in_doubt || opinion.settled ||
        opinion.refused.size() >= FirstOffers(i))
      continue;
    if (next < 0 || input_.table[i].object.confidence < input_.table[next].object.confidence)
      next = i;
  }
  return next;
}

/// Unknown objects first, for they are sure to be something else than what was refused; then those
/// that perception named, the least sure first; then those that the user named.
int Interview::NextToRecheck() const {
  int next = -1;
  const auto later = [&](int i) {
    const Opinion& opinion = opinions_[i];
    return std::tuple(affordances_.IsNamed(opinion.category), opinion.remembered,
                      input_.table[i].object.confidence);
  };
  for (int i = 0; i < static_cast<int>(opinions_.size()); ++i) {
    if (input_.table[i].gone || opinions_[i].settled) continue;
    if (next < 0 || later(i) < later(next)) next = i;
  }
  return next;
}

}  // namespace beckon::intention
