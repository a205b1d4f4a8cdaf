/// summary.json: how each result of a run was minimised, and what was estimated beside the poses.
/// Written by `waymark run`, read by `waymark compare`; keys: tools/program/README.md.
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

/// A minimisation as JSON: termination, chi2, sizes, times, the starts that were tried, every step.
[[nodiscard]] nlohmann::ordered_json summary_json(const MultiStartSummary& result);

/// One result of a run.
struct RunSummary {
  std::string label;
  const MultiStartSummary& result;
  const std::vector<StateReport>& states;
  const nlohmann::ordered_json& noise;  ///< the parameters that were estimated
};

/// What summary.json holds: minimisation, states and noise by label.
[[nodiscard]] nlohmann::ordered_json run_summary_json(const std::vector<RunSummary>& runs);

/// How the minimisation of a run ended, as summary.json tells it.
struct RunEnding {
  bool converged = false;
  std::string message;
  std::size_t iterations = 0;
  double seconds = kUndefined;
  double initial_chi2 = kUndefined;
  double final_chi2 = kUndefined;
  std::vector<double> chi2;  ///< at the start and after every accepted step; empty: not known
};

/// The same from memory.
[[nodiscard]] RunEnding run_ending(const MultiStartSummary& result);

/// Endings by label. @param file  its name, for messages
/// @throws InputError for text that is no summary.json
[[nodiscard]] std::map<std::string, RunEnding> read_run_summary(std::string_view content,
                                                                const std::string& file);

}  // namespace waymark::evaluation
