// The cheapest assignment, against trying them all.
#include "services/perception/assignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

namespace beckon::perception {
namespace {

using testing::ElementsAre;

TEST(Assign, PrefersTheLeastSumToTheNearestFirst) {
  // Greedily, row 0 would take column 0 (cost 1) and leave 10 to row 1.
  EXPECT_THAT(Assign({1, 2, 2, 10}, 2, 2, 100), ElementsAre(1, 0));
}

TEST(Assign, LeavesARowWithoutAColumnWhereNoneIsCheaper) {
  EXPECT_THAT(Assign({5, kForbidden, 1, kForbidden}, 2, 2, 10), ElementsAre(-1, 0));
  EXPECT_THAT(Assign({5, 1}, 1, 2, 0.5), ElementsAre(-1));
  EXPECT_THAT(Assign({}, 0, 3, 1), ElementsAre());
  EXPECT_THAT(Assign({}, 2, 0, 1), ElementsAre(-1, -1));
}

TEST(Assign, IsAsCheapAsTheBestOfAll) {
  std::mt19937 engine(1);
  for (int trial = 0; trial < 300; ++trial) {
    const int n_rows = 1 + static_cast<int>(engine() % 4),
              n_columns = static_cast<int>(engine() % 5);
    std::vector<double> costs(static_cast<size_t>(n_rows) * n_columns);
    for (double& c : costs) c = engine() % 5 == 0 ? kForbidden : static_cast<double>(engine() % 20);
    const double none = 12;
    std::vector<char> taken(n_columns, 0);
    const std::function<double(int)> best = [&](int row) -> double {
      if (row == n_rows) return 0;
      double least = none + best(row + 1);
      for (int c = 0; c < n_columns; ++c) {
        if (taken[c]) continue;
        taken[c] = 1;
        least = std::min(least, costs[static_cast<size_t>(row) * n_columns + c] + best(row + 1));
        taken[c] = 0;
      }
      return least;
    };
    double sum = 0;
    const auto columns = Assign(costs, n_rows, n_columns, none);
    for (int row = 0; row < n_rows; ++row) {
      sum += columns[row] < 0 ? none : costs[static_cast<size_t>(row) * n_columns + columns[row]];
      EXPECT_TRUE(columns[row] < 0 || !std::exchange(taken[columns[row]], 1));
    }
    EXPECT_DOUBLE_EQ(sum, (std::fill(taken.begin(), taken.end(), 0), best(0)));
  }
}

}  // namespace
}  // namespace beckon::perception
