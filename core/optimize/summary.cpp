#include <waymark/core/optimize/summary.hpp>

namespace waymark {

std::string_view to_string(Termination termination) {
  switch (termination) {
    case Termination::converged_decrement:
      return "converged_decrement";
    case Termination::converged_gradient:
      return "converged_gradient";
    case Termination::converged_step:
      return "converged_step";
    case Termination::nothing_to_do:
      return "nothing_to_do";
    case Termination::max_iterations:
      return "max_iterations";
    case Termination::stalled:
      return "stalled";
    case Termination::singular:
      return "singular";
    case Termination::non_finite:
      return "non_finite";
    case Termination::interrupted:
      return "interrupted";
  }
  return "non_finite";
}

bool is_converged(Termination termination) {
  return termination == Termination::converged_decrement || termination == Termination::converged_gradient ||
         termination == Termination::converged_step || termination == Termination::nothing_to_do;
}

}  // namespace waymark
