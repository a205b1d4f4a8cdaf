#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <waymark/solvers/linear/detail/backends.hpp>
#include <waymark/solvers/linear/detail/finite.hpp>

namespace waymark::solvers {
namespace {

/// Eigen's simplicial LL^T. It compiles with EIGEN_MPL2_ONLY, so a build without SuiteSparse
/// is permissive.
class EigenCholesky final : public LinearSolver {
 public:
  void analyze(const BlockPattern& pattern) override {
    scalar_ = to_scalar<int>(pattern);
    factorized_ = false;
    factor_.analyzePattern(view(nullptr));
  }

  [[nodiscard]] FactorStatus factorize(std::span<const double> values) override {
    if (!all_finite(values)) return FactorStatus::not_positive_definite;
    factor_.factorize(view(values.data()));
    factorized_ = factor_.info() == Eigen::Success;
    return factorized_ ? FactorStatus::ok : FactorStatus::not_positive_definite;
  }

  void solve(std::span<const double> b, std::span<double> x) override {
    const auto n = static_cast<Eigen::Index>(b.size());
    const Eigen::VectorXd solution = factor_.solve(Eigen::Map<const Eigen::VectorXd>(b.data(), n));
    Eigen::Map<Eigen::VectorXd>(x.data(), n) = solution;
  }

  [[nodiscard]] std::int64_t factor_size() const override {
    return factorized_ ? factor_.matrixL().nestedExpression().nonZeros() : 0;
  }
  [[nodiscard]] std::string description() const override { return "eigen, simplicial"; }

 private:
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  // The analysis reads only the pattern, but Eigen's interface wants numbers too.
  Matrix view(const double* values) {
    const auto n = static_cast<Eigen::Index>(scalar_.column.size()) - 1;
    if (values == nullptr) {
      pattern_only_.assign(scalar_.row.size(), 1.0);
      values = pattern_only_.data();
    }
    return Eigen::Map<const Matrix>(n, n, static_cast<Eigen::Index>(scalar_.row.size()),
                                    scalar_.column.data(), scalar_.row.data(), values);
  }

  ScalarPattern<int> scalar_;
  std::vector<double> pattern_only_;
  bool factorized_ = false;
  Eigen::SimplicialLLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> factor_;
};

}  // namespace

LinearSolverType eigen_solver() {
  return {"eigen", "Eigen's simplicial LL^T", "MPL-2.0",
          [](const CheckedOptions&) { return std::make_unique<EigenCholesky>(); }};
}

}  // namespace waymark::solvers
