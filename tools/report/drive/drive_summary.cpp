#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include <waymark/formats/logs/fix_quality.hpp>
#include <waymark/tools/evaluation/output/report.hpp>
#include <waymark/tools/report/drive/drive_figures.hpp>
#include <waymark/tools/report/drive/drive_summary.hpp>
#include <waymark/tools/report/drive/verdict.hpp>
#include <waymark/tools/report/metric_columns.hpp>
#include <waymark/tools/text/number_text.hpp>
#include <waymark/types_se2/stamped_pose.hpp>

namespace waymark::report {
namespace {

/// Returns the heading of a table of metrics.
text::Row metrics_heading() {
  text::Row heading = {"", "epochs"};
  for (const PositionColumn& column : position_columns()) heading.push_back(column.name + " [m]");
  return heading;
}

text::Row metrics_row(const std::string& name, const evaluation::PositionMetrics& m) {
  text::Row row = {name, fmt::to_string(m.count)};
  for (const PositionColumn& column : position_columns()) row.push_back(text::decimals(m.*column.value, 3));
  return row;
}

text::Row improvement_row(const evaluation::PositionMetrics& raw, const evaluation::PositionMetrics& fused) {
  text::Row row = {"better than raw by [%]", ""};
  for (const PositionColumn& column : position_columns()) {
    const double percent = evaluation::improvement_percent(raw.*column.value, fused.*column.value);
    row.push_back((percent > 0 ? "+" : "") + text::decimals(percent, 1));
  }
  return row;
}

/// Adds the errors that remain without the constant offset of the vehicle, if there is one worth
/// telling.
void add_without_offset(const std::string& name, const evaluation::OffsetTakenOut& taken,
                        text::Table& table) {
  if (!(std::hypot(taken.along_m, taken.cross_m) > 0.001)) return;
  table.rows.push_back(metrics_row(name + " less its offset", taken.rest));
  table.notes.push_back(fmt::format(
      "{} less its offset: without the constant {:.3f} m ahead and {:.3f} m to the left of the vehicle, as a wrong "
      "lever arm would make it.",
      name, taken.along_m, taken.cross_m));
}

text::Table truth_table(const ReportedDrive& drive) {
  const evaluation::TruthEvaluation& truth = *drive.evaluation.truth;
  text::Table table{.title = "Against truth", .columns = metrics_heading()};
  table.rows = {metrics_row("raw GNSS", truth.gnss.position), metrics_row("fused", truth.fused.position)};
  if (truth.gnss_accepted.position.count != truth.gnss.position.count)
    table.rows.insert(table.rows.begin() + 1,
                      metrics_row("raw GNSS, accepted fixes only", truth.gnss_accepted.position));
  table.rows.push_back(improvement_row(truth.gnss.position, truth.fused.position));
  table.notes = {
      "Max: largest error. Acc: length of the mean error. Prec: standard deviation about the mean "
      "error. CEP50, CEP95: radius about the truth that holds 50 and 95 % of the epochs. Raw and "
      "fused errors are at the same epochs: the stamps of all fixes with a truth."};
  add_without_offset("raw GNSS", truth.gnss_without_offset, table);
  add_without_offset("fused", truth.fused_without_offset, table);
  return table;
}

/// Adds the errors of the height and in space, or the remedy if only the truth lacks heights.
void add_space(const evaluation::TruthEvaluation& truth, std::vector<drawing::PageBlock>& blocks) {
  text::Table table;
  evaluation::add_space_row("fused", truth, table);
  if (table.rows.empty()) {
    for (std::string& note : table.notes) blocks.emplace_back(drawing::Paragraph{std::move(note)});
    return;
  }
  table.notes = {
      "The height is a state of the graph, of the point that it describes: an antenna, for example. A constant "
      "difference to the point of the truth is in the mean."};
  blocks.emplace_back(std::move(table));
}

text::Table withheld_table(const evaluation::Evaluation& evaluation) {
  text::Table table{.title = "At withheld fixes", .columns = metrics_heading()};
  table.notes = {
      "The numbers contain the noise of the fixes. 'with lasting errors' predicts the fixes, all others "
      "the antenna."};
  for (const evaluation::WithheldMetrics& way : evaluation.at_withheld) {
    table.rows.push_back(metrics_row(way.label, way.at_fixes));
    if (way.at_ends.count > 0)
      table.rows.push_back(metrics_row(way.label + ", at the ends of outages", way.at_ends));
  }
  return table;
}

text::Table held_out_table(const evaluation::HeldOut& held) {
  text::Table table{.title = "At fixes that were kept out of a second fusion", .columns = metrics_heading()};
  table.notes = {fmt::format(
      "All fixes of {:g} s in every {:g} s were kept out, and those that the gate accepts are judged. The "
      "numbers contain the noise of the fixes. Errors of the receiver that last longer are in the fixes "
      "before and after too, so they remain unseen.",
      held.run_s, held.every_s)};
  for (const evaluation::WithheldMetrics& way : held.predictions)
    table.rows.push_back(metrics_row(way.label, way.at_fixes));
  return table;
}

/// Errors of raw and fused positions where the fixes are of one quality.
text::Table quality_table(const evaluation::Evaluation& evaluation) {
  text::Table table{.title = "By quality of the fixes", .columns = metrics_heading()};
  for (const evaluation::QualityMetrics& of : evaluation.by_quality) {
    const std::string name = fmt::format("{} ({} fixes)", to_string(of.quality), of.fixes);
    table.rows.push_back(metrics_row("raw, " + name, of.gnss));
    table.rows.push_back(metrics_row("fused, " + name, of.fused));
  }
  return table;
}

std::string qualities_of(const ReportedDrive& drive) {
  std::map<FixQuality, std::size_t> counts;
  for (const evaluation::QualityMetrics& of : drive.evaluation.by_quality) counts[of.quality] = of.fixes;
  return formats::quality_counts(counts);
}

std::string count_of_rejections(const ReportedDrive& drive) {
  std::map<std::string, std::size_t> of_reason;
  for (const Fix& fix : drive.document.fixes) {
    if (fix.status == FixStatus::rejected) ++of_reason[fix.reason];
  }
  const evaluation::Evaluation& e = drive.evaluation;
  std::string text = fmt::format(
      "{} of {} fixes ({:.1f} %)", e.rejected, e.fixes(),
      100 * static_cast<double>(e.rejected) / std::max<double>(1, static_cast<double>(e.fixes())));
  for (const auto& [reason, count] : of_reason)
    text += fmt::format("{} {} for {}", text.back() == ')' ? ":" : ",", count, reason);
  const std::size_t light = nearly_left_out(drive);
  if (light > 0) text += fmt::format("; {} have less than a third of their weight", light);
  if (e.withheld > 0) text += fmt::format("; {} withheld for evaluation", e.withheld);
  return text;
}

/// Describes the length in time and space, and the size of the graph.
std::string describe_input(const ReportedDrive& drive) {
  const Graph& graph = drive.document.graph;
  double distance_m = 0;
  std::size_t poses = 0;
  Stamp last = drive.start;
  std::optional<Eigen::Vector2d> before;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const auto pose = stamped_pose(graph, v);
    if (!pose) continue;
    const Eigen::Vector2d place = pose->pose.head<2>();
    if (before) distance_m += (place - *before).norm();
    before = place;
    last = std::max(last, pose->stamp);
    ++poses;
  }
  return fmt::format("{:.0f} s, {:.0f} m along {} poses, {} fixes; a graph of {} vertices and {} edges",
                     drive.seconds(last), distance_m, poses, drive.document.fixes.size(),
                     graph.vertex_count(), graph.edge_count());
}

/// Describes modeling, noise, calibration and gate; empty if the graph does not contain them.
std::string describe_error_model(const ReportedDrive& drive) {
  std::string text = fmt::format("{}", fmt::join(stated(drive, "modeling"), ", "));
  if (text.empty()) return text;
  if (!stated(drive, "noise").empty()) text += "; noise estimated from the drive";
  const std::vector<std::string> calibration = stated(drive, "calibration");
  if (!calibration.empty())
    text += fmt::format("; estimated with the poses: {}", fmt::join(calibration, ", "));
  for (const std::string& loss : stated(drive, "loss")) text += "; loss " + loss;
  for (const std::string& gate : stated(drive, "gate")) text += "; gate " + gate;
  return text;
}

std::string outcome(const ReportedDrive& drive) {
  if (drive.optimization == nullptr) return "as in the graph file";
  const Summary& s = drive.optimization->summary;
  return fmt::format("{} in {} iterations, {:.3f} s, chi2 {:.6g} -> {:.6g}",
                     s.converged() ? "minimum reached" : "NO MINIMUM: " + s.message, s.iterations,
                     s.total_seconds, s.initial_chi2, s.final_chi2);
}

/// Returns one sentence a row.
text::Table list(const std::vector<std::string>& texts) {
  text::Table table{.columns = {""}, .words = true};
  for (const std::string& text : texts) table.rows.push_back({text});
  return table;
}

/// Lists inputs, rejected fixes and results.
text::Table account(const ReportedDrive& drive) {
  text::Table table{.columns = {"", ""}, .words = true};
  table.rows.push_back({"input", describe_input(drive)});
  for (const auto& [heading, text] : drive.went_in) table.rows.push_back({heading, text});
  const std::string model = describe_error_model(drive);
  if (!model.empty()) table.rows.push_back({"error model", model});
  if (!drive.evaluation.by_quality.empty()) table.rows.push_back({"quality", qualities_of(drive)});
  table.rows.push_back({"rejected", count_of_rejections(drive)});
  table.rows.push_back({"result", outcome(drive)});
  return table;
}

}  // namespace

