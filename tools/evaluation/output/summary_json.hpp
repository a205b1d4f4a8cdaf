/// summary.json: how each result of a run was minimised, and the estimates besides the poses.
/// `waymark run` writes it, and `waymark compare` reads it. tools/program/README.md lists the keys.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// Returns a minimisation as JSON: termination, chi2, sizes, times, the starts that were
/// tried, every step.
[[nodiscard]] nlohmann::ordered_json summary_json(const MultiStartSummary& result);

/// One result of a run.
struct RunSummary {
  std::string label;
  const MultiStartSummary& result;
  const std::vector<StateReport>& states;
  const nlohmann::ordered_json& noise;            ///< the parameters that were estimated
  const std::vector<std::string>& without_delay;  ///< groups of receivers; "": the only one
};

/// Returns the content of summary.json: minimisation, states, noise and receivers without a delay by label.
[[nodiscard]] nlohmann::ordered_json run_summary_json(const std::vector<RunSummary>& runs);

/// How the minimisation of a run ended, as in summary.json.
struct RunEnding {
  bool converged = false;
  std::string message;
  std::size_t iterations = 0;
  double seconds = kUndefined;
  double initial_chi2 = kUndefined;
  double final_chi2 = kUndefined;
  /// at the initial guess and after every accepted step; empty: not known
  std::vector<double> chi2;
};

/// Returns the same from memory.
[[nodiscard]] RunEnding run_ending(const MultiStartSummary& result);

/// Reads the endings by label. @param file its name, for messages
/// @throws InputError for text that is no summary.json
[[nodiscard]] std::map<std::string, RunEnding> read_run_summary(std::string_view content,
                                                                const std::string& file);

}  // namespace waymark::evaluation
