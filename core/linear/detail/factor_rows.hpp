/// The blocks of a Cholesky factor, found row by row without storing them.
#pragma once

#include <cstddef>
#include <vector>

#include <waymark/core/base/detail/index.hpp>

namespace waymark::detail {

/// Row k of the factor is the union of the paths in the elimination tree from its entries towards k
/// (Gilbert, Ng, Peyton 1994). Tree and paths are followed together, without recursion: begin() each row in
/// ascending order, then follow() each of its entries.
class FactorRows {
 public:
  explicit FactorRows(std::size_t rows) : parent_(rows, -1), seen_(rows, -1) {}

  void begin(std::size_t row) {
    row_ = static_cast<int>(row);
    seen_[row] = row_;
  }

  /// Visits the columns of the factor's row that are reached from an entry of the matrix in this column, and
  /// that no earlier entry of the row has reached.
  template <typename Visit>
  void follow(int column, Visit visit) {
    for (int j = column; seen_[at(j)] != row_; j = parent_[at(j)]) {
      if (parent_[at(j)] < 0) parent_[at(j)] = row_;
      seen_[at(j)] = row_;
      visit(j);
    }
  }

 private:
  int row_ = -1;
  std::vector<int> parent_;  // in the elimination tree, as far as it is known
  std::vector<int> seen_;    // the last row that met a column
};

}  // namespace waymark::detail
