#include "services/intention/core/simulated_tastes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beckon::intention {

std::vector<Taste> AllTastes(const Affordances& affordances) {
  std::vector<Taste> all;
  for (int category = 0; category < static_cast<int>(affordances.categories().size()); ++category) {
    for (const int action : affordances.categories()[category].actions) {
      all.push_back({category, action});
    }
  }
  return all;
}

Tastes::Tastes(const Affordances& affordances)
    : actions_(affordances.actions().size()),
      weights_(actions_ * affordances.categories().size()) {}

Tastes Tastes::Sparse(const Affordances& affordances, SeededRandom& random) {
  Tastes tastes(affordances);
  const int most = 7 + random.Below(9);
  tastes.LikeInTurn(AllTastes(affordances), most, random.Between(0.6, 0.8), random);
  return tastes;
}

Tastes Tastes::Blend(const Tastes& a, const Tastes& b, double share_of_b) {
  Tastes blend = a;
  for (size_t i = 0; i < blend.weights_.size(); ++i) {
    blend.weights_[i] = (1 - share_of_b) * a.weights_[i] + share_of_b * b.weights_[i];
  }
  return blend;
}

void Tastes::LikeInTurn(std::vector<Taste> among, int most, double ratio, SeededRandom& random) {
  most = std::min(most, static_cast<int>(among.size()));
  double weight = (1 - ratio) / (1 - std::pow(ratio, most));
  for (int i = 0; i < most; ++i, weight *= ratio) {
    std::swap(among[i], among[i + random.Below(static_cast<int>(among.size()) - i)]);
    weights_[Index(among[i].category, among[i].action)] += weight;
  }
}

int Tastes::Draw(const Situation& table, SeededRandom& random) const {
  std::vector<double> weights;
  for (const Pair& pair : table.pairs) {
    const Instance& object = table.objects[pair.object];
    weights.push_back(object.rank == 1 ? weights_[Index(object.category, pair.action)] : 0);
  }
  const int drawn = random.Weighted(weights);
  return drawn >= 0 ? drawn : random.Below(table.pair_count());
}

}  // namespace beckon::intention
