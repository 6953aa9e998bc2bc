// The cheapest way to give rows columns of their own.
#pragma once

#include <cstddef>
#include <vector>

namespace beckon::perception {

/// A cost no pair that may not be should fall below.
inline constexpr double kForbidden = 1e9;

/// The column of each row, or -1, so that no column is given twice and the sum of costs is least,
/// where a row without a column costs `none`. `costs` is row-major, n_rows x n_columns. By shortest
/// augmenting paths (Jonker & Volgenant, "A Shortest Augmenting Path Algorithm for Dense and Sparse
/// Linear Assignment Problems", 1987).
std::vector<int> Assign(const std::vector<double>& costs, int n_rows, int n_columns, double none);

}  // namespace beckon::perception
