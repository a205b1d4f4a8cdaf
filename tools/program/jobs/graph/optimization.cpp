#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/base/suggest.hpp>
#include <waymark/tools/program/jobs/graph/covariance.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/terminal/iteration_table.hpp>
#include <waymark/tools/text/json_number.hpp>

namespace waymark::program {
namespace {

constexpr std::string_view kAutoStart = "auto";
constexpr std::string_view kFileStart = "file";

void check_start(const std::string& start, const TypeRegistry& registry) {
  std::vector<std::string_view> names = {kAutoStart, kFileStart};
  for (const auto& [type, origin] : registry.starts()) names.push_back(type.name);
  if (std::find(names.begin(), names.end(), start) != names.end()) return;
  throw UsageError("unknown start '" + start + "'" + suggestion(start, names));
}

/// From the start that was asked for. A search for outliers begins at the values at hand: chi2 over all edges
/// says nothing about a start where some of them are false.
MultiStartSummary optimize_from(const std::string& start, Graph& graph, const TypeRegistry& registry,
                                Algorithm& algorithm, LinearSolver& solver, const OptimizerOptions& options,
                                const Minimizer& minimize) {
  if (start == kAutoStart && !minimize) {
    return optimize_from_best_start(graph, registry.starts(), algorithm, solver, options);
  }
  InitialValues made;
  if (start != kFileStart && start != kAutoStart) {
    made = registry.make_start(start, graph);
    if (made.values.empty()) throw InputError("start " + start + " cannot be made: " + made.note);
    graph.set_values(std::move(made.values));
  }
  MultiStartSummary result;
  result.summary =
      minimize ? minimize(graph, algorithm, solver, options) : optimize(graph, algorithm, solver, options);
  result.start = start == kAutoStart ? kFileStart : start;
  result.total_seconds = result.summary.total_seconds;
  if (made.apart > 0) result.summary.notes.push_back(apart_note(made.apart));
  return result;
}

}  // namespace

Options parse_options(const std::vector<std::string>& pairs) {
  Options options;
  for (const std::string& pair : pairs) {
    const auto equals = pair.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("expected NAME=VALUE, got '" + pair + "'");
    }
    options[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  return options;
}

// The backends are registered fastest first: on every graph measured the first was the fastest.
std::string solver_name(const OptimizationChoice& choice, const TypeRegistry& registry) {
  return choice.solver == "auto" ? registry.linear_solvers().front().type.name : choice.solver;
}

OptimizerOptions optimizer_options(const OptimizationChoice& choice) {
  OptimizerOptions options;
  options.max_iterations = choice.max_iterations;
  options.decrement_tolerance = choice.tolerance;
  options.threads = choice.threads;
  options.cancel = &interrupted;
  return options;
}

void check_choice(const OptimizationChoice& choice, const TypeRegistry& registry) {
  (void)registry.make_algorithm(choice.algorithm, parse_options(choice.options));
  (void)registry.make_linear_solver(solver_name(choice, registry));
  check_start(choice.start, registry);
}

MultiStartSummary optimize_document(formats::GraphDocument& document, const OptimizationChoice& choice,
                                    const TypeRegistry& registry, const Console& console,
                                    const Minimizer& minimize, const std::string& work) {
  const auto algorithm = registry.make_algorithm(choice.algorithm, parse_options(choice.options));
  const auto solver = registry.make_linear_solver(solver_name(choice, registry));
  OptimizerOptions options = optimizer_options(choice);
  IterationTable iterations(console, work);
  options.observer = [&](const IterationRecord& record) { iterations.add(record); };
  MultiStartSummary result =
      optimize_from(choice.start, document.graph, registry, *algorithm, *solver, options, minimize);
  Summary& summary = result.summary;
  summary.algorithm = choice.algorithm;
  console.end_progress();
  for (const std::string& note : summary.notes) console.note(note);
  if (!summary.converged()) {
    console.warning(
        "no minimum was reached: " + summary.message +
        (summary.termination == Termination::interrupted ? "; the best state so far is kept" : ""));
  }
  document.covariances.clear();
  if (summary.converged()) {
    if (choice.covariance != "none") console.progress(work + (work.empty() ? "" : "  ") + "covariances");
    add_covariances(document, choice.covariance);
    console.end_progress();
  }
  return result;
}

std::vector<evaluation::StateReport> states_of_minimum(const formats::GraphDocument& document,
                                                       const Summary& summary, const Console& console) {
  if (!summary.converged()) return {};
  try {
    return evaluation::report_states(document);
  } catch (const InputError& error) {
    console.warning("the estimated states have no sigmas: " + std::string(error.what()));
    return {};
  }
}

std::string describe_optimization(const MultiStartSummary& result) {
  const Summary& summary = result.summary;
  return fmt::format("waymark {} algorithm {} start {} solver {} {}", WAYMARK_VERSION, summary.algorithm,
                     result.start, summary.solver, to_string(summary.termination));
}

std::string apart_note(std::size_t vertices) {
  return fmt::format(
      "{} vertices are not joined to the first one by relative edges; each part begins at its own "
      "first vertex",
      vertices);
}

ExitCode exit_code(const Summary& summary) {
  if (summary.termination == Termination::interrupted) return kInterrupted;
  return summary.converged() ? kSuccess : kNotConverged;
}

std::string summary_text(const MultiStartSummary& result) {
  const Summary& s = result.summary;
  std::string text;
  text += fmt::format("{}\n", s.message);
  text += fmt::format("chi2        {:.10g} -> {:.10g}   (errors: {})\n", s.initial_chi2, s.final_chi2,
                      s.error_forms);
  text += fmt::format("iterations  {}   start {}, algorithm {}, solver {}, ordering {}\n", s.iterations,
                      result.start, s.algorithm, s.solver, s.ordering);
  text += fmt::format("size        {} vertices, {} edges, {} unknowns, {} numbers in the factor\n",
                      s.vertices, s.edges, s.unknowns, s.factor_size);
  text += fmt::format("time        {:.3f} s (structure {:.3f}, linearise {:.3f}, solve {:.3f})\n",
                      s.total_seconds, s.structure_seconds, s.linearize_seconds, s.solve_seconds);
  if (result.trials.size() > 1) {
    text += fmt::format("all starts  {:.3f} s for {} of them\n", result.total_seconds, result.trials.size());
  }
  return text;
}

nlohmann::ordered_json summary_json(const MultiStartSummary& result) {
  const Summary& s = result.summary;
  nlohmann::ordered_json json = {{"termination", to_string(s.termination)},
                                 {"converged", s.converged()},
                                 {"message", s.message},
                                 {"initial_chi2", text::number_or_null(s.initial_chi2)},
                                 {"final_chi2", text::number_or_null(s.final_chi2)},
                                 {"error_forms", s.error_forms},
                                 {"iterations", s.iterations},
                                 {"start", result.start},
                                 {"algorithm", s.algorithm},
                                 {"solver", s.solver},
                                 {"ordering", s.ordering},
                                 {"vertices", s.vertices},
                                 {"edges", s.edges},
                                 {"unknowns", s.unknowns},
                                 {"factor_size", s.factor_size},
                                 {"structure_seconds", s.structure_seconds},
                                 {"linearize_seconds", s.linearize_seconds},
                                 {"solve_seconds", s.solve_seconds},
                                 {"total_seconds", s.total_seconds},
                                 {"notes", s.notes}};
  json["starts"] = nlohmann::ordered_json::array();
  for (const StartTrial& trial : result.trials) {
    json["starts"].push_back({{"start", trial.start},
                              {"termination", to_string(trial.termination)},
                              {"initial_chi2", text::number_or_null(trial.initial_chi2)},
                              {"final_chi2", text::number_or_null(trial.final_chi2)},
                              {"iterations", trial.iterations},
                              {"seconds", trial.seconds}});
  }
  json["records"] = nlohmann::ordered_json::array();
  for (const IterationRecord& r : s.records) {
    json["records"].push_back({{"iteration", r.iteration},
                               {"kind", r.kind},
                               {"accepted", r.accepted},
                               {"chi2", text::number_or_null(r.chi2)},
                               {"decrease", text::number_or_null(r.decrease)},
                               {"predicted_decrease", text::number_or_null(r.predicted_decrease)},
                               {"newton_decrement", text::number_or_null(r.newton_decrement)},
                               {"gradient", text::number_or_null(r.gradient)},
                               {"step", text::number_or_null(r.step)},
                               {"control", text::number_or_null(r.control)},
                               {"seconds", r.seconds}});
  }
  return json;
}

}  // namespace waymark::program
