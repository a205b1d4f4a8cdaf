#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <waymark/core/registry/options.hpp>
#include <waymark/solvers/algorithms/detail/algorithms.hpp>
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
/// steps crawl: in a curved valley (a long chain that turns about its end) damped steps follow the
/// floor, and full steps leave it and come back further down. So does the first step: damping holds
/// back the soft directions, in which a graph that was chained by its odometry is wrong as a whole, and
/// folds it into a false minimum. A full step that goes uphill is kept
/// on trial, as in the watchdog technique of Chamberlain, Powell, Lemarechal and Pedersen (1982): a
/// few more of them must lead below the chi2 of before, or all are undone.
class LevenbergMarquardt final : public Algorithm {
 public:
  explicit LevenbergMarquardt(const LevenbergMarquardtOptions& options) : options_(options) { reset(); }

  void reset() override {
    damping_ = -1;
    growth_ = 2;
    look_below_ = std::numeric_limits<double>::infinity();
    patience_ = kPatience;
    crawled_ = 0;
    is_first_ = true;
    last_promised_ = std::numeric_limits<double>::infinity();
    end_trial();
  }

  [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver,
                                       double tolerance, Step& step) override {
    set_scale(equations);
    if (trial_steps_ > 0) return propose_on_trial(equations, solver, tolerance, step);
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
      if (is_first_ || crawled_ >= patience_ ||
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
      gained_ += gain_ratio * step.predicted_decrease;
      ++trial_steps_;
      if (gained_ > 0) end_trial();
      crawled_ = 0;
      is_first_ = is_first_ && trial_steps_ > 0;
      return;
    }
    crawled_ = step.predicted_decrease > kCrawl * last_promised_ ? crawled_ + 1 : 0;
    last_promised_ = step.predicted_decrease;
    damping_ *= std::max(1.0 / 3, 1 - std::pow(2 * gain_ratio - 1, 3));
    damping_ = std::max(damping_, kMinDamping);
    growth_ = 2;
  }

  void rejected(const Step& step, double) override {
    if (!step.full_newton) {
      grow();
    } else if (trial_steps_ > 0) {
      trial_steps_ = longest_trial();  // its end was not finite
    } else {
      look_later();
    }
  }

 private:
  static constexpr double kMaxDamping = 1e20;
  static constexpr double kMinDamping = 1e-30;
  static constexpr double kLookAhead = 1e3;  // how far above the tolerance the full step is tried
  static constexpr double kCrawl = 0.5;      // a crawling step promises this share of the one before it
  static constexpr int kPatience = 4;        // crawling steps in a row before a full step is tried
  static constexpr int kLongestPatience = 64;
  static constexpr int kTrialSteps = 4;       // full steps that may lead below the chi2 before them
  static constexpr int kFirstTrialSteps = 8;  // the same from the first values, which may be far off

  /// Proposes the next full step of a trial, or ends the trial where it cannot succeed any more.
  ProposalStatus propose_on_trial(const NormalEquations& equations, LinearSolver& solver, double tolerance,
                                  Step& step) {
    double slope = 0;
    const bool solved = trial_steps_ < longest_trial() &&
                        solve_step(equations, solver, {}, scratch_, step.delta, slope) == FactorStatus::ok;
    if (!solved || -slope <= tolerance) {  // the latter: a minimum above the values of before
      end_trial();
      look_later();
      return ProposalStatus::retreat;
    }
    describe_newton_step(slope, step);
    step.control = 0;
    return ProposalStatus::ok;
  }

  [[nodiscard]] int longest_trial() const { return is_first_ ? kFirstTrialSteps : kTrialSteps; }

  void end_trial() {
    trial_steps_ = 0;
    gained_ = 0;
  }

  /// The full step promised more than the model can predict. It is tried again only after damped
  /// steps promise much less, or have crawled twice as long. Of the first steps nothing is concluded: they
  /// are far from the minimum.
  void look_later() {
    crawled_ = 0;
    if (std::exchange(is_first_, false)) return;
    look_below_ = 0.01 * promised_;
    patience_ = std::min(2 * patience_, kLongestPatience);
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
  double promised_ = 0;       // by the damped step that the full one replaced
  bool is_first_ = true;      // no step was taken yet, or only the trial from the first values
  bool full_ = false;         // the last proposal was the full step
  double last_promised_ = 0;  // by the last damped step that was taken
  int crawled_ = 0;           // damped steps in a row that promised nearly as much as the one before
  int patience_ = kPatience;
  int trial_steps_ = 0;  // full steps since the first one that went uphill
  double gained_ = 0;    // decrease of chi2 by them
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
