#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include <waymark/tools/report/drive_figures.hpp>
#include <waymark/tools/report/drive_report.hpp>
#include <waymark/tools/report/optimization_figures.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark {
namespace {

std::string metres(double value) {
  return std::isfinite(value) ? fmt::format("{:.3f}", value) : "-";
}

std::string percent(double value) {
  return std::isfinite(value) ? fmt::format("{:+.1f}", value) : "-";
}

std::vector<std::string> metrics_row(const std::string& name, const PositionMetrics& m) {
  return {name,
          fmt::to_string(m.count),
          metres(m.max_m),
          metres(m.accuracy_m),
          metres(m.precision_m),
          metres(m.rmse_m),
          metres(m.median_m),
          metres(m.cep50_m),
          metres(m.cep95_m)};
}

const std::vector<std::string> kMetrics = {"",         "epochs",     "Max [m]",   "Acc [m]",  "Prec [m]",
                                           "RMSE [m]", "median [m]", "CEP50 [m]", "CEP95 [m]"};

PageTable truth_table(const ReportedDrive& drive) {
  const TruthEvaluation& truth = *drive.evaluation.truth;
  PageTable table{"Against truth", kMetrics, {}};
  table.rows = {metrics_row("raw GNSS", truth.gnss.position),
                metrics_row("raw GNSS, accepted fixes only", truth.gnss_accepted.position),
                metrics_row("fused", truth.fused.position)};
  const Improvement& i = truth.improvement;
  table.rows.push_back({"better than raw by [%]", "", percent(i.max_percent), percent(i.accuracy_percent),
                        percent(i.precision_percent), percent(i.rmse_percent), percent(i.median_percent),
                        percent(i.cep50_percent), percent(i.cep95_percent)});
  table.notes = {
      "Max: largest error. Acc: length of the mean error. Prec: standard deviation about it. CEP50, CEP95: "
      "radius about the truth that holds 50 and 95 % of the epochs. Raw and fused at the same epochs: the "
      "stamps of all fixes with a truth."};
  return table;
}

PageTable track_table(const TruthEvaluation& truth) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  PageTable table{
      "Along and across track, and heading",
      {"", "along: mean [m]", "rms [m]", "across: mean [m]", "rms [m]", "heading: mean [deg]", "rms [deg]"},
      {}};
  for (const auto& [name, system] : {std::pair{"raw GNSS", &truth.gnss}, std::pair{"fused", &truth.fused}}) {
    table.rows.push_back({name, metres(system->track.along.mean), metres(system->track.along.rms),
                          metres(system->track.cross.mean), metres(system->track.cross.rms),
                          metres(system->heading.mean * kDegrees), metres(system->heading.rms * kDegrees)});
  }
  return table;
}

std::string describe_consistency(const ConsistencyStatistics& stated) {
  return fmt::format(
      "Mean NEES {:.2f}, honest between {:.2f} and {:.2f}; {:.0f} % of the epochs inside their 95 % region, "
      "honest between {:.0f} and {:.0f} %. The errors last, so {} epochs are worth {:.1f} independent ones. "
      "Median of actual over stated error: {:.2f}.",
      stated.nees_mean, stated.nees_mean_honest.low, stated.nees_mean_honest.high, 100 * stated.coverage,
      100 * stated.coverage_honest.low, 100 * stated.coverage_honest.high, stated.count,
      stated.effective_samples, stated.median_error_ratio);
}

PageTable withheld_table(const Evaluation& evaluation) {
  PageTable table{"At withheld fixes", kMetrics, {}, {"The noise of the fixes is in these numbers."}};
  for (const WithheldMetrics& way : evaluation.at_withheld) {
    table.rows.push_back(metrics_row(way.label, way.at_fixes));
    if (way.at_ends.count > 0)
      table.rows.push_back(metrics_row(way.label + ", at the ends of outages", way.at_ends));
  }
  return table;
}

std::string count_of_rejections(const ReportedDrive& drive) {
  std::map<std::string, std::size_t> of_reason;
  for (const Fix& fix : drive.document.fixes) {
    if (fix.status == FixStatus::rejected) ++of_reason[fix.reason];
  }
  const Evaluation& e = drive.evaluation;
  std::string text = fmt::format(
      "{} of {} fixes ({:.1f} %)", e.rejected, e.fixes(),
      100 * static_cast<double>(e.rejected) / std::max<double>(1, static_cast<double>(e.fixes())));
  for (const auto& [reason, count] : of_reason)
    text += fmt::format("{} {} for {}", text.back() == ')' ? ":" : ",", count, reason);
  const std::size_t light = nearly_left_out(drive);
  if (light > 0) text += fmt::format("; {} count for less than a third of their weight", light);
  if (e.withheld > 0) text += fmt::format("; {} withheld on purpose", e.withheld);
  return text;
}

