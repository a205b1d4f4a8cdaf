#include <filesystem>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>
#include <waymark/tools/drive/left_out/outages.hpp>
#include <waymark/tools/evaluation/output/epochs_csv.hpp>
#include <waymark/tools/program/jobs/graph/optimization.hpp>
#include <waymark/tools/program/jobs/result_files.hpp>
#include <waymark/tools/program/jobs/trajectory_files.hpp>
#include <waymark/tools/report/comparison/comparison_page.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>
#include <waymark/version.hpp>

namespace waymark::program {
namespace {

/// Writes the report and its figures. Returns the name of the page and its verdict.
std::pair<std::string, std::string> write_report(const DocumentResult& request,
                                                 const std::vector<std::string>& files,
                                                 const evaluation::ResultFolder& folder,
                                                 const std::string& page_name, const Console& console) {
  console.progress("writing report " + page_name + ".html");
  const evaluation::GraphResiduals residuals = evaluation::residuals_by_type(request.document.graph);
  report::ReportedDrive drive{.name = request.drive,
                              .label = request.evaluated.label,
                              .document = request.document,
                              .evaluation = request.evaluated.evaluation,
                              .truth = request.truth,
                              .optimization = request.optimization,
                              .states = &request.states,
                              .residuals = &residuals,
                              .sparsity = request.sparsity ? &*request.sparsity : nullptr};
  const auto groups = evaluation::residuals_by_group(request.document.graph, request.groups);
  drive.groups = groups;
  drive.noise = request.noise;
  drive.went_in = request.went_in;
  drive.dead_reckoned = drive::dead_reckoned(request.document);
  if (request.map != nullptr) drive.ground = ground_of(*request.map, request.document);
  for (const std::string& file : files)
    drive.files.push_back(std::filesystem::path(file).filename().string());
  drawing::Page page = report::drive_page(drive);
  page.sections.insert(page.sections.end(), request.more_sections.begin(), request.more_sections.end());
  const std::vector<std::string> written = drawing::write_page(page, folder.path(), page_name);
  for (std::size_t i = 1; i < written.size(); ++i) console.detail("written " + written[i]);
  console.end_progress();
  return {written.front(), page.summary};
}

std::string write_comparison(const std::vector<ComparedResult>& results,
                             const evaluation::ReportHeader& header, const evaluation::ResultFolder& folder,
                             const Console& console) {
  console.progress("writing report.html");
  std::vector<report::ComparedRun> runs;
  for (const ComparedResult& result : results)
    runs.push_back(report::compared_run(result.evaluated, header, result.optimization));
  drawing::Page page = report::comparison_page(runs, WAYMARK_VERSION);
  drawing::Section sources{"sources", "Sources", {}};
  for (const ComparedResult& result : results) {
    const auto& [label, evaluation] = result.evaluated;
    if (!evaluation.sources.sources.empty())
      sources.blocks.emplace_back(evaluation::source_table(evaluation.sources, label));
  }
  if (!sources.blocks.empty()) page.sections.push_back(std::move(sources));
  drawing::Section alone{"reports", "One report per modeling", {}};
  for (const ComparedResult& result : results)
    alone.blocks.emplace_back(
        drawing::PageLink{result.evaluated.label + ".html", "Report of " + result.evaluated.label});
  page.sections.push_back(std::move(alone));
  const std::vector<std::string> written = drawing::write_page(page, folder.path(), folder.kReport);
  for (std::size_t i = 1; i < written.size(); ++i) console.detail("written " + written[i]);
  console.end_progress();
  return written.front();
}

}  // namespace

std::optional<evaluation::Sparsity> sparsity_for_report(formats::GraphDocument& document,
                                                        const Console& console) {
  console.progress("matrices of the report");
  try {
    return evaluation::sparsity_of(document.graph);
  } catch (const InputError& error) {
    warn("the report has no matrices: " + std::string(error.what()), document, console);
    return std::nullopt;
  }
}

WrittenResult write_result(const DocumentResult& result, const evaluation::ResultFolder& folder,
                           std::size_t results, const Console& console) {
  const std::string& label = result.evaluated.label;
  std::vector<std::string> files = result.files;
  for (const std::string& file : write_trajectories(result.document, folder, label)) files.push_back(file);
  files.push_back(folder.epochs(label));
  formats::write_file_atomically(files.back(), evaluation::epochs_csv(result.evaluated.evaluation.epochs));
  auto [page, verdict] = write_report(result, files, folder, folder.page_name(label, results), console);
  return {.files = std::move(files), .page = std::move(page), .verdict = std::move(verdict)};
}

std::vector<std::string> write_overview(const std::vector<ComparedResult>& results,
                                        const evaluation::ReportHeader& header, const std::string& metrics,
                                        const evaluation::ResultFolder& folder, const Console& console) {
  std::vector<std::string> files;
  if (results.size() > 1) files.push_back(write_comparison(results, header, folder, console));
  files.push_back(folder.metrics());
  formats::write_file_atomically(files.back(), metrics);
  return files;
}

void add_provenance(const formats::GraphDocument& document, const std::string& label,
                    evaluation::ReportHeader& header) {
  for (const auto& [key, text] : document.provenance) {
    if (key == "drive" && header.drive.empty()) header.drive = text;
    std::string name = label + "." + key;
    for (int n = 2; header.provenance.contains(name); ++n) name = label + "." + key + "." + std::to_string(n);
    header.provenance[name] = text;
  }
}

}  // namespace waymark::program
