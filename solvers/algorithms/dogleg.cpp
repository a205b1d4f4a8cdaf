#include <algorithm>
#include <cmath>
#include <vector>

#include <waymark/core/registry/options.hpp>
#include <waymark/solvers/algorithms/detail/algorithms.hpp>
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
/// absolute number fits every problem.
class Dogleg final : public Algorithm {
 public:
  explicit Dogleg(const DoglegSettings& settings) : settings_(settings) {}

  void reset() override {
    radius_ = -1;
    fresh_ = true;
  }

  [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver, double,
                                       Step& step) override {
    diagonal_ = &equations.diagonal();
    if (fresh_ && !compute_newton(equations, solver)) return ProposalStatus::singular;
    fresh_ = false;
    if (radius_ < 0) radius_ = settings_.initial_radius * (settings_.absolute ? 1 : newton_norm_);
    if (radius_ < kMinRadius * newton_norm_) return ProposalStatus::exhausted;
    step.control = radius_;
    if (newton_norm_ <= radius_ && damping_ == 0) {
      step.delta = newton_;
      describe_newton_step(slope_, step);
      length_ = newton_norm_;
    } else {
      truncate(equations, step);
      length_ = scaled_norm(step.delta);
    }
    return ProposalStatus::ok;
  }

  [[nodiscard]] bool acceptable(double gain_ratio) const override { return gain_ratio > 1e-4; }

  // A good step sets the radius to three times its length, a poor one to half of it. An absolute
  // radius may be far longer than the step; a poor step halves it nevertheless.
  void accepted(const Step&, double gain_ratio) override {
    if (gain_ratio < 0.25) {
      radius_ = 0.5 * (settings_.absolute ? radius_ : std::min(radius_, length_));
    } else if (gain_ratio > 0.75) {
      radius_ = std::max(radius_, 3 * length_);
    }
    fresh_ = true;
  }

  void rejected(const Step&, double) override {
    radius_ = settings_.absolute ? 0.5 * radius_ : 0.25 * std::min(radius_, length_);
  }

 private:
  static constexpr double kMinRadius = 1e-18;
  static constexpr double kMaxDamping = 1;

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