/// Length in time and space, and the size of the graph.
std::string describe_input(const ReportedDrive& drive) {
  const Graph& graph = drive.document.graph;
  double distance_m = 0;
  std::size_t poses = 0;
  Stamp last = drive.start_;
  std::optional<Eigen::Vector2d> before;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const auto stamp = graph.stamp(v);
    if (!stamp || graph.vertex_type(v).tag != VertexSe2::kTag) continue;
    const Eigen::Vector2d place(graph.value(v)[0], graph.value(v)[1]);
    if (before) distance_m += (place - *before).norm();
    before = place;
    last = std::max(last, *stamp);
    ++poses;
  }
  return fmt::format("{:.0f} s, {:.0f} m along {} poses, {} fixes; a graph of {} vertices and {} edges",
                     drive.seconds(last), distance_m, poses, drive.document.fixes.size(),
                     graph.vertex_count(), graph.edge_count());
}

std::string outcome(const ReportedDrive& drive) {
  if (drive.optimization == nullptr) return "as the graph file has it";
  const Summary& s = drive.optimization->summary;
  return fmt::format("{} in {} iterations, {:.3f} s, chi2 {:.6g} -> {:.6g}",
                     s.converged() ? "minimum reached" : "NO MINIMUM: " + s.message, s.iterations,
                     s.total_seconds, s.initial_chi2, s.final_chi2);
}

/// What went in, what was assumed, what was rejected, what came out.
PageTable account(const ReportedDrive& drive) {
  PageTable table{"", {"", ""}, {}};
  table.rows.push_back({"went in", describe_input(drive)});
  for (const auto& [key, text] : drive.document.provenance) {
    if (key == "input") table.rows.push_back({"log", text});
  }
  for (const auto& [heading, text] : drive.went_in) table.rows.push_back({heading, text});
  for (const auto& [key, text] : drive.document.provenance) {
    if (key == "assumed") table.rows.push_back({"assumed", text});
  }
  table.rows.push_back({"rejected", count_of_rejections(drive)});
  table.rows.push_back({"came out", outcome(drive)});
  return table;
}

PageTable provenance(const ReportedDrive& drive) {
  PageTable table{"Where it comes from", {"", ""}, {}};
  for (const auto& [key, text] : drive.document.provenance) {
    if (key != "assumed") table.rows.push_back({key, text});
  }
  return table;
}

/// What got worse, for a summary must not only praise.
std::string describe_losses(const Improvement& i) {
  constexpr double kWorthTelling = -2;  // percent
  std::string text;
  for (const auto& [name, percent] :
       {std::pair{"the mean offset (Acc)", i.accuracy_percent},
        std::pair{"the spread (Prec)", i.precision_percent},
        std::pair{"the largest error (Max)", i.max_percent}, std::pair{"the median", i.median_percent}}) {
    if (percent < kWorthTelling)
      text += fmt::format("{} {} by {:.0f} %", text.empty() ? " Worse:" : ",", name, -percent);
  }
  return text.empty() ? text : text + ".";
}

void summarise(const ReportedDrive& drive, Page& page) {
  if (drive.optimization != nullptr && !drive.optimization->summary.converged())
    page.summary = "No minimum was reached: " + drive.optimization->summary.message + ". ";
  if (!drive.evaluation.truth) {
    page.summary += "There is no truth to compare with.";
    if (drive.evaluation.withheld_fixes) {
      page.summary += fmt::format(
          " At {} withheld fixes the fused positions are off by {:.3f} m (RMSE, with the noise of the "
          "fixes).",
          drive.evaluation.withheld, drive.evaluation.withheld_fixes->position.rmse_m);
    }
    return;
  }
  const TruthEvaluation& truth = *drive.evaluation.truth;
  const double better = truth.improvement.rmse_percent;
  page.verdict = better >= 0 ? Verdict::better : Verdict::worse;
  page.summary += fmt::format(
      "Fused positions are {:.0f} % {} than raw GNSS: RMSE {:.3f} m against {:.3f} m, largest error {:.3f} m "
      "against {:.3f} m, at {} epochs.",
      std::abs(better), better >= 0 ? "better" : "worse", truth.fused.position.rmse_m,
      truth.gnss.position.rmse_m, truth.fused.position.max_m, truth.gnss.position.max_m,
      truth.fused.position.count);
  page.summary += describe_losses(truth.improvement);
}

Section summary_section(const ReportedDrive& drive) {
  Section section{"summary", "Summary", {}};
  if (drive.evaluation.truth) section.blocks.emplace_back(truth_table(drive));
  if (!drive.evaluation.at_withheld.empty() && drive.evaluation.withheld > 0)
    section.blocks.emplace_back(withheld_table(drive.evaluation));
  section.blocks.emplace_back(account(drive));
  return section;
}

