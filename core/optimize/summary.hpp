/// The report of an optimisation: outcome, message, one record per iteration.
/// It consists of plain values that refer to nothing.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <waymark/core/base/export.hpp>

namespace WAYMARK_EXPORT waymark {

/// Why the loop ended. After the first four the result is a minimum.
enum class Termination {
  converged_decrement,  ///< the Newton decrement is below tolerance on a full step
  converged_gradient,   ///< the gradient is at rounding level
  converged_step,       ///< the full Newton step is below the resolution of the values
  nothing_to_do,        ///< there are no unknowns
  max_iterations,
  stalled,     ///< no acceptable step is left: damping or trust region is exhausted
  singular,    ///< the normal equations are not positive definite
  non_finite,  ///< an error or a Jacobian was not finite
  interrupted  ///< by the cancel token; the best values so far are kept
};

[[nodiscard]] std::string_view to_string(Termination termination);
/// Tells whether the result is a minimum to tolerance.
[[nodiscard]] bool is_converged(Termination termination);

/// One proposed step.
struct IterationRecord {
  int iteration = 0;              ///< 1, 2, ...
  double chi2 = 0;                ///< at the proposed values
  double decrease = 0;            ///< actual decrease of chi2
  double predicted_decrease = 0;  ///< by the quadratic model
  double newton_decrement = 0;    ///< g^T H^-1 g; NaN if not known
  double gradient = 0;            ///< max |g_i| / sqrt(H_ii) before the step
  double step = 0;                ///< largest component of the step, |d_i|
  double control = 0;             ///< damping or trust radius
  std::string kind;               ///< "newton", "damped", "dogleg", "cauchy"
  bool accepted = false;
  double seconds = 0;  ///< since the begin of the optimisation
};

struct Summary {
  Termination termination = Termination::non_finite;
  /// one sentence: why the run ended, with the numbers
  std::string message = "optimize was not called";
  double initial_chi2 = 0;
  double final_chi2 = 0;
  int iterations = 0;  ///< accepted and rejected steps
  std::vector<IterationRecord> records;
  std::vector<std::string> notes;  ///< about the gauge and other facts that the user must know

  std::string algorithm;
  std::string solver;       ///< its name and its own choice
  std::string ordering;     ///< Structure::ordering()
  std::string error_forms;  ///< "EDGE_SE2 (t, theta), ...": the forms of the errors behind chi2
  std::size_t vertices = 0;
  std::size_t edges = 0;
  std::int64_t unknowns = 0;     ///< scalar
  std::int64_t factor_size = 0;  ///< numbers in the factor

  double structure_seconds = 0;  ///< gauge, ordering, pattern, scatter offsets
  double linearize_seconds = 0;
  double solve_seconds = 0;  ///< factorisations and solves
  double total_seconds = 0;

  [[nodiscard]] bool converged() const { return is_converged(termination); }
  /// Returns one line: why the run ended, chi2 before and after, iterations.
  [[nodiscard]] std::string brief() const;
  /// Returns lines with a line break at their ends: why the run ended, chi2,
  /// iterations, size, time.
  [[nodiscard]] std::string full() const;
};

}  // namespace waymark
