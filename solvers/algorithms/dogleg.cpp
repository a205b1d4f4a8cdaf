#include <algorithm>
#include <cmath>
#include <vector>

#include <waymark/core/options.hpp>
#include <waymark/solvers/algorithms/algorithms.hpp>
#include <waymark/solvers/algorithms/newton_step.hpp>

namespace waymark {
namespace {

/// Powell's dogleg in the norm |D d| with D = diag(H)^(1/2), so that metres and radians, stiff and soft edges
/// count alike. The radius starts from the first Gauss-Newton step: no absolute number can fit every problem.
class Dogleg final : public Algorithm {
 public:
  explicit Dogleg(double initial_radius) : initial_radius_(initial_radius) {}

  void reset() override {
    radius_ = -1;
    fresh_ = true;
  }

  [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver, double,
                                       Step& step) override {
    if (fresh_ && !compute_legs(equations, solver)) return ProposalStatus::singular;
    fresh_ = false;
    if (radius_ < 0) radius_ = initial_radius_ * newton_norm_;
    if (radius_ < kMinRadius * newton_norm_) return ProposalStatus::exhausted;
    step.control = radius_;
    if (newton_norm_ <= radius_ && damping_ == 0) {
      take_newton_step(equations, newton_, step);
    } else {
      truncate(equations, step);
    }
    return ProposalStatus::ok;
  }

  [[nodiscard]] bool acceptable(double gain_ratio) const override { return gain_ratio > 1e-4; }

  // A good step triples the radius it reached, a poor one halves it.
  void accepted(const Step& step, double gain_ratio) override {
    const double length = (scale_.array() * step.delta.array()).matrix().norm();
    if (gain_ratio < 0.25) {
      radius_ = 0.5 * std::min(radius_, length);
    } else if (gain_ratio > 0.75) {
      radius_ = std::max(radius_, 3 * length);
    }
    fresh_ = true;
  }

  void rejected(const Step& step, double) override {
    const double length = (scale_.array() * step.delta.array()).matrix().norm();
    radius_ = 0.25 * std::min(radius_, length);
  }

 private:
  static constexpr double kMinRadius = 1e-18;
  static constexpr double kMaxDamping = 1;

  // Both ends of the path: the minimum along the scaled gradient and the Newton step. Where H is singular to
  // working precision the Newton leg comes from the least damped matrix that is not.
  bool compute_legs(const NormalEquations& equations, LinearSolver& solver) {
    const Eigen::VectorXd diagonal = equations.diagonal();
    const Eigen::VectorXd floored = diagonal.cwiseMax(1e-15 * diagonal.maxCoeff());
    scale_ = floored.cwiseSqrt();
    damping_ = 0;
    while (!solve_step(equations, solver,
                       damping_ > 0 ? Eigen::VectorXd(damping_ * floored) : Eigen::VectorXd(), scratch_,
                       newton_)) {
      damping_ = damping_ == 0 ? 1e-12 : damping_ * 100;
      if (damping_ > kMaxDamping) return false;
    }
    newton_norm_ = (scale_.array() * newton_.array()).matrix().norm();
    const Eigen::VectorXd descent = -(equations.gradient().array() / floored.array()).matrix();
    const double curvature = descent.dot(equations.multiply(descent));
    const double slope = -equations.gradient().dot(descent);
    cauchy_ = curvature > 0 ? Eigen::VectorXd(descent * (slope / curvature)) : descent;
    cauchy_norm_ = (scale_.array() * cauchy_.array()).matrix().norm();
    return true;
  }

  void truncate(const NormalEquations& equations, Step& step) {
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
    step.predicted_decrease =
        -2 * equations.gradient().dot(step.delta) - step.delta.dot(equations.multiply(step.delta));
    step.full_newton = false;
    step.newton_decrement = damping_ == 0 ? -equations.gradient().dot(newton_) : std::nan("");
  }

  /// Where the second leg leaves the trust region: |D (c + t (n - c))| = radius.
  [[nodiscard]] double crossing() const {
    const Eigen::VectorXd start = scale_.array() * cauchy_.array();
    const Eigen::VectorXd leg = scale_.array() * (newton_ - cauchy_).array();
    const double a = leg.squaredNorm();
    const double b = start.dot(leg);
    const double c = radius_ * radius_ - start.squaredNorm();  // > 0 here
    const double root = std::sqrt(b * b + a * c);
    return b > 0 ? c / (b + root) : (root - b) / a;  // the form without cancellation
  }

  double initial_radius_;
  std::vector<double> scratch_;
  Eigen::VectorXd scale_;
  Eigen::VectorXd newton_;
  Eigen::VectorXd cauchy_;
  double newton_norm_ = 0;
  double cauchy_norm_ = 0;
  double damping_ = 0;
  double radius_ = -1;
  bool fresh_ = true;
};

}  // namespace

AlgorithmType dogleg() {
  const std::vector<OptionInfo> options = {
      {"initial_radius", "1", "",
       "first trust radius over the length of the first Newton step; in [1e-6, 1e6]"}};
  return {
      "dogleg", "Powell's dogleg in the norm scaled by diag(H)^(1/2)", options,
      [options](const Options& given) {
        check_option_names("dogleg", given, options);
        return std::make_unique<Dogleg>(number_option("dogleg", given, options, "initial_radius", 1e-6, 1e6));
      }};
}

}  // namespace waymark
