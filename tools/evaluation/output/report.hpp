/// Evaluations as text: the table for the terminal, and metrics.json.
#pragma once

#include <map>
#include <span>
#include <string>

#include <waymark/tools/evaluation/evaluation.hpp>
#include <waymark/tools/text/table.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::evaluation {

/// An evaluation and the name of its rows ("g1", "g2 without gate").
struct LabelledEvaluation {
  std::string label;
  Evaluation evaluation;
};

/// The origin of the numbers. It is copied into metrics.json.
struct ReportHeader {
  std::string drive;                              ///< name of the drive
  std::map<std::string, std::string> provenance;  ///< version, options, input hashes
};

/// Adds the errors of the height and in space as a row. A note says what to do if only the truth lacks
/// heights; without a height state nothing is added.
void add_space_row(const std::string& label, const TruthEvaluation& truth, text::Table& table);

/// Returns the table for the terminal. Raw GNSS comes first, then every evaluation. The blocks are:
/// against truth; improvement over raw GNSS; in space; along and across track and heading; stated against
/// actual error; autocorrelation; withheld fixes; normalised innovations; counts. Blocks without
/// data are left out. If raw GNSS rows differ between evaluations (another gate, other epochs),
/// each is printed. Units are metres and degrees as in the headings; "-" is an undefined number.
/// The text is ASCII. Lines end with "\n".
[[nodiscard]] std::string metrics_table(std::span<const LabelledEvaluation> evaluations,
                                        const text::TextLook& look = {});

/// Returns metrics.json, schema "waymark-metrics" version 1 (tools/program/JSON.md): SI units,
/// radians, null for undefined numbers. Numbers read back to the same doubles.
[[nodiscard]] std::string metrics_json(std::span<const LabelledEvaluation> evaluations,
                                       const ReportHeader& header = {});

}  // namespace waymark::evaluation
