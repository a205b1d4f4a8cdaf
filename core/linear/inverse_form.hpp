/// B^T A^-1 B for matrices B with few block rows, from a factor of A.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/linear/block_cholesky.hpp>

namespace WAYMARK_EXPORT waymark {

/// One block row of a matrix.
struct BlockRow {
  int column = 0;          ///< block column of the pattern of A with the same unknowns
  Eigen::MatrixXd values;  ///< one row per scalar of it
};

/// With A = L L^T the form is Y^T Y, Y = L^-1 B. Y is zero but on the ways from the block rows of B to the
/// root of the elimination tree (Gilbert, Peierls 1988). Only these supernodes are visited, once, and nothing
/// is substituted backwards.
///
/// The factor must outlive this object, must be ok, and must not change meanwhile. One thread at a time may
/// use an object.
class InverseForm {
 public:
  explicit InverseForm(const BlockCholesky& factor);

  /// Returns the form, of as many rows and columns as B has columns.
  /// @param rows all with the same number of columns; rows of one block column are added
  [[nodiscard]] Eigen::MatrixXd operator()(std::span<const BlockRow> rows);

 private:
  void find_way(std::span<const BlockRow> rows);
  void add_rows(const Supernode& node, std::span<const BlockRow> rows);
  void add_children(const Supernode& node);
  void substitute_front(const Supernode& node);
  void substitute_chain(const Supernode& node);

  const BlockSymbolic& symbolic_;
  const double* factor_;
  std::vector<int> number_;  // of each block column of the pattern, in elimination order
  std::vector<int> node_;    // of each number
  std::vector<char> marked_;
  std::vector<int> way_;              // supernodes, ascending
  std::vector<std::int64_t> passed_;  // of each supernode on the way: where the rows that it passes on begin
  std::vector<double> vectors_;       // only of the way, so that a small form of a large matrix needs little
  Eigen::MatrixXd front_;
  Eigen::MatrixXd form_;
};

}  // namespace waymark
