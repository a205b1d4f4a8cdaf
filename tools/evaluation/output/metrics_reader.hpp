/// Reads metrics.json, for comparisons with earlier runs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <waymark/tools/evaluation/output/report.hpp>

namespace waymark::evaluation {

struct MetricsDocument {
  ReportHeader header;
  /// The evaluations as they were written. Data that the file does not hold stay empty: `epochs`,
  /// and the truth at each of them.
  std::vector<LabelledEvaluation> evaluations;
};

/// Reads the output of metrics_json. Unknown keys are skipped.
/// @param name name of the file, for errors
/// @throws InputError for a text that is no JSON, has another schema or version, or is incomplete
[[nodiscard]] MetricsDocument read_metrics_json(std::string_view text, const std::string& name);

}  // namespace waymark::evaluation
