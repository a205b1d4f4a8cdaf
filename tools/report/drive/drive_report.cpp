#include <algorithm>

#include <fmt/format.h>

#include <waymark/tools/report/drive/drive_figures.hpp>
#include <waymark/tools/report/drive/drive_report.hpp>
#include <waymark/tools/report/drive/drive_summary.hpp>
#include <waymark/tools/report/drive/group_sections.hpp>
#include <waymark/tools/report/drive/optimization_figures.hpp>
#include <waymark/tools/report/drive/verdict.hpp>
#include <waymark/tools/report/words.hpp>

namespace waymark::report {
namespace {

std::string describe_consistency(const evaluation::ConsistencyStatistics& stated) {
  return fmt::format(
      "The mean NEES is {:.2f}; between {:.2f} and {:.2f} it is consistent. {:.0f} % of the epochs "
      "are inside their 95 % region; between {:.0f} and {:.0f} % is consistent. The errors last, so "
      "{} epochs are worth {:.1f} independent ones. Median of actual over stated error: {:.2f}.",
      stated.nees_mean, stated.nees_mean_consistent.low, stated.nees_mean_consistent.high,
      100 * stated.coverage, 100 * stated.coverage_consistent.low, 100 * stated.coverage_consistent.high,
      stated.count, stated.effective_samples, stated.median_error_ratio);
}

text::Table provenance(const ReportedDrive& drive) {
  text::Table table{.title = "Provenance", .columns = {"", ""}, .words = true};
  for (const auto& [key, text] : drive.document.provenance) {
    if (key != "assumed" && key != "warning") table.rows.push_back({key, text});
  }
  return table;
}

drawing::Section error_section(const ReportedDrive& drive) {
  drawing::Section section{"errors", "Errors", metric_tables(drive)};
  if (drive.evaluation.truth) {
    section.blocks.emplace_back(error_tiles(drive));
    drawing::add_figures(errors_over_time(drive), section);
    section.blocks.emplace_back(track_table(*drive.evaluation.truth));
    text::Table relative = relative_table(*drive.evaluation.truth);
    if (!relative.rows.empty()) section.blocks.emplace_back(std::move(relative));
    section.blocks.emplace_back(error_distribution(drive));
    section.blocks.emplace_back(autocorrelation_figure(drive));
  } else {
    section.blocks.emplace_back(fix_residuals_over_time(drive));
    drawing::add_figures(errors_over_time(drive), section);
  }
  text::Table weak = weak_table(drive);
  if (!weak.rows.empty()) section.blocks.emplace_back(std::move(weak));
  return section;
}

/// Describes whether the residuals of the fixes are as large as their covariances say.
std::string describe_innovations(const evaluation::Evaluation& e) {
  std::string text;
  if (e.post_fit.count > 0)
    text =
        fmt::format("The mean NIS of {} accepted fixes is {}.", e.post_fit.count, describe_nis(e.post_fit));
  const auto* nis = e.held_out ? &e.held_out->innovation : &e.prediction;
  if (nis->count > 0) {
    text += fmt::format(
        "{}The mean NIS of {} fixes that are not in the graph is {}; {:.0f} % of them are inside "
        "their 95 % region.",
        text.empty() ? "" : " ", nis->count, describe_nis(*nis), 100 * nis->fraction_inside);
  }
  return text.empty() ? "The modeling takes the errors of the fixes as lasting, so their NIS has no meaning."
                      : text;
}

void add_consistency(const ReportedDrive& drive, drawing::Page& page) {
  const evaluation::Evaluation& e = drive.evaluation;
  const bool compared = e.truth && e.truth->consistency;
  drawing::Section section{"consistency", compared ? "Stated against actual errors" : "Stated errors", {}};
  if (compared) section.blocks.emplace_back(drawing::Paragraph{describe_consistency(*e.truth->consistency)});
  if (e.fixes() > 0) section.blocks.emplace_back(drawing::Paragraph{describe_innovations(e)});
  const std::size_t words = section.blocks.size();
  if (compared) drawing::add_figures(consistency_figures(drive), section);
  drawing::add_figures(sigmas_over_time(drive), section);
  if (compared || section.blocks.size() > words) page.sections.push_back(std::move(section));
}

void add_receivers(const ReportedDrive& drive, drawing::Page& page) {
  drawing::Section section{"receiver", "What the receiver told", {}};
  drawing::add_figures(receiver_figures(drive), section);
  if (!section.blocks.empty()) page.sections.push_back(std::move(section));
}

/// Tells the noise that the drive was fused with.
void add_noise(const ReportedDrive& drive, drawing::Page& page) {
  if (drive.noise.rows.empty()) return;
  drawing::Section section{"noise", "Noise", {}};
  text::Table table = drive.noise;
  table.notes = {
      "Estimated from this drive. The true value lies in the 68 % interval at two of three drives. 'not "
      "observed': the drive tells no more about it than was known before."};
  section.blocks.emplace_back(std::move(table));
  page.sections.push_back(std::move(section));
}

void add_sources(const ReportedDrive& drive, drawing::Page& page) {
  const evaluation::SourceComparison& comparison = drive.evaluation.sources;
  if (comparison.sources.empty()) return;
  drawing::Section section{"sources", "Sources", {}};
  text::Table table = evaluation::source_table(comparison);
  table.notes = {
      "share: of the information about a position, what only this source has. Without: the drive was fused "
      "again without the source, with the same noise. apart: its fixes from what the others say."};
  section.blocks.emplace_back(std::move(table));
  page.sections.push_back(std::move(section));
}

void add_source_residuals(const ReportedDrive& drive, drawing::Page& page) {
  if (drive.evaluation.residuals.empty()) return;
  drawing::Section section{"measurements", "Measurements of each source", {}};
  text::Table table = evaluation::source_residuals_table(drive.evaluation.residuals);
  table.notes = {
      "rms: of the whitened residuals after the fit, about 1 or below if the noise is as stated. down-weighted: "
      "the loss leaves less than half of the weight."};
  section.blocks.emplace_back(std::move(table));
  page.sections.push_back(std::move(section));
}

void add_states(const ReportedDrive& drive, drawing::Page& page) {
  if (drive.states == nullptr || drive.states->empty()) return;
  const auto seconds = [&](Stamp stamp) { return drive.seconds(stamp); };
  drawing::Section section{"calibration", "Calibration", {}};
  section.blocks.emplace_back(state_table(*drive.states));
  drawing::add_figures(state_figures(*drive.states, seconds, epochs_extent(drive)), section);
  page.sections.push_back(std::move(section));
}

void add_optimization(const ReportedDrive& drive, drawing::Page& page) {
  drawing::Section section{"optimisation", "Optimisation", {}};
  if (drive.optimization != nullptr) {
    const Summary& s = drive.optimization->summary;
    section.blocks.emplace_back(drawing::Paragraph{
        fmt::format("{}. Algorithm {}, initial guess {}, linear solver {}, {} unknowns.", s.message,
                    s.algorithm, drive.optimization->start, s.solver, s.unknowns)});
    if (!s.records.empty()) section.blocks.emplace_back(convergence_figure(s));
  }
  if (drive.sparsity != nullptr) {
    section.blocks.emplace_back(drawing::Paragraph{describe_sparsity(*drive.sparsity)});
    section.blocks.emplace_back(sparsity_figures(*drive.sparsity));
  }
  if (!section.blocks.empty()) page.sections.push_back(std::move(section));
}

void add_residuals(const ReportedDrive& drive, drawing::Page& page) {
  if (drive.residuals == nullptr) return;
  const auto seconds = [&](Stamp stamp) { return drive.seconds(stamp); };
  drawing::Section section{"residuals-by-type", "Residuals", {}};
  section.blocks.emplace_back(residual_table(*drive.residuals));
  section.blocks.emplace_back(residual_figure(*drive.residuals));
  section.blocks.emplace_back(largest_residuals(*drive.residuals, seconds));
  page.sections.push_back(std::move(section));
}

}  // namespace

Stamp start_of(const formats::GraphDocument& document) {
  std::optional<Stamp> first;
  const auto consider = [&](Stamp stamp) { first = first ? std::min(*first, stamp) : stamp; };
  const Graph& graph = document.graph;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (const auto stamp = graph.stamp(v)) consider(*stamp);
  }
  for (const Fix& fix : document.fixes) consider(fix.stamp);
  return first.value_or(Stamp{});
}

