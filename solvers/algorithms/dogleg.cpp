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

/// The values of the options. The defaults are ours; the other values are those of g2o's dogleg.
struct DoglegSettings {
  bool scaled = true;  ///< the norm is |D d| with D = diag(H)^(1/2); else it is |d|
  /// the radius has its own unit and does not follow the length of the steps
  bool absolute = false;
  /// in units of the length of the first Newton step; as it is if `absolute`
  double initial_radius = 1;
};

/// Powell's dogleg in the norm |D d| with D = diag(H)^(1/2), so that metres and radians, and stiff
/// and soft edges, count alike. The first Gauss-Newton step sets the initial radius, because no
/// absolute number fits every problem. Where truncated steps crawl, full ones are tried, which may climb.
class Dogleg final : public Algorithm {
 public:
  explicit Dogleg(const DoglegSettings& settings) : settings_(settings) {}

  void reset() override {
    radius_ = -1;
    fresh_ = true;
    trial_.reset();
    on_trial_ = is_lost_ = false;
  }

  [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver,
                                       double tolerance, Step& step) override {
    diagonal_ = &equations.diagonal();
    if (std::exchange(is_lost_, false)) return undone();
    if (fresh_ && !compute_newton(equations, solver))
      return trial_.is_on() ? undone() : ProposalStatus::singular;
    fresh_ = false;
    on_trial_ = false;
    if (trial_.is_on() && !may_go_on(tolerance)) return undone();
    if (radius_ < 0) radius_ = settings_.initial_radius * (settings_.absolute ? 1 : newton_norm_);
    if (radius_ < kMinRadius * newton_norm_) return ProposalStatus::exhausted;
    step.control = radius_;
    on_trial_ = trial_.is_on() || (trial_.is_due() && damping_ == 0 && newton_norm_ > radius_);
    if (on_trial_ || (newton_norm_ <= radius_ && damping_ == 0)) {
      step.delta = newton_;
      describe_newton_step(slope_, step);
      length_ = newton_norm_;
    } else {
      truncate(equations, step);
      length_ = scaled_norm(step.delta);
    }
    return ProposalStatus::ok;
  }

  /// A full step may go uphill, on trial.
  [[nodiscard]] bool acceptable(double gain_ratio) const override { return on_trial_ || gain_ratio > 1e-4; }

  // A good step sets the radius to three times its length, a poor one to half of it. An absolute
  // radius may be far longer than the step; a poor step halves it nevertheless.
  void accepted(const Step& step, double gain_ratio) override {
    fresh_ = true;
    if (on_trial_) {
      trial_.took_full_step(gain_ratio * step.predicted_decrease);
      if (!trial_.is_on()) radius_ = std::max(radius_, length_);
      return;
    }
    if (!step.full_newton) trial_.took_short_step(step.predicted_decrease);
    if (gain_ratio < 0.25) {
      radius_ = 0.5 * (settings_.absolute ? radius_ : std::min(radius_, length_));
    } else if (gain_ratio > 0.75) {
      radius_ = std::max(radius_, 3 * length_);
    }
  }

  void rejected(const Step&, double) override {
    if (on_trial_) {
      is_lost_ = true;  // its end was not finite
      return;
    }
    radius_ = settings_.absolute ? 0.5 * radius_ : 0.25 * std::min(radius_, length_);
  }

 private:
  static constexpr double kMinRadius = 1e-18;
  static constexpr double kMaxDamping = 1;

  /// Tells whether a trial may take one more step. At a minimum above the values of before it may not.
  [[nodiscard]] bool may_go_on(double tolerance) const {
    return damping_ == 0 && trial_.steps() < trial_.longest() && -slope_ > tolerance;
  }

  /// Ends a trial in vain: the steps go on as before it.
  ProposalStatus undone() {
    trial_.fail();
    on_trial_ = false;
    fresh_ = true;
    return ProposalStatus::retreat;
  }

  /// The diagonal of H, with a positive floor.
  [[nodiscard]] auto safe_diagonal() const { return diagonal_->array().max(floor_); }
  /// D^2 without a copy: the diagonal or ones.
  [[nodiscard]] auto scale() const {
    return safe_diagonal() * (settings_.scaled ? 1.0 : 0.0) + (settings_.scaled ? 0.0 : 1.0);
  }

