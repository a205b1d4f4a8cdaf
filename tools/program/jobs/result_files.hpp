/// The files that `run` and `evaluate` write: trajectory, epochs and report for each fused
/// document, and metrics.json and a comparison for all of them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <waymark/core/drive/measurement_groups.hpp>
#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/drawing/page/page.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/evaluation/document/sparsity.hpp>
#include <waymark/tools/evaluation/output/report.hpp>
#include <waymark/tools/evaluation/output/result_folder.hpp>
#include <waymark/tools/program/jobs/evaluation/map_file.hpp>
#include <waymark/tools/program/terminal/console.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::program {

/// The data of one document.
struct DocumentResult {
  std::string drive;                       ///< name of the drive
  const formats::GraphDocument& document;  ///< at its minimum
  const evaluation::LabelledEvaluation& evaluated;
  const std::vector<TruthPose>& truth;
  const MultiStartSummary* optimization = nullptr;  ///< null: optimised elsewhere
  std::vector<evaluation::StateReport> states{};
  std::optional<evaluation::Sparsity> sparsity{};  ///< from sparsity_for_report
  text::Table noise{};                             ///< the estimated noise; without rows: as stated
  /// Inputs from the logs: heading and text.
  std::vector<std::pair<std::string, std::string>> went_in{};
  std::vector<std::string> files{};               ///< written before, to be linked; paths
  const MapFile* map = nullptr;                   ///< beneath the trajectory; null: none
  std::span<const GroupsOfSource> groups{};       ///< of the measurements in the graph of the document
  std::vector<drawing::Section> more_sections{};  ///< at the end of the report
};

/// Returns the pattern of the matrices for the report. An undetermined graph has residuals, but no
/// normal equations to show: the result is empty, and the document gets a warning. Call it before
/// the provenance of the document is written anywhere.
[[nodiscard]] std::optional<evaluation::Sparsity> sparsity_for_report(formats::GraphDocument& document,
                                                                      const Console& console);

/// What was written of one result.
struct WrittenResult {
  std::vector<std::string> files;  ///< earlier ones first, without figures, because there are many
  std::string page;                ///< the report
  std::string verdict;             ///< the sentences at its top
};

/// Writes trajectory, epochs and report with its figures.
/// @param results number of results in the folder. A single report has the name of the report;
/// several have their labels.
WrittenResult write_result(const DocumentResult& result, const evaluation::ResultFolder& folder,
                           std::size_t results, const Console& console);

/// One of the results in the folder.
struct ComparedResult {
  const evaluation::LabelledEvaluation& evaluated;
  const MultiStartSummary* optimization = nullptr;  ///< null: optimised elsewhere
};

/// Writes the comparison if there are several results, and metrics.json.
/// @param metrics content of metrics.json
/// @return the files
std::vector<std::string> write_overview(const std::vector<ComparedResult>& results,
                                        const evaluation::ReportHeader& header, const std::string& metrics,
                                        const evaluation::ResultFolder& folder, const Console& console);

/// Adds the provenance of a document to a report, with keys "LABEL.KEY" (numbered if a
/// key repeats).
void add_provenance(const formats::GraphDocument& document, const std::string& label,
                    evaluation::ReportHeader& header);

}  // namespace waymark::program
