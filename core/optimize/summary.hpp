/// What an optimisation did: outcome, message, one record per iteration.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Why the loop ended. The first four leave nothing to be gained.
enum class Termination {
  converged_decrement,  ///< Newton decrement below tolerance on a full step
  converged_gradient,   ///< gradient at rounding level
  converged_step,       ///< full Newton step below the resolution of the values
  nothing_to_do,        ///< no unknowns
  max_iterations,
  stalled,     ///< no acceptable step left: damping or trust region exhausted
  singular,    ///< normal equations not positive definite
  non_finite,  ///< an error or a Jacobian was not finite
  interrupted  ///< by the cancel token; the best values so far are kept
};

[[nodiscard]] std::string_view to_string(Termination termination);
/// Whether the result is a minimum to tolerance.
[[nodiscard]] bool is_converged(Termination termination);

/// One proposed step.
struct IterationRecord {
  int iteration = 0;              ///< 1, 2, ...
  double chi2 = 0;                ///< at the proposed values
  double decrease = 0;            ///< actual decrease of chi2
  double predicted_decrease = 0;  ///< by the quadratic model
  double newton_decrement = 0;    ///< g^T H^-1 g; NaN where not known
  double gradient = 0;            ///< max |g_i| / sqrt(H_ii) before the step
  double step = 0;                ///< largest component of the step, |d_i|
  double control = 0;             ///< damping or trust radius
  std::string kind;               ///< "newton", "damped", "dogleg", "cauchy"
  bool accepted = false;
  double seconds = 0;  ///< since the start of the optimisation
};

struct Summary {
  Termination termination = Termination::non_finite;
  std::string message = "optimize was not called";  ///< one sentence: why it ended, with the numbers
  double initial_chi2 = 0;
  double final_chi2 = 0;
  int iterations = 0;  ///< accepted and rejected steps
  std::vector<IterationRecord> records;
  std::vector<std::string> notes;  ///< gauge and other things the user must know

  std::string algorithm;
  std::string solver;       ///< name and what it chose inside
  std::string ordering;     ///< "natural" or "amd"
  std::string error_forms;  ///< "EDGE_SE2 (t, theta), ...": how the errors behind chi2 are formed
  std::size_t vertices = 0;
  std::size_t edges = 0;
  std::int64_t unknowns = 0;     ///< scalar
  std::int64_t factor_size = 0;  ///< numbers in the factor

  double structure_seconds = 0;  ///< gauge, ordering, pattern, scatter offsets
  double linearize_seconds = 0;
  double solve_seconds = 0;  ///< factorisations and solves
  double total_seconds = 0;

  [[nodiscard]] bool converged() const { return is_converged(termination); }
};

}  // namespace waymark