  // Computes the end of the path. If H is singular to working precision, the end comes from the
  // least damped matrix that is not.
  bool compute_newton(const NormalEquations& equations, LinearSolver& solver) {
    floor_ = 1e-15 * diagonal_->maxCoeff();
    damping_ = 0;
    extra_.resize(0);
    while (solve_step(equations, solver, extra_, scratch_, newton_, slope_) != FactorStatus::ok) {
      damping_ = damping_ == 0 ? 1e-12 : damping_ * 100;
      if (damping_ > kMaxDamping) return false;
      extra_ = damping_ * safe_diagonal().matrix();
    }
    newton_norm_ = scaled_norm(newton_);
    cauchy_norm_ = -1;
    return true;
  }

  // Computes the bend of the path: the minimum along the scaled gradient. Only a truncated
  // step needs it.
  void compute_cauchy(const NormalEquations& equations) {
    cauchy_ = -(equations.gradient().array() / scale()).matrix();
    equations.multiply(cauchy_, product_);
    const double curvature = cauchy_.dot(product_);
    const double slope = -equations.gradient().dot(cauchy_);
    if (curvature > 0) cauchy_ *= slope / curvature;
    cauchy_norm_ = scaled_norm(cauchy_);
  }

  void truncate(const NormalEquations& equations, Step& step) {
    if (cauchy_norm_ < 0) compute_cauchy(equations);
    if (cauchy_norm_ >= radius_) {
      step.delta = cauchy_ * (radius_ / cauchy_norm_);
      step.kind = "cauchy";
    } else if (newton_norm_ <= radius_) {
      step.delta = newton_;
      step.kind = "damped";
    } else {
      step.delta = cauchy_ + crossing() * (newton_ - cauchy_);
      step.kind = "dogleg";
    }
    equations.multiply(step.delta, product_);
    step.predicted_decrease = -2 * equations.gradient().dot(step.delta) - step.delta.dot(product_);
    step.full_newton = false;
    step.newton_decrement = damping_ == 0 ? -slope_ : std::nan("");
  }

  /// Returns the parameter t at which the second leg leaves the trust region: |D (c + t (n -
  /// c))| = radius.
  [[nodiscard]] double crossing() const {
    const auto leg = (newton_ - cauchy_).array();
    const double a = (scale() * leg.square()).sum();
    const double b = (scale() * cauchy_.array() * leg).sum();
    const double c = radius_ * radius_ - cauchy_norm_ * cauchy_norm_;  // > 0 here
    const double root = std::sqrt(b * b + a * c);
    return b > 0 ? c / (b + root) : (root - b) / a;  // the form without cancellation
  }

  /// Returns |D v|.
  [[nodiscard]] double scaled_norm(const Eigen::VectorXd& v) const {
    return std::sqrt((scale() * v.array().square()).sum());
  }

  DoglegSettings settings_;
  std::vector<double> scratch_;
  const Eigen::VectorXd* diagonal_ = nullptr;  // of the present H
  double floor_ = 0;
  Eigen::VectorXd newton_;
  Eigen::VectorXd cauchy_;
  Eigen::VectorXd extra_;
  Eigen::VectorXd product_;
  double slope_ = 0;  // g^T newton_
  double newton_norm_ = 0;
  double cauchy_norm_ = -1;  // -1: not computed
  double length_ = 0;        // of the last proposal
  double damping_ = 0;
  double radius_ = -1;
  bool fresh_ = true;
  FullStepTrial trial_;
  bool on_trial_ = false;  // the last proposal was a full step of a trial
  bool is_lost_ = false;   // it was not finite
};

}  // namespace

AlgorithmType dogleg() {
  const std::vector<OptionInfo> options = {
      {"scaling", "hessian", "", OptionWords{"hessian", "none"},
       "norm of the trust region: 'hessian' scales by diag(H)^(1/2), 'none' mixes metres and "
       "radians without scaling (g2o)"},
      {"radius", "newton", "", OptionWords{"newton", "absolute"},
       "unit of the trust radius: 'newton', the length of the first Newton step, and the radius "
       "follows the lengths of the steps; 'absolute', the norm itself, and every poor or failed "
       "step halves the radius (g2o)"},
      {"initial_radius", "1", "", OptionRange{1e-6, 1e12},
       "initial trust radius, in the unit of 'radius'; g2o uses 1e4"}};
  return {
      "dogleg", "Powell's dogleg in the norm scaled by diag(H)^(1/2)", options,
      [](const CheckedOptions& checked) {
        return std::make_unique<Dogleg>(DoglegSettings{.scaled = checked.word("scaling") == "hessian",
                                                       .absolute = checked.word("radius") == "absolute",
                                                       .initial_radius = checked.number("initial_radius")});
      }};
}

}  // namespace waymark::solvers
