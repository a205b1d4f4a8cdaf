/// The interface of algorithms. They propose steps; the loop around them (optimizer.hpp) judges and
/// applies the steps.
///
/// An algorithm belongs to the caller that created it. It keeps no arguments after a call of
/// propose(). It serves one optimisation at a time; several algorithms may run at the same
/// time. Order of calls: reset(), then propose(), and after each propose() at most one
/// accepted() or rejected().
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/base/export.hpp>
#include <waymark/core/linear/linear_solver.hpp>
#include <waymark/core/registry/options.hpp>

namespace WAYMARK_EXPORT waymark {

class NormalEquations;  // core/system/normal_equations.hpp

/// A proposed step from the present values.
struct Step {
  Eigen::VectorXd delta;
  /// decrease of chi2 by the quadratic model: -(2 g^T d + d^T H d), > 0
  double predicted_decrease = 0;
  /// Whether this is the undamped, untruncated Gauss-Newton step. Convergence may only be declared
  /// at such a step.
  bool full_newton = false;
  /// g^T H^-1 g: the decrease of chi2 that a full Newton step promises. NaN if there is no
  /// undamped factor.
  double newton_decrement = std::numeric_limits<double>::quiet_NaN();
  std::string kind;    ///< "newton", "damped", "dogleg", "cauchy": for the record
  double control = 0;  ///< damping or trust radius of the step
};

enum class ProposalStatus {
  ok,
  singular,   ///< H could not be factorised, and the algorithm cannot avoid this
  exhausted,  ///< the damping is at its maximum, or the trust region at its minimum
  retreat     ///< the accepted steps that went uphill led nowhere: back to the lowest chi2
};

class Algorithm {
 public:
  virtual ~Algorithm();
  /// Forgets the previous run.
  virtual void reset() = 0;
  /// Proposes a step for the present linearisation. After reject() it is called again with the same
  /// linearisation.
  /// @param tolerance the problem has converged at a decrement below this; damped methods use it to
  /// decide when to try the undamped step
  [[nodiscard]] virtual ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver,
                                               double tolerance, Step& step) = 0;
  /// Tells whether a step with this gain ratio (actual / predicted decrease of chi2) is accepted.
  [[nodiscard]] virtual bool acceptable(double gain_ratio) const = 0;
  virtual void accepted(const Step& step, double gain_ratio) = 0;
  virtual void rejected(const Step& step, double gain_ratio) = 0;
};

/// A registered algorithm.
struct AlgorithmType {
  std::string name;
  std::string description;
  std::vector<OptionInfo> options;
  std::function<std::unique_ptr<Algorithm>(const CheckedOptions&)> make;
};

}  // namespace waymark