drawing::Page drive_page(const ReportedDrive& drive) {
  drawing::Page page;
  page.title = (drive.name.empty() ? "Drive" : drive.name) + ": " + drive.label;
  page.footer =
      "Made by Waymark. The folder figures beside this page has all figures as SVG "
      "and their numbers as CSV.";
  DriveVerdict verdict = verdict_of(drive);
  page.summary = std::move(verdict.text);
  page.verdict = verdict.kind;
  page.glossary = glossary();
  if (drawing::Section warnings = warning_section(drive); !warnings.blocks.empty())
    page.sections.push_back(std::move(warnings));
  page.sections.push_back({"trajectory-section", "Trajectory", {trajectory_figure(drive)}});
  page.sections.push_back(error_section(drive));
  page.sections.push_back(summary_section(drive));
  add_consistency(drive, page);
  add_noise(drive, page);
  add_receivers(drive, page);
  add_sources(drive, page);
  add_source_residuals(drive, page);
  for (drawing::Section& section : group_sections(drive)) page.sections.push_back(std::move(section));
  add_states(drive, page);
  add_residuals(drive, page);
  add_optimization(drive, page);
  drawing::Section origin{
      "provenance", "Provenance", {drawing::FoldedTable{"Versions, options and hashes", provenance(drive)}}};
  for (const std::string& file : drive.files) origin.blocks.emplace_back(drawing::PageLink{file, file});
  page.sections.push_back(std::move(origin));
  return page;
}

}  // namespace waymark::report
