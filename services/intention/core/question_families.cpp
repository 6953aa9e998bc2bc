#include "services/intention/core/question_families.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace beckon::intention {
namespace {

/// Of the whole: less tells nothing.
constexpr double kNothing = 1e-6;

uint64_t Bit(int i) { return uint64_t{1} << i; }

template <typename Key>
void AddPrefixes(const Situation& situation, Key key, std::vector<uint64_t>& prefixes) {
  std::vector<int> order(situation.objects.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return key(situation.objects[a]) < key(situation.objects[b]);
  });
  uint64_t mask = 0;
  for (size_t k = 0; k + 1 < order.size(); ++k) {
    mask |= Bit(order[k]);
    const bool tied = key(situation.objects[order[k]]) == key(situation.objects[order[k + 1]]);
    if (k > 0 && !tied) prefixes.push_back(mask);
  }
}

}  // namespace

ObjectGroups::ObjectGroups(const Situation& situation) {
  uint64_t done = 0;
  for (size_t i = 0; i < situation.objects.size(); ++i) {
    const int category = situation.objects[i].category;
    if (category < 0 || (done >> i & 1) != 0) continue;
    categories.push_back(situation.MaskOf(category));
    done |= categories.back();
  }
  AddPrefixes(
      situation, [](const Instance& o) { return o.distance_m; }, prefixes);
  if (situation.has_lateral)
    AddPrefixes(
        situation, [](const Instance& o) { return o.lateral_m; }, prefixes);
}

Question PricedQuestion::AsQuestion() const {
  if (kind == QuestionKind::kChoice) return {kind, options};
  return AskYesNo(kind, asked);
}

void CheapestQuestions::Part::Add(const Mass& pair_mass, int pair, std::span<const Mass> pairs) {
  mass += pair_mass;
  ++possible;
  if (likeliest < 0 || pair_mass.p > pairs[likeliest].p) likeliest = pair;
}

void CheapestQuestions::Part::Add(const Part& part, std::span<const Mass> pairs) {
  if (part.possible == 0) return;
  mass += part.mass;
  possible += part.possible;
  if (likeliest < 0 || pairs[part.likeliest].p > pairs[likeliest].p) likeliest = part.likeliest;
}

CheapestQuestions::CheapestQuestions(const Situation& situation, const ObjectGroups& groups,
                                     const QuestionCost& cost, QueryFamilies families,
                                     std::span<const Mass> pairs, const Mass& none, size_t keep)
    : situation_(situation),
      groups_(groups),
      cost_(cost),
      pairs_(pairs),
      keep_(keep),
      total_(none) {
  for (int i = 0; i < situation.pair_count(); ++i) {
    if (pairs[i].p <= 0) continue;
    total_ += pairs[i];
    by_action_[situation.pairs[i].action].Add(pairs[i], i, pairs);
    by_object_[situation.pairs[i].object].Add(pairs[i], i, pairs);
  }
  if (total_.p <= none.p) return;
  // From the easiest to the hardest: of equals the first is kept.
  ConsiderFull();
  for (int i = 0; i < object_count(); ++i)
    Consider(QuestionKind::kObject, kAny, Bit(i), by_object_[i]);
  for (int i = 0; i < kMaxActions; ++i)
    Consider(QuestionKind::kAction, Bit(i), kAny, by_action_[i]);
  if (families == QueryFamilies::kAll) {
    for (const uint64_t mask : groups.categories) {
      if (!std::has_single_bit(mask)) Consider(QuestionKind::kCategory, kAny, mask, PartOf(mask));
    }
    ConsiderPairsOfActions();
    for (const uint64_t mask : groups.prefixes)
      Consider(QuestionKind::kSet, kAny, mask, PartOf(mask));
  }
  if (cost.interface().Choices()) ConsiderChoices(families);
}

double CheapestQuestions::Cost() const {
  return best_.empty() ? total_.p * cost_.Remaining(0) : best_.front().cost;
}

void CheapestQuestions::Offer(double cost, QuestionKind kind, const Proposition& asked,
                              std::span<const Offered> options) {
  ++priced_;
  const double same = 1e-12 * total_.p * cost_.seconds();
  if (best_.size() == keep_ && cost >= best_.back().cost - same) return;
  auto place = best_.begin();
  while (place != best_.end() && place->cost < cost - same) ++place;
  if (place != best_.end() && place->cost <= cost + same) return;
  if (best_.size() == keep_) best_.pop_back();
  place = best_.insert(place, {cost, kind, asked, {}});
  for (const auto& [part, proposition] : options)
    place->options.push_back(AskedBy(part, proposition));
}

