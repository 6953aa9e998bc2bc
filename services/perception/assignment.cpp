// Shortest augmenting paths over reduced costs.
#include "services/perception/assignment.h"

#include <limits>

namespace beckon::perception {
namespace {

/// The rows placed so far, optimal among themselves. Behind the real columns come as many that mean
/// none.
class Matching {
 public:
  Matching(const std::vector<double>& costs, int n_rows, int n_columns, double none)
      : costs_(costs),
        n_columns_(n_columns),
        n_all_(n_columns + n_rows),
        none_(none),
        row_price_(n_rows, 0),
        column_price_(n_all_, 0),
        row_of_(n_all_, -1) {}

  /// Finds the path along which `new_row` displaces others most cheaply, and moves them.
  void Place(int new_row) {
    std::vector<double> best(n_all_, std::numeric_limits<double>::infinity());
    std::vector<int> from(n_all_, -1);
    std::vector<char> reached(n_all_, 0);
    int column = -1, row = new_row;
    while (row >= 0) {
      int next = -1;
      for (int c = 0; c < n_all_; ++c) {
        if (reached[c]) continue;
        const double reduced = Cost(row, c) - row_price_[row] - column_price_[c];
        if (reduced < best[c]) best[c] = reduced, from[c] = column;
        if (next < 0 || best[c] < best[next]) next = c;
      }
      Reprice(new_row, best[next], reached, best);
      reached[next] = 1;
      column = next;
      row = row_of_[next];
    }
    for (; column >= 0; column = from[column]) {
      row_of_[column] = from[column] >= 0 ? row_of_[from[column]] : new_row;
    }
  }

  std::vector<int> Columns() const {
    std::vector<int> columns(row_price_.size(), -1);
    for (int c = 0; c < n_columns_; ++c) {
      if (row_of_[c] >= 0) columns[row_of_[c]] = c;
    }
    return columns;
  }

 private:
  double Cost(int row, int column) const {
    return column < n_columns_ ? costs_[static_cast<size_t>(row) * n_columns_ + column] : none_;
  }

  void Reprice(int new_row, double by, const std::vector<char>& reached,
               std::vector<double>& best) {
    row_price_[new_row] += by;
    for (int c = 0; c < n_all_; ++c) {
      if (reached[c]) {
        row_price_[row_of_[c]] += by;
        column_price_[c] -= by;
      } else {
        best[c] -= by;
      }
    }
  }

  const std::vector<double>& costs_;
  int n_columns_, n_all_;
  double none_;
  std::vector<double> row_price_, column_price_;
  std::vector<int> row_of_;  // of each column, or -1
};

}  // namespace

std::vector<int> Assign(const std::vector<double>& costs, int n_rows, int n_columns, double none) {
  Matching matching(costs, n_rows, n_columns, none);
  for (int row = 0; row < n_rows; ++row) matching.Place(row);
  return matching.Columns();
}

}  // namespace beckon::perception
