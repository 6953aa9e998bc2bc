// Which instance of a category a user wants: the nearest, the one furthest away, or a favourite.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace beckon::intention {

/// A Bayesian mixture of three ways to choose, weighed by how well each predicted.
class InstanceHabit {
 public:
  explicit InstanceHabit(int categories);

  /// P(rank) at [rank - 1] for ranks 1..instances of a category, sum 1.
  std::vector<double> Predict(int category, int instances) const;
  /// `instances`: how many there were, < 0 where that is not known. A choice of one tells nothing.
  void Learn(int category, int rank, int instances);

 private:
  /// Decayed counts by place: from the nearest, or from the furthest.
  struct Counts {
    std::vector<double> n;
    double Of(int place) const {
      return place < static_cast<int>(n.size()) ? n[static_cast<size_t>(place)] : 0;
    }
    void Add(int place);
  };
  enum Way { kFromNearest, kFavourite, kFromFurthest, kWays };
  /// P(rank) by each way.
  std::array<double, kWays> Ways(int category, int rank, int instances) const;

  std::array<double, kWays> way_;
  Counts near_;
  Counts far_;
  std::vector<Counts> favourite_;  // by category
};

}  // namespace beckon::intention
