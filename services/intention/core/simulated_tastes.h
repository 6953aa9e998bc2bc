// What a simulated user likes, and drawing a want from it.
#pragma once

#include <vector>

#include "services/intention/core/seeded_random.h"
#include "services/intention/core/situation.h"

namespace beckon::intention {

struct Taste {
  int category = 0;
  int action = 0;
};

/// All that the affordances allow.
std::vector<Taste> AllTastes(const Affordances& affordances);

/// How much each (category, action) is wanted.
class Tastes {
 public:
  /// Nothing is liked yet.
  explicit Tastes(const Affordances& affordances);
  /// 7 to 15 of all, each wanted 0.6 to 0.8 times as much as the one before.
  static Tastes Sparse(const Affordances& affordances, SeededRandom& random);
  /// (1 - share_of_b) of a and share_of_b of b.
  static Tastes Blend(const Tastes& a, const Tastes& b, double share_of_b);

  /// Likes up to `most` of `among`, drawn without replacement, each `ratio` times as much as the
  /// one before; together 1.
  void LikeInTurn(std::vector<Taste> among, int most, double ratio, SeededRandom& random);

  /// A pair of the table: of something liked, with the nearest of its category; any pair where
  /// the table has nothing that is liked.
  int Draw(const Situation& table, SeededRandom& random) const;

 private:
  size_t Index(int category, int action) const { return category * actions_ + action; }

  size_t actions_;
  std::vector<double> weights_;
};

}  // namespace beckon::intention
