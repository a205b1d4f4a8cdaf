/// The interface of algorithms: they propose steps; the loop around them (optimizer.hpp) judges and applies.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/linear/linear_solver.hpp>
#include <waymark/core/registry/options.hpp>

namespace waymark {

class NormalEquations;  // core/system/normal_equations.hpp

/// A proposed step from the present values.
struct Step {
  Eigen::VectorXd delta;
  double predicted_decrease = 0;  ///< of chi2 by the quadratic model: -(2 g^T d + d^T H d), > 0
  /// The undamped, untruncated Gauss-Newton step. Only on such a step may convergence be declared.
  bool full_newton = false;
  /// g^T H^-1 g: the decrease of chi2 a full Newton step promises; NaN where no undamped factor is at hand.
  double newton_decrement = std::numeric_limits<double>::quiet_NaN();
  std::string kind;    ///< "newton", "damped", "dogleg", "cauchy": for the record
  double control = 0;  ///< damping or trust radius in force
};

enum class ProposalStatus {
  ok,
  singular,  ///< H could not be factorised and the algorithm has no way around it
  exhausted  ///< damping at its maximum or trust region at its minimum
};

class Algorithm {
 public:
  virtual ~Algorithm();
  /// Forgets everything of an earlier run.
  virtual void reset() = 0;
  /// Proposes a step for the present linearisation; called again with the same one after reject().
  /// @param tolerance the decrement below which the problem counts as converged (for damped methods: when to
  /// look at
  ///                  the undamped step)
  [[nodiscard]] virtual ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver,
                                               double tolerance, Step& step) = 0;
  /// Whether a step of this gain ratio (actual / predicted decrease of chi2) is to be taken.
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
