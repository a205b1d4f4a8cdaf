#include <array>
#include <charconv>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/core/optimize/summary.hpp>

namespace waymark {
namespace {

/// Returns a number as text, in any locale.
std::string number_text(double value, std::chars_format format, int precision) {
  std::array<char, 400> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format, precision).ptr;
  return {text.data(), end};
}

std::string chi2_text(double chi2) {
  return number_text(chi2, std::chars_format::general, 10);
}
std::string seconds_text(double seconds) {
  return number_text(seconds, std::chars_format::fixed, 3);
}

std::string full_text(const Summary& s, const std::string& start) {
  std::string text = s.message + "\n";
  text += "chi2        " + chi2_text(s.initial_chi2) + " -> " + chi2_text(s.final_chi2) +
          "   (errors: " + s.error_forms + ")\n";
  text += "iterations  " + std::to_string(s.iterations) + "   " +
          (start.empty() ? "" : "initial guess " + start + ", ") +
          (s.algorithm.empty() ? "" : "algorithm " + s.algorithm + ", ") + "solver " + s.solver +
          ", ordering " + s.ordering + "\n";
  text += "size        " + std::to_string(s.vertices) + " vertices, " + std::to_string(s.edges) + " edges, " +
          std::to_string(s.unknowns) + " unknowns, " + std::to_string(s.factor_size) +
          " numbers in the factor\n";
  text += "time        " + seconds_text(s.total_seconds) + " s (structure " +
          seconds_text(s.structure_seconds) + ", linearise " + seconds_text(s.linearize_seconds) +
          ", solve " + seconds_text(s.solve_seconds) + ")\n";
  return text;
}

}  // namespace

std::string Summary::brief() const {
  return message + "; chi2 " + chi2_text(initial_chi2) + " -> " + chi2_text(final_chi2) + " in " +
         std::to_string(iterations) + (iterations == 1 ? " iteration" : " iterations");
}

std::string Summary::full() const {
  return full_text(*this, "");
}

std::string MultiStartSummary::full() const {
  std::string text = full_text(summary, start);
  if (trials.size() > 1) {
    text += "guesses     " + seconds_text(total_seconds) + " s for " + std::to_string(trials.size()) +
            " initial guesses\n";
  }
  return text;
}

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
