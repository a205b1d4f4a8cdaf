#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/tools/report/drive_figures.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark {
namespace {

void add_point(Series& series, double x, double y, double seconds) {
  series.x.push_back(x);
  series.y.push_back(y);
  series.time.push_back(seconds);
}

Series poses(const ReportedDrive& drive) {
  Series series{.name = "fused", .mark = Mark::line, .look = Look::fused};
  const Graph& graph = drive.document.graph;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const auto stamp = graph.stamp(v);
    if (!stamp || graph.vertex_type(v).tag != VertexSe2::kTag) continue;
    add_point(series, graph.value(v)[0], graph.value(v)[1], drive.seconds(*stamp));
  }
  return series;
}

/// Truth inside the drive's time: a reference log may go on for hours.
Series truth(const ReportedDrive& drive, double end_s) {
  Series series{.name = "truth", .mark = Mark::line, .look = Look::truth};
  for (const TruthPose& pose : drive.truth) {
    const double seconds = drive.seconds(pose.stamp);
    if (seconds >= 0 && seconds <= end_s) add_point(series, pose.position.x(), pose.position.y(), seconds);
  }
  return series;
}

/// What the gate found; a number that it did not form is not told.
std::string describe(const Fix& fix, double seconds) {
  std::string text = fmt::format("fix {} at {:.1f} s: {}", fix.epoch, seconds, to_string(fix.status));
  if (fix.status == FixStatus::rejected) {
    text += ", " + fix.reason;
    if (std::isfinite(fix.chord_angle_rad))
      text += fmt::format(", angle {:.1f} deg", fix.chord_angle_rad * 180 / std::numbers::pi);
    if (std::isfinite(fix.displacement_m)) text += fmt::format(", displacement {:.2f} m", fix.displacement_m);
  }
  return text + fmt::format(", stated sigma {:.3g} m", std::sqrt(fix.covariance.trace() / 2));
}

Series fixes(const ReportedDrive& drive, FixStatus status, const std::string& name, Look look) {
  Series series{.name = name, .mark = Mark::points, .look = look};
  for (const Fix& fix : drive.document.fixes) {
    if (fix.status != status) continue;
    const double seconds = drive.seconds(fix.stamp);
    add_point(series, fix.position.x(), fix.position.y(), seconds);
    series.note.push_back(static_cast<int>(series.notes.size()));
    series.notes.push_back(describe(fix, seconds));
  }
  return series;
}

}  // namespace

Figure trajectory_figure(const ReportedDrive& drive) {
  Figure figure;
  figure.id = "trajectory";
  figure.title = "Trajectory";
  figure.description =
      "Fused poses of the body point, raw fixes of the antenna with what became of them" +
      std::string(drive.truth.empty() ? "" : ", and the truth") +
      ". Grid metres of the drive's UTM frame, grid north up. Point at a fix to read its verdict.";
  figure.x = {.title = "east", .unit = "m"};
  figure.y = {.title = "north", .unit = "m"};
  figure.motion = Motion::map;
  figure.geographic = true;
  figure.height = 620;
  Series fused = poses(drive);
  const double end_s = fused.time.empty() ? 0 : fused.time.back();
  const std::vector<Series> layers = {
      truth(drive, end_s), fixes(drive, FixStatus::accepted, "raw GNSS", Look::raw),
      fixes(drive, FixStatus::rejected, "raw GNSS, rejected", Look::rejected),
      fixes(drive, FixStatus::withheld, "raw GNSS, withheld", Look::withheld), std::move(fused)};
  for (const Series& series : layers) {
    if (!series.x.empty()) figure.series.push_back(series);
  }
  return figure;
}

}  // namespace waymark
