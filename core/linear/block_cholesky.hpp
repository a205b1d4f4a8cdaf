/// Cholesky factorisation of a sparse symmetric positive definite matrix of small dense blocks.
///
/// Chains are eliminated link by link in registers, from both ends. Everything else is eliminated
/// in dense fronts, and each front passes its update to its parent (the multifrontal method; Duff,
/// Reid 1983). Nothing recurses, and nothing allocates after the first factorisation. Several
/// threads may work on independent subtrees. Sums always have the same order, so the bits do not
/// depend on the number of threads.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/detail/large_array.hpp>
#include <waymark/core/base/export.hpp>
#include <waymark/core/linear/block_symbolic.hpp>
#include <waymark/core/linear/detail/dense_kernels.hpp>
#include <waymark/core/linear/linear_solver.hpp>

namespace WAYMARK_EXPORT waymark {

class ThreadPool;

/// It owns its factor, and keeps no reference to the arguments of analyze() and factorize(). One
/// thread at a time may use it.
class BlockCholesky final : public LinearSolver {
 public:
  /// @param kernels must outlive this object; other kernels give other rounding
  explicit BlockCholesky(const DenseKernels& kernels = dense_kernels()) : kernels_(&kernels) {}

  void analyze(const BlockPattern& pattern) override;
  [[nodiscard]] FactorStatus factorize(std::span<const double> values) override;
  void solve(std::span<const double> b, std::span<double> x) override;
  [[nodiscard]] std::int64_t factor_size() const override { return symbolic_.factor_size; }
  [[nodiscard]] std::string description() const override;
  void set_threads(ThreadPool* pool) override { pool_ = pool; }

  /// Computes diagonal blocks of the inverse from the last factor, which must be ok
  /// (block_inverse.cpp).
  /// @param blocks for each block column of the pattern given to analyze(): where its whole block
  /// goes, column by column; null: not wanted. For all blocks, chains cost about as much as their
  /// factorisation, and dense fronts about four times as much. A subtree without a wanted block
  /// costs nothing.
  void invert_diagonal(std::span<double* const> blocks) const;

  /// Returns log det of the matrix from the last factor, which must be ok.
  [[nodiscard]] double log_determinant() const;

 private:
  class Stream;
  class DiagonalInverse;
  friend class InverseForm;

  /// Makes a pass over all subtrees in parallel, and then over the nodes above them. Returns false
  /// if a pivot failed.
  template <typename Pass>
  bool walk_subtrees(const Pass& pass);
  template <typename Pass>
  bool walk_top(const Pass& pass);
  template <typename Work>
  void for_each_subtree(Work work);

  BlockSymbolic symbolic_;
  const DenseKernels* kernels_;
  ThreadPool* pool_ = nullptr;
  LargeArray<double> factor_;
  LargeArray<double> updates_;
  std::vector<double> vectors_;
  LargeArray<double> work_;
};

}  // namespace waymark
