#include <cs.h>

#include <algorithm>

#include <waymark/solvers/linear/detail/backends.hpp>
#include <waymark/solvers/linear/detail/finite.hpp>

namespace waymark::solvers {
namespace {

struct FreeSymbolic {
  void operator()(cs_dis* symbolic) const { cs_di_sfree(symbolic); }
};
struct FreeNumeric {
  void operator()(cs_din* numeric) const { cs_di_nfree(numeric); }
};

/// CSparse's up-looking LL^T (Debian's CXSparse, int indices).
class Csparse final : public LinearSolver {
 public:
  void analyze(const BlockPattern& pattern) override {
    scalar_ = to_scalar<int>(pattern);
    numeric_.reset();
    cs_di matrix = view(nullptr);
    constexpr int kNaturalOrder = 0;
    symbolic_.reset(cs_di_schol(kNaturalOrder, &matrix));
  }

  [[nodiscard]] FactorStatus factorize(std::span<const double> values) override {
    if (symbolic_ == nullptr) return FactorStatus::out_of_memory;
    if (!all_finite(values)) return FactorStatus::not_positive_definite;
    const cs_di matrix = view(values.data());
    numeric_.reset(cs_di_chol(&matrix, symbolic_.get()));
    return numeric_ == nullptr ? FactorStatus::not_positive_definite : FactorStatus::ok;
  }

  void solve(std::span<const double> b, std::span<double> x) override {
    if (x.data() != b.data()) std::copy(b.begin(), b.end(), x.begin());
    cs_di_lsolve(numeric_->L, x.data());
    cs_di_ltsolve(numeric_->L, x.data());
  }

  [[nodiscard]] std::int64_t factor_size() const override {
    return symbolic_ == nullptr ? 0 : static_cast<std::int64_t>(symbolic_->lnz);
  }
  [[nodiscard]] std::string description() const override { return "csparse, simplicial"; }

 private:
  // CSparse takes mutable pointers but only reads a matrix that it factorises.
  cs_di view(const double* values) {
    cs_di matrix{};
    matrix.m = matrix.n = static_cast<int>(scalar_.column.size()) - 1;
    matrix.nzmax = static_cast<int>(scalar_.row.size());
    matrix.p = scalar_.column.data();
    matrix.i = scalar_.row.data();
    matrix.x = const_cast<double*>(values);
    matrix.nz = -1;
    return matrix;
  }

  ScalarPattern<int> scalar_;
  std::unique_ptr<cs_dis, FreeSymbolic> symbolic_;
  std::unique_ptr<cs_din, FreeNumeric> numeric_;
};

}  // namespace

LinearSolverType csparse_solver() {
  return {"csparse", "CSparse's up-looking LL^T", "LGPL-2.1", [](const CheckedOptions&) { return std::make_unique<Csparse>(); }};
}

}  // namespace waymark::solvers
