/// The reports that commands write beside their results.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <waymark/core/optimize/multi_start.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/evaluation/document/estimated_states.hpp>
#include <waymark/tools/evaluation/output/report.hpp>
#include <waymark/tools/program/terminal/console.hpp>

namespace waymark::program {

/// What a drive report is written of.
struct DriveReportRequest {
  std::string drive;                       ///< name of the drive
  std::string page;                        ///< name of the file, without ending
  const formats::GraphDocument& document;  ///< at its minimum
  const evaluation::LabelledEvaluation& evaluated;
  const std::vector<TruthPose>& truth;
  const MultiStartSummary* optimization = nullptr;  ///< null: optimised elsewhere
  std::vector<evaluation::StateReport> states{};
  /// Of the logs, heading and text.
  std::vector<std::pair<std::string, std::string>> went_in{};
  std::vector<std::string> files{};  ///< to be linked; paths
};

/// One of several drive reports that a comparison stands over.
struct ComparedReport {
  const evaluation::LabelledEvaluation& evaluated;
  const MultiStartSummary* optimization = nullptr;  ///< null: optimised elsewhere
};

/// Writes FOLDER/report.html, which compares what PAGE.html of each label tells alone. Returns its name.
std::string write_comparison(const std::vector<ComparedReport>& reports,
                             const evaluation::ReportHeader& header, const std::string& folder,
                             const Console& console);

/// Writes FOLDER/PAGE.html and its figures. Returns the page's name: the figures are too many to be told.
std::string write_drive_report(const DriveReportRequest& request, const std::string& folder,
                               const Console& console);

}  // namespace waymark::program