std::vector<drawing::PageBlock> metric_tables(const ReportedDrive& drive) {
  std::vector<drawing::PageBlock> blocks;
  if (drive.evaluation.truth) {
    blocks.emplace_back(truth_table(drive));
    add_space(*drive.evaluation.truth, blocks);
  }
  if (!drive.evaluation.at_withheld.empty() && drive.evaluation.withheld > 0)
    blocks.emplace_back(withheld_table(drive.evaluation));
  if (drive.evaluation.held_out) blocks.emplace_back(held_out_table(*drive.evaluation.held_out));
  if (drive.evaluation.truth && !drive.evaluation.by_quality.empty())
    blocks.emplace_back(quality_table(drive.evaluation));
  return blocks;
}

drawing::Section warning_section(const ReportedDrive& drive) {
  drawing::Section section{"warnings", "Warnings", {}};
  const std::vector<std::string> warnings = stated(drive, "warning");
  if (!warnings.empty()) section.blocks.emplace_back(list(warnings));
  return section;
}

drawing::Section summary_section(const ReportedDrive& drive) {
  drawing::Section section{"summary", "What went in", {account(drive)}};
  const std::vector<std::string> assumed = stated(drive, "assumed");
  const std::vector<std::string> logs = stated(drive, "input");
  if (!assumed.empty())
    section.blocks.emplace_back(drawing::FoldedTable{
        fmt::format("{} {}", assumed.size(), assumed.size() == 1 ? "assumption" : "assumptions"),
        list(assumed)});
  if (!logs.empty())
    section.blocks.emplace_back(
        drawing::FoldedTable{fmt::format("{} logs with their hashes", logs.size()), list(logs)});
  return section;
}

