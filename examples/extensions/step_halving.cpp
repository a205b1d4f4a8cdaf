// An algorithm: it proposes steps, and the optimiser's loop tries, judges and applies them. This one is
// Gauss-Newton that halves a step for as long as it does not lower chi2.
#include <waymark/core/registry/options.hpp>
#include <waymark/core/registry/plugin.hpp>
#include <waymark/core/system/normal_equations.hpp>

using namespace waymark;

class StepHalving final : public Algorithm {
 public:
  explicit StepHalving(double least_fraction) : least_fraction_(least_fraction) {}

  /// Before each optimisation: one object serves many.
  void reset() override { begin_newton(); }

  /// H d = -g once per linearisation; after a rejection the same direction, half as far.
  [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver, double,
                                       Step& step) override {
    if (fraction_ < least_fraction_) return ProposalStatus::exhausted;
    if (fresh_) {
      if (solver.factorize(equations.hessian()) != FactorStatus::ok) return ProposalStatus::singular;
      newton_ = -equations.gradient();
      const std::span<double> direction(newton_.data(), static_cast<std::size_t>(newton_.size()));
      solver.solve(direction, direction);
      decrement_ = -equations.gradient().dot(newton_);  // g^T H^-1 g
      fresh_ = false;
    }
    step.delta = fraction_ * newton_;
    // -(2 g^T d + d^T H d) for d = t H^-1 (-g): what the quadratic model promises of chi2.
    step.predicted_decrease = decrement_ * fraction_ * (2 - fraction_);
    step.newton_decrement = decrement_;
    step.full_newton = fraction_ == 1;  // only such a step may end the run as converged
    step.kind = step.full_newton ? "newton" : "halved";
    step.control = fraction_;
    return ProposalStatus::ok;
  }

  [[nodiscard]] bool acceptable(double gain_ratio) const override { return gain_ratio > 1e-4; }
  void accepted(const Step&, double) override { begin_newton(); }
  void rejected(const Step&, double) override { fraction_ /= 2; }

 private:
  void begin_newton() {
    fraction_ = 1;
    fresh_ = true;
  }

  double least_fraction_;
  double fraction_ = 1;
  bool fresh_ = true;  // the linearisation is a new one
  double decrement_ = 0;
  Eigen::VectorXd newton_;
};

static void register_types(TypeRegistry& registry) {
  const std::vector<OptionInfo> options = {{"least_fraction", "1e-6", "", OptionRange{1e-12, 1},
                                            "smallest fraction of a Newton step; below it "
                                            "the run has stalled"}};
  registry.add_algorithm({"step_halving", "Gauss-Newton with steps halved until chi2 falls", options,
                          [](const CheckedOptions& checked) {
                            return std::make_unique<StepHalving>(checked.number("least_fraction"));
                          }});
}
WAYMARK_PLUGIN(step_halving, "1.0.0", register_types);
