/// Optimising a document from the command line: options, progress, outcome as text and JSON.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/program/terminal/console.hpp>
#include <waymark/tools/program/terminal/exit_codes.hpp>

namespace waymark::program {

/// How a graph is minimised: optimize() itself, or a search around it (robust.hpp).
using Minimizer = std::function<Summary(Graph&, Algorithm&, LinearSolver&, const OptimizerOptions&)>;

/// What `optimize` and `run` let the user choose.
struct OptimizationChoice {
  std::string start = "file";  ///< "auto", "file" or the name of a registered start
  std::string algorithm = "dogleg";
  std::string solver = "auto";       ///< auto: the fastest by measurement (solvers/README.md)
  std::vector<std::string> options;  ///< name=value, for the algorithm
  int threads = 1;
  int max_iterations = 500;
  double tolerance = 1e-6;          ///< decrement_tolerance
  std::string covariance = "none";  ///< none, fixes, all
};

/// Optimises; fills document.covariances as asked. Iterations are shown by the console. A result that is no
/// minimum is said on stderr. @param minimize instead of optimize(). @param work of which it is a part, shown
/// beside the iterations. @throws InputError where the start asked
/// for cannot be made
MultiStartSummary optimize_document(formats::GraphDocument& document, const OptimizationChoice& choice,
                                    const TypeRegistry& registry, const Console& console,
                                    const Minimizer& minimize = {}, const std::string& work = {});

/// Name of the linear solver that was chosen.
[[nodiscard]] std::string solver_name(const OptimizationChoice& choice, const TypeRegistry& registry);

/// Stopping rules and threads that were chosen; an interrupt of the program cancels.
[[nodiscard]] OptimizerOptions optimizer_options(const OptimizationChoice& choice);

/// Whether start, algorithm, its options and solver exist, before anything is read. @throws UsageError
void check_choice(const OptimizationChoice& choice, const TypeRegistry& registry);

/// What the header of an optimised graph says of it.
[[nodiscard]] std::string describe_optimization(const MultiStartSummary& result);

/// What the user is told of vertices that are not joined to the rest.
[[nodiscard]] std::string apart_note(std::size_t vertices);

/// The estimated states of an optimised document: empty without a minimum; where their sigmas cannot be had,
/// that is told.
[[nodiscard]] std::vector<evaluation::StateReport> states_of_minimum(const formats::GraphDocument& document,
                                                                     const Summary& summary,
                                                                     const Console& console);

/// 0, 4 or 130.
[[nodiscard]] ExitCode exit_code(const Summary& summary);

/// "name=value" pairs to Options. @throws UsageError
[[nodiscard]] Options parse_options(const std::vector<std::string>& pairs);

/// A few lines for the terminal.
[[nodiscard]] std::string summary_text(const MultiStartSummary& result);
/// The same and the iterations, for --json.
[[nodiscard]] nlohmann::ordered_json summary_json(const MultiStartSummary& result);

}  // namespace waymark::program