/// A question that everybody answers alike tells nothing.
void CheapestQuestions::Consider(QuestionKind kind, uint64_t actions, uint64_t objects,
                                 const Part& part) {
  const double p = part.mass.p;
  if (p <= kNothing * total_.p || p >= (1 - kNothing) * total_.p) return;
  const QuestionCost::Option yes{part.mass, false};
  Offer(cost_.Of(total_, {&yes, 1}), kind, {actions, objects, -1});
}

/// The two likeliest pairs: to ask for another one first is never better.
void CheapestQuestions::ConsiderFull() {
  int first = -1, second = -1;
  for (int i = 0; i < situation_.pair_count(); ++i) {
    if (pairs_[i].p <= 0) continue;
    if (first < 0 || pairs_[i].p > pairs_[first].p) {
      second = std::exchange(first, i);
    } else if (second < 0 || pairs_[i].p > pairs_[second].p) {
      second = i;
    }
  }
  for (const int pair : {first, second}) {
    if (pair < 0) continue;
    const QuestionCost::Option yes{pairs_[pair], true};
    Offer(cost_.Of(total_, {&yes, 1}), QuestionKind::kFull, PairProposition(situation_, pair));
  }
}

/// "Grasp or move something?"
void CheapestQuestions::ConsiderPairsOfActions() {
  for (int a = 0; a < kMaxActions; ++a) {
    if (by_action_[a].possible == 0) continue;
    for (int b = a + 1; b < kMaxActions; ++b) {
      if (by_action_[b].possible == 0) continue;
      Part both = by_action_[a];
      both.mass += by_action_[b].mass;
      Consider(QuestionKind::kAction, Bit(a) | Bit(b), kAny, both);
    }
  }
}

void CheapestQuestions::ConsiderChoices(QueryFamilies families) {
  std::vector<Offered> pairs, objects, actions, categories;
  for (int i = 0; i < situation_.pair_count(); ++i) {
    if (pairs_[i].p > 0) pairs.push_back({{pairs_[i], 1, i}, {}});
  }
  for (int i = 0; i < object_count(); ++i) {
    if (by_object_[i].possible > 0) objects.push_back({by_object_[i], {kAny, Bit(i), -1}});
  }
  for (int i = 0; i < kMaxActions; ++i) {
    if (by_action_[i].possible > 0) actions.push_back({by_action_[i], {Bit(i), kAny, -1}});
  }
  ConsiderChoiceOf(std::move(pairs));
  ConsiderChoiceOf(std::move(objects));
  ConsiderChoiceOf(std::move(actions));
  if (families != QueryFamilies::kAll || groups_.categories.size() == situation_.objects.size())
    return;
  for (const uint64_t mask : groups_.categories) {
    const Part part = PartOf(mask);
    if (part.possible > 0) categories.push_back({part, {kAny, mask, -1}});
  }
  ConsiderChoiceOf(std::move(categories));
}

/// The m likeliest options: every m up to 8, then a quarter more each time.
void CheapestQuestions::ConsiderChoiceOf(std::vector<Offered> options) {
  const size_t most = std::min<size_t>(options.size(), cost_.interface().max_options - 1);
  if (most < 2) return;
  std::partial_sort(options.begin(), options.begin() + static_cast<std::ptrdiff_t>(most),
                    options.end(), [](const Offered& a, const Offered& b) {
                      return a.first.mass.p != b.first.mass.p
                                 ? a.first.mass.p > b.first.mass.p
                                 : a.first.likeliest < b.first.likeliest;
                    });
  std::array<QuestionCost::Option, 64> priced;
  for (size_t i = 0; i < most; ++i)
    priced[i] = {options[i].first.mass, options[i].first.possible == 1};
  for (size_t m = 2; m <= most;
       m = m == most ? m + 1 : std::min(most, m + std::max<size_t>(1, m / 4))) {
    Offer(cost_.Of(total_, std::span(priced).first(m)), QuestionKind::kChoice, {},
          std::span(options).first(m));
  }
}

CheapestQuestions::Part CheapestQuestions::PartOf(uint64_t objects) const {
  Part part;
  for (int i = 0; i < object_count(); ++i) {
    if (objects >> i & 1) part.Add(by_object_[i], pairs_);
  }
  return part;
}

/// Of an option that leaves but one pair: that pair, so that it need not be confirmed.
Proposition CheapestQuestions::AskedBy(const Part& part, const Proposition& proposition) const {
  return part.possible == 1 ? PairProposition(situation_, part.likeliest) : proposition;
}

}  // namespace beckon::intention
