// A linear solver: factorises H and solves with the factor. It sees blocks and numbers, never a graph. This
// one writes H out in full: slow, and as plain as a reference can be.
#include <Eigen/Cholesky>

#include <waymark/core/base/error.hpp>
#include <waymark/core/registry/plugin.hpp>

using namespace waymark;

class DenseCholesky final : public LinearSolver {
 public:
  explicit DenseCholesky(const CheckedOptions& options)
      : most_(static_cast<std::int64_t>(options.number("most"))) {}

  /// Once per pattern: everything that does not depend on the numbers.
  void analyze(const BlockPattern& pattern) override {
    if (pattern.dimension() > most_)
      throw UsageError("dense: " + std::to_string(pattern.dimension()) + " unknowns are too many, at most " +
                       std::to_string(most_) + "; use block_cholesky");
    pattern_ = to_scalar<int>(pattern);  // row and column of each number
    matrix_.setZero(pattern.dimension(), pattern.dimension());
  }

  /// In every iteration. Failing is ordinary: a damped algorithm then damps more.
  [[nodiscard]] FactorStatus factorize(std::span<const double> values) override {
    for (Eigen::Index j = 0; j < matrix_.cols(); ++j) {
      const auto column = static_cast<std::size_t>(j);
      for (int k = pattern_.column[column]; k < pattern_.column[column + 1]; ++k) {
        const auto number = static_cast<std::size_t>(k);
        matrix_(pattern_.row[number], j) = values[number];
      }
    }
    factor_.compute(matrix_);  // reads the upper triangle
    // NaN passes for a positive pivot in most libraries; it always reaches the diagonal of the factor.
    const bool sound = factor_.info() == Eigen::Success && factor_.matrixLLT().diagonal().allFinite();
    return sound ? FactorStatus::ok : FactorStatus::not_positive_definite;
  }

  void solve(std::span<const double> b, std::span<double> x) override {
    Eigen::Map<Eigen::VectorXd> solution(x.data(), matrix_.cols());
    solution = Eigen::Map<const Eigen::VectorXd>(b.data(), matrix_.cols());  // b and x may be one memory
    factor_.solveInPlace(solution);
  }

  [[nodiscard]] std::int64_t factor_size() const override {
    return matrix_.cols() * (matrix_.cols() + 1) / 2;
  }
  [[nodiscard]] std::string description() const override { return "dense"; }

 private:
  std::int64_t most_;
  ScalarPattern<int> pattern_;
  Eigen::MatrixXd matrix_;
  Eigen::LLT<Eigen::MatrixXd, Eigen::Upper> factor_;
};

static void register_types(TypeRegistry& registry) {
  registry.add_linear_solver(
      {"dense",
       "Eigen's dense LL^T, for small graphs",
       "MPL-2.0",
       [](const CheckedOptions& options) { return std::make_unique<DenseCholesky>(options); },
       {{"most", "5000", "", OptionRange{1, 1e5}, "unknowns; more are refused (5000: 200 MB)"}}});
}
WAYMARK_PLUGIN(dense_solver, "1.0.0", register_types);
