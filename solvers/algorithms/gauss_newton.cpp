#include <waymark/solvers/algorithms/detail/algorithms.hpp>
#include <waymark/solvers/algorithms/detail/newton_step.hpp>

namespace waymark::solvers {
namespace {

/// The plain method. It takes full steps without damping. It takes them even if chi2 rises, because
/// chi2 often falls again.
class GaussNewton final : public Algorithm {
 public:
  void reset() override { failed_ = false; }

  [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver, double,
                                       Step& step) override {
    if (failed_) return ProposalStatus::exhausted;
    double slope = 0;
    if (solve_step(equations, solver, {}, scratch_, step.delta, slope) != FactorStatus::ok)
      return ProposalStatus::singular;
    describe_newton_step(slope, step);
    step.control = 0;
    return ProposalStatus::ok;
  }

  [[nodiscard]] bool acceptable(double) const override { return true; }
  void accepted(const Step&, double) override {}
  // called only if chi2 was not finite
  void rejected(const Step&, double) override { failed_ = true; }

 private:
  std::vector<double> scratch_;
  bool failed_ = false;
};

}  // namespace

AlgorithmType gauss_newton() {
  return {"gauss_newton", "full Gauss-Newton steps", {}, [](const CheckedOptions&) {
            return std::make_unique<GaussNewton>();
          }};
}

}  // namespace waymark::solvers