Section error_section(const ReportedDrive& drive) {
  Section section{"errors", "Errors", {}};
  if (drive.evaluation.truth) {
    section.blocks.emplace_back(error_tiles(drive));
    for (Figure& figure : errors_over_time(drive)) section.blocks.emplace_back(std::move(figure));
    section.blocks.emplace_back(track_table(*drive.evaluation.truth));
    section.blocks.emplace_back(error_distribution(drive));
    section.blocks.emplace_back(autocorrelation_figure(drive));
  } else {
    section.blocks.emplace_back(fix_residuals_over_time(drive));
    for (Figure& figure : errors_over_time(drive)) section.blocks.emplace_back(std::move(figure));
  }
  return section;
}

void add_consistency(const ReportedDrive& drive, Page& page) {
  if (!drive.evaluation.truth || !drive.evaluation.truth->consistency) return;
  Section section{"consistency", "Stated against actual errors", {}};
  section.blocks.emplace_back(Paragraph{describe_consistency(*drive.evaluation.truth->consistency)});
  std::vector<Figure> figures = consistency_figures(drive);
  if (figures.size() == 3) {
    section.blocks.emplace_back(FigureRow{{std::move(figures[0]), std::move(figures[1])}});
    section.blocks.emplace_back(std::move(figures[2]));
  }
  page.sections.push_back(std::move(section));
}

void add_states(const ReportedDrive& drive, Page& page) {
  if (drive.states == nullptr || drive.states->empty()) return;
  const auto seconds = [&](Stamp stamp) { return drive.seconds(stamp); };
  Section section{"calibration", "Calibration", {}};
  section.blocks.emplace_back(state_table(*drive.states));
  for (Figure& figure : state_figures(*drive.states, seconds, epochs_extent(drive)))
    section.blocks.emplace_back(std::move(figure));
  page.sections.push_back(std::move(section));
}

void add_optimization(const ReportedDrive& drive, Page& page) {
  Section section{"optimisation", "Optimisation", {}};
  if (drive.optimization != nullptr) {
    const Summary& s = drive.optimization->summary;
    section.blocks.emplace_back(
        Paragraph{fmt::format("{}. Algorithm {}, start {}, linear solver {}, {} unknowns.", s.message,
                              s.algorithm, drive.optimization->start, s.solver, s.unknowns)});
    if (!s.records.empty()) section.blocks.emplace_back(convergence_figure(s));
  }
  if (drive.sparsity != nullptr) {
    section.blocks.emplace_back(Paragraph{describe_sparsity(*drive.sparsity)});
    section.blocks.emplace_back(sparsity_figures(*drive.sparsity));
  }
  if (!section.blocks.empty()) page.sections.push_back(std::move(section));
}

void add_residuals(const ReportedDrive& drive, Page& page) {
  if (drive.residuals == nullptr) return;
  const auto seconds = [&](Stamp stamp) { return drive.seconds(stamp); };
  Section section{"residuals-by-type", "Residuals", {}};
  section.blocks.emplace_back(residual_table(*drive.residuals));
  section.blocks.emplace_back(residual_figure(*drive.residuals));
  section.blocks.emplace_back(largest_residuals(*drive.residuals, seconds));
  page.sections.push_back(std::move(section));
}

}  // namespace

Stamp ReportedDrive::start() const {
  std::optional<Stamp> first;
  const auto consider = [&](Stamp stamp) { first = first ? std::min(*first, stamp) : stamp; };
  const Graph& graph = document.graph;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (const auto stamp = graph.stamp(v)) consider(*stamp);
  }
  for (const Fix& fix : document.fixes) consider(fix.stamp);
  return first.value_or(Stamp{});
}

Page drive_page(const ReportedDrive& drive) {
  Page page;
  page.title = (drive.name.empty() ? "Drive" : drive.name) + ": " + drive.label;
  page.footer =
      "Made by Waymark. All figures are beside this page as SVG, their numbers as CSV, in the folder "
      "figures.";
  summarise(drive, page);
  page.sections.push_back(summary_section(drive));
  page.sections.push_back({"trajectory-section", "Trajectory", {trajectory_figure(drive)}});
  page.sections.push_back(error_section(drive));
  add_consistency(drive, page);
  add_states(drive, page);
  add_residuals(drive, page);
  add_optimization(drive, page);
  Section origin{"provenance", "Provenance", {provenance(drive)}};
  for (const std::string& file : drive.files) origin.blocks.emplace_back(PageLink{file, file});
  page.sections.push_back(std::move(origin));
  return page;
}

}  // namespace waymark
