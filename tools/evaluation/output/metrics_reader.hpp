/// metrics.json read back, for comparisons of runs that were made at other times.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <waymark/tools/evaluation/output/report.hpp>

namespace waymark::evaluation {

struct MetricsDocument {
  ReportHeader header;
  /// As they were written; what is not in the file is empty: `epochs` and what the truth is at each of them.
  std::vector<LabelledEvaluation> evaluations;
};

/// Reads what metrics_json wrote; keys that it does not know are passed over.
/// @param name  of the file, for errors
/// @throws InputError for a text that is no JSON, of another schema or version, or lacks something
[[nodiscard]] MetricsDocument read_metrics_json(std::string_view text, const std::string& name);

}  // namespace waymark::evaluation
