#include <waymark/solvers/algorithms/detail/algorithms.hpp>
#include <waymark/solvers/algorithms/detail/newton_step.hpp>

namespace waymark::solvers {
namespace {

/// The plain method: full steps, taken even uphill (it often comes back), never damped.
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
  void rejected(const Step&, double) override { failed_ = true; }  // only where chi2 was not finite

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