text::Table relative_table(const evaluation::TruthEvaluation& truth) {
  text::Table table{.title = "Error of the motion over a distance (RPE)",
                    .columns = {"distance [m]", "motions", "rms [m]", "mean [m]", "largest [m]",
                                "rms [% of distance]", "rotation rms [deg]"}};
  for (const evaluation::RelativePoseError& error : truth.relative) {
    const evaluation::ScalarStatistics& t = error.translation_m;
    if (t.count == 0) continue;
    table.rows.push_back({fmt::format("{:g}", error.distance_m), fmt::to_string(t.count),
                          text::decimals(t.rms, 3), text::decimals(t.mean, 3), text::decimals(t.max_abs, 3),
                          text::decimals(100 * t.rms / error.distance_m, 2),
                          truth.fused.heading.count > 0
                              ? text::decimals(error.rotation_rad.rms * 180 / std::numbers::pi, 3)
                              : "-"});
  }
  table.notes = {
      "Of the fused poses, as evo_rpe tells it: a motion ends at the first epoch that is at least this far along the "
      "truth, and the next one begins there. A constant offset does not count."};
  return table;
}

text::Table track_table(const evaluation::TruthEvaluation& truth) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  text::Table table{.title = "Along and across track, and heading",
                    .columns = {"", "along: mean [m]", "rms [m]", "across: mean [m]", "rms [m]",
                                "heading: mean [deg]", "rms [deg]"}};
  const auto number = [](double value) { return text::decimals(value, 3); };
  for (const auto& [name, system] : {std::pair{"raw GNSS", &truth.gnss}, std::pair{"fused", &truth.fused}}) {
    const evaluation::TrackMetrics& track = system->track;
    table.rows.push_back({name, number(track.along.mean), number(track.along.rms), number(track.cross.mean),
                          number(track.cross.rms), number(system->heading.mean * kDegrees),
                          number(system->heading.rms * kDegrees)});
  }
  return table;
}

}  // namespace waymark::report
