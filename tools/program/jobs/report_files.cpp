#include <filesystem>
#include <optional>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/program/jobs/report_files.hpp>
#include <waymark/tools/report/comparison/comparison_page.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>

namespace waymark::program {

std::string write_drive_report(const DriveReportRequest& request, const std::string& folder,
                               const Console& console) {
  console.progress("writing report " + request.page + ".html");
  const evaluation::GraphResiduals residuals = evaluation::residuals_by_type(request.document.graph);
  std::optional<evaluation::Sparsity> sparsity;
  try {
    sparsity = evaluation::sparsity_of(request.document.graph);
  } catch (const InputError& error) {  // an undetermined graph has residuals, but no normal equations to show
    console.warning("the report has no matrices: " + std::string(error.what()));
  }
  report::ReportedDrive drive{.name = request.drive,
                              .label = request.evaluated.label,
                              .document = request.document,
                              .evaluation = request.evaluated.evaluation,
                              .truth = request.truth,
                              .optimization = request.optimization,
                              .states = &request.states,
                              .residuals = &residuals,
                              .sparsity = sparsity ? &*sparsity : nullptr};
  drive.went_in = request.went_in;
  for (const std::string& file : request.files)
    drive.files.push_back(std::filesystem::path(file).filename().string());
  drawing::Page page = report::drive_page(drive);
  const std::vector<std::string> written = drawing::write_page(page, folder, request.page);
  for (std::size_t i = 1; i < written.size(); ++i) console.detail("written " + written[i]);
  console.end_progress();
  return written.front();
}

std::string write_comparison(const std::vector<ComparedReport>& reports,
                             const evaluation::ReportHeader& header, const std::string& folder,
                             const Console& console) {
  console.progress("writing report.html");
  std::vector<report::ComparedRun> runs;
  for (const ComparedReport& report : reports)
    runs.push_back(report::compared_run(report.evaluated, header, report.optimization));
  drawing::Page page = report::comparison_page(runs, WAYMARK_VERSION);
  drawing::Section alone{"reports", "Each by itself", {}};
  for (const ComparedReport& report : reports)
    alone.blocks.emplace_back(
        drawing::PageLink{report.evaluated.label + ".html", "Report of " + report.evaluated.label});
  page.sections.push_back(std::move(alone));
  const std::vector<std::string> written = drawing::write_page(page, folder, "report");
  for (std::size_t i = 1; i < written.size(); ++i) console.detail("written " + written[i]);
  console.end_progress();
  return written.front();
}

}  // namespace waymark::program
