/// Evaluations as text: the table of the terminal and metrics.json.
#pragma once

#include <map>
#include <span>
#include <string>

#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::evaluation {

/// An evaluation under the name its rows carry ("g1", "g2 without gate").
struct LabelledEvaluation {
  std::string label;
  Evaluation evaluation;
};

/// Where the numbers come from; goes into metrics.json as it is.
struct ReportHeader {
  std::string drive;                              ///< name of the drive
  std::map<std::string, std::string> provenance;  ///< version, options, input hashes
};

/// The table for the terminal: raw GNSS, then every evaluation, against truth; improvement over raw GNSS;
/// along and across track and heading; stated against actual error; autocorrelation; withheld fixes;
/// normalised innovations; counts. A block without data
/// is left out. Raw GNSS rows that differ between the evaluations (another gate, other epochs) are printed
/// for each. Metres and degrees as headed, "-" where a number is not defined. UTF-8 is not needed. Lines end
/// with "\n".
[[nodiscard]] std::string metrics_table(std::span<const LabelledEvaluation> evaluations,
                                        const text::TextLook& look = {});

/// metrics.json, schema "waymark-metrics" version 1 (tools/program/JSON.md): SI units, radians, null
/// where a number is not defined. Numbers read back to the same doubles.
[[nodiscard]] std::string metrics_json(std::span<const LabelledEvaluation> evaluations,
                                       const ReportHeader& header = {});

}  // namespace waymark::evaluation
