#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <waymark/core/registry/options.hpp>
#include <waymark/solvers/algorithms/detail/algorithms.hpp>
#include <waymark/solvers/algorithms/detail/full_step_trial.hpp>
#include <waymark/solvers/algorithms/detail/newton_step.hpp>

namespace waymark::solvers {
namespace {

struct LevenbergMarquardtOptions {
  double initial_damping;
  bool scale_by_diagonal;
};

/// Solves (H + mu D) d = -g with D = diag(H) (Marquardt) or the identity. mu follows the rule of
/// Nielsen, "Damping parameter in Marquardt's method" (1999). Near the minimum a damped step does
/// not show convergence, so the undamped one is computed and proposed there, and also where the
/// steps crawl. So is the first step: damping holds back the soft directions, in which a graph that was
/// chained by its odometry is wrong as a whole, and folds it into a false minimum. A full step that goes uphill is kept on trial.
class LevenbergMarquardt final : public Algorithm {
 public:
  explicit LevenbergMarquardt(const LevenbergMarquardtOptions& options) : options_(options) { reset(); }

  void reset() override {
    damping_ = -1;
    growth_ = 2;
    look_below_ = std::numeric_limits<double>::infinity();
    is_first_ = true;
    is_lost_ = false;
    trial_.reset();
  }

  [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver,
                                       double tolerance, Step& step) override {
    set_scale(equations);
    if (trial_.is_on()) return propose_on_trial(equations, solver, tolerance, step);
    if (damping_ < 0)
      damping_ = options_.initial_damping * (options_.scale_by_diagonal ? 1 : scale_of_identity_);
    while (damping_ <= kMaxDamping * scale_of_identity_) {
      extra_ = damping_ * scale_;
      double slope = 0;
      if (solve_step(equations, solver, extra_, scratch_, step.delta, slope) != FactorStatus::ok) {
        grow();
        continue;
      }
      step.predicted_decrease = (extra_.array() * step.delta.array().square()).sum() - slope;
      step.newton_decrement = std::numeric_limits<double>::quiet_NaN();
      step.full_newton = false;
      step.kind = "damped";
      step.control = damping_;
      // The damped step promises little, either because of the damping or because this is the
      // minimum, or the steps crawl. The full step shows which.
      if (is_first_ || trial_.is_due() ||
          step.predicted_decrease <= std::min(kLookAhead * tolerance, look_below_)) {
        promised_ = step.predicted_decrease;
        if (solve_step(equations, solver, {}, scratch_, newton_, slope) == FactorStatus::ok) {
          step.delta.swap(newton_);
          describe_newton_step(slope, step);
        }
      }
      full_ = step.full_newton;
      return ProposalStatus::ok;
    }
    return ProposalStatus::exhausted;
  }

  /// A full step may go uphill, on trial.
  [[nodiscard]] bool acceptable(double gain_ratio) const override { return full_ || gain_ratio > 1e-4; }

  void accepted(const Step& step, double gain_ratio) override {
    if (step.full_newton) {
      trial_.took_full_step(gain_ratio * step.predicted_decrease);
      is_first_ = is_first_ && trial_.is_on();
      return;
    }
    trial_.took_short_step(step.predicted_decrease);
    damping_ *= std::max(1.0 / 3, 1 - std::pow(2 * gain_ratio - 1, 3));
    damping_ = std::max(damping_, kMinDamping);
    growth_ = 2;
  }

  void rejected(const Step& step, double) override {
    if (!step.full_newton) {
      grow();
    } else if (trial_.is_on()) {
      is_lost_ = true;  // its end was not finite
    } else {
      look_later();
    }
  }

 private:
  static constexpr double kMaxDamping = 1e20;
  static constexpr double kMinDamping = 1e-30;
  static constexpr double kLookAhead = 1e3;   // how far above the tolerance the full step is tried
  static constexpr int kFirstTrialSteps = 8;  // full steps from the first values, which may be far off

  /// Proposes the next full step of a trial, or ends the trial where it cannot succeed any more.
  ProposalStatus propose_on_trial(const NormalEquations& equations, LinearSolver& solver, double tolerance,
                                  Step& step) {
    double slope = 0;
    const int longest = is_first_ ? kFirstTrialSteps : trial_.longest();
    const bool solved = !std::exchange(is_lost_, false) && trial_.steps() < longest &&
                        solve_step(equations, solver, {}, scratch_, step.delta, slope) == FactorStatus::ok;
    if (!solved || -slope <= tolerance) {  // the latter: a minimum above the values of before
      look_later();
      return ProposalStatus::retreat;
    }
    describe_newton_step(slope, step);
    step.control = 0;
    return ProposalStatus::ok;
  }

  /// The full step promised more than the model can predict. It is tried again only after damped
  /// steps promise much less, or have crawled twice as long. Of the first steps nothing is concluded: they
  /// are far from the minimum.
  void look_later() {
    if (std::exchange(is_first_, false)) {
      trial_.end();
      return;
    }
    trial_.fail();
    look_below_ = 0.01 * promised_;
  }

  void set_scale(const NormalEquations& equations) {
    const Eigen::VectorXd& diagonal = equations.diagonal();
    const double largest = diagonal.maxCoeff();
    if (options_.scale_by_diagonal) {
      scale_of_identity_ = 1;
      // an unknown without information must be damped too
      scale_ = diagonal.cwiseMax(1e-15 * largest);
    } else {
      scale_of_identity_ = largest;
      scale_.setOnes(diagonal.size());
    }
  }

  void grow() {
    damping_ *= growth_;
    growth_ *= 2;
  }

  LevenbergMarquardtOptions options_;
  std::vector<double> scratch_;
  Eigen::VectorXd scale_;
  Eigen::VectorXd extra_;
  Eigen::VectorXd newton_;
  double damping_ = -1;
  double growth_ = 2;
  double scale_of_identity_ = 1;
  // a damped step that promises less than this is compared with the full one
  double look_below_ = 0;
  double promised_ = 0;   // by the damped step that the full one replaced
  bool is_first_ = true;  // no step was taken yet, or only the trial from the first values
  bool full_ = false;     // the last proposal was the full step
  bool is_lost_ = false;  // the last step on trial was not finite
  FullStepTrial trial_;
};

}  // namespace

AlgorithmType levenberg_marquardt() {
  const std::vector<OptionInfo> options = {
      {"initial_damping", "1e-8", "", OptionRange{1e-12, 1e6},
       "initial damping factor, relative to the scaling"},
      {"scaling", "marquardt", "", OptionWords{"marquardt", "identity"},
       "matrix that the damping factor multiplies: 'marquardt', diag(H); 'identity', the identity matrix"}};
  return {"levenberg_marquardt", "damped Gauss-Newton steps, damping by Nielsen's rule", options,
          [](const CheckedOptions& checked) {
            return std::make_unique<LevenbergMarquardt>(LevenbergMarquardtOptions{
                checked.number("initial_damping"), checked.word("scaling") == "marquardt"});
          }};
}

}  // namespace waymark::solvers
