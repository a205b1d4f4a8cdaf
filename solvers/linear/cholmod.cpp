#include <cholmod.h>

#include <algorithm>
#include <new>

#include <waymark/solvers/linear/detail/backends.hpp>
#include <waymark/solvers/linear/detail/finite.hpp>

namespace waymark::solvers {
namespace {

/// Above this many flops per number of the factor the automatic choice is supernodal. CHOLMOD's own
/// 40 assumes a tuned BLAS. With Debian's reference BLAS the two are equal near 100
/// (solvers/README.md).
constexpr double kSupernodalSwitch = 100;

/// CHOLMOD's LL^T, simplicial or supernodal. Its workspaces live as long as this object, so an
/// iteration allocates nothing.
class Cholmod final : public LinearSolver {
 public:
  explicit Cholmod(int supernodal) {
    cholmod_start(&common_);
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_NATURAL;  // the matrix comes in elimination order
    common_.postorder = 0;
    common_.supernodal = supernodal;
    common_.supernodal_switch = kSupernodalSwitch;
    common_.final_asis = 0;
    common_.final_ll = 1;  // LDL^T would pass an indefinite matrix
    common_.quick_return_if_not_posdef = 1;
    common_.print = 0;
    common_.try_catch = 1;  // no messages
  }
  ~Cholmod() override {
    cholmod_free_dense(&solution_.x, &common_);
    cholmod_free_dense(&solution_.y, &common_);
    cholmod_free_dense(&solution_.e, &common_);
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  void analyze(const BlockPattern& pattern) override {
    scalar_ = to_scalar<int>(pattern);
    cholmod_free_factor(&factor_, &common_);
    cholmod_sparse matrix = view(nullptr);
    factor_ = cholmod_analyze(&matrix, &common_);
    if (factor_ == nullptr) throw std::bad_alloc();
  }

  [[nodiscard]] FactorStatus factorize(std::span<const double> values) override {
    if (!all_finite(values)) return FactorStatus::not_positive_definite;
    cholmod_sparse matrix = view(values.data());
    common_.status = CHOLMOD_OK;
    cholmod_factorize(&matrix, factor_, &common_);
    if (common_.status == CHOLMOD_OUT_OF_MEMORY) return FactorStatus::out_of_memory;
    const bool complete = factor_->minor == factor_->n && common_.status == CHOLMOD_OK;
    return complete ? FactorStatus::ok : FactorStatus::not_positive_definite;
  }

  void solve(std::span<const double> b, std::span<double> x) override {
    cholmod_dense right{};
    right.nrow = right.d = right.nzmax = b.size();
    right.ncol = 1;
    right.x = const_cast<double*>(b.data());  // read only
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(CHOLMOD_A, factor_, &right, nullptr, &solution_.x, nullptr, &solution_.y, &solution_.e,
                   &common_);
    if (solution_.x == nullptr) throw std::bad_alloc();
    const auto* numbers = static_cast<const double*>(solution_.x->x);
    std::copy(numbers, numbers + b.size(), x.begin());
  }

  [[nodiscard]] std::int64_t factor_size() const override {
    if (factor_ == nullptr) return 0;
    return static_cast<std::int64_t>(factor_->is_super ? factor_->xsize : factor_->nzmax);
  }
  [[nodiscard]] std::string description() const override {
    return factor_ != nullptr && factor_->is_super ? "cholmod, supernodal" : "cholmod, simplicial";
  }

 private:
  /// Workspaces of solve(), kept between calls.
  struct Workspace {
    cholmod_dense* x = nullptr;
    cholmod_dense* y = nullptr;
    cholmod_dense* e = nullptr;
  };

  cholmod_sparse view(const double* values) {
    cholmod_sparse matrix{};
    matrix.nrow = matrix.ncol = scalar_.column.size() - 1;
    matrix.nzmax = scalar_.row.size();
    matrix.p = scalar_.column.data();
    matrix.i = scalar_.row.data();
    matrix.x = const_cast<double*>(values);  // read only
    matrix.stype = 1;                        // upper triangle; entries below are ignored
    matrix.itype = CHOLMOD_INT;
    matrix.xtype = values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
    matrix.dtype = CHOLMOD_DOUBLE;
    matrix.sorted = 1;
    matrix.packed = 1;
    return matrix;
  }

  cholmod_common common_{};
  ScalarPattern<int> scalar_;
  cholmod_factor* factor_ = nullptr;
  Workspace solution_;
};

LinearSolverType solver(const char* name, const char* description, int supernodal) {
  return {name, description, "GPL-2.0-or-later (supernodal module), LGPL-2.1 (simplicial)",
          [supernodal](const CheckedOptions&) { return std::make_unique<Cholmod>(supernodal); }};
}

}  // namespace

std::vector<LinearSolverType> cholmod_solvers() {
  return {solver("cholmod", "CHOLMOD, simplicial or supernodal by its flop count", CHOLMOD_AUTO),
          solver("cholmod_simplicial", "CHOLMOD, simplicial", CHOLMOD_SIMPLICIAL),
          solver("cholmod_supernodal", "CHOLMOD, supernodal (dense kernels of BLAS)", CHOLMOD_SUPERNODAL)};
}

}  // namespace waymark::solvers
