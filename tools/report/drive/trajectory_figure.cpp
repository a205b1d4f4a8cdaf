#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include <waymark/formats/trajectory/map_formats.hpp>
#include <waymark/tools/report/drive/drive_figures.hpp>
#include <waymark/types_se2/stamped_pose.hpp>

namespace waymark::report {
namespace {

void add_point(drawing::Series& series, double x, double y, double seconds) {
  series.x.push_back(x);
  series.y.push_back(y);
  series.time.push_back(seconds);
}

drawing::Series poses(const ReportedDrive& drive) {
  drawing::Series series{.name = "fused", .mark = drawing::Mark::line, .look = drawing::Look::fused};
  const Graph& graph = drive.document.graph;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    if (const auto pose = stamped_pose(graph, v))
      add_point(series, pose->pose[0], pose->pose[1], drive.seconds(pose->stamp));
  }
  return series;
}

/// The odometry alone. It may lead far away, so the axes need not hold it. It is a few thousand points long, because
/// nobody looks at a drift closely.
drawing::Series dead_reckoning(const ReportedDrive& drive) {
  constexpr double kMostPoints = 10'000;
  const std::vector<StampedPose>& poses = drive.dead_reckoned;
  drawing::Series series{.name = "dead reckoning", .mark = drawing::Mark::line, .look = drawing::Look::third};
  series.in_view = false;
  double length_m = 0;
  for (std::size_t i = 1; i < poses.size(); ++i)
    length_m += (poses[i].pose - poses[i - 1].pose).head<2>().norm();
  const double apart_m = std::max(1.0, length_m / kMostPoints);
  const double apart_s = std::max(1.0, poses.empty() ? 0 : drive.seconds(poses.back().stamp) / kMostPoints);
  for (const StampedPose& pose : poses) {
    const double seconds = drive.seconds(pose.stamp);
    const bool is_near = !series.x.empty() && seconds < series.time.back() + apart_s &&
                         std::hypot(pose.pose[0] - series.x.back(), pose.pose[1] - series.y.back()) < apart_m;
    if (!is_near) add_point(series, pose.pose[0], pose.pose[1], seconds);
  }
  return series;
}

/// Returns the truth during the drive. A reference log may be hours longer.
drawing::Series truth(const ReportedDrive& drive, double end_s) {
  drawing::Series series{.name = "truth", .mark = drawing::Mark::line, .look = drawing::Look::truth};
  for (const TruthPose& pose : drive.truth) {
    const double seconds = drive.seconds(pose.stamp);
    if (seconds >= 0 && seconds <= end_s) add_point(series, pose.position.x(), pose.position.y(), seconds);
  }
  return series;
}

/// A fix with less weight is as good as rejected.
constexpr double kSmallWeight = 1.0 / 3;

/// Returns the weights that the losses leave to GNSS edges, by vertex; 1 for all others.
std::vector<double> weights_of_fixes(const ReportedDrive& drive) {
  const Graph& graph = drive.document.graph;
  std::vector<double> weights(graph.vertex_count(), 1);
  if (drive.residuals == nullptr) return weights;
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    const std::string& tag = graph.edge_type(b).tag;
    if (tag.find("GNSS") == std::string::npos) continue;
    for (const evaluation::TypeResiduals& type : drive.residuals->types) {
      if (type.tag != tag || type.robust == 0) continue;
      for (const evaluation::EdgeResidual& edge : type.edges) {
        for (const VertexIndex v : graph.batch(b).vertices(edge.edge)) {
          double& weight = weights[static_cast<std::size_t>(v)];
          weight = std::min(weight, edge.weight);
        }
      }
    }
  }
  return weights;
}

/// Returns the weight of a fix; 1 if it is not in the graph.
double weight_of(const Fix& fix, const std::vector<double>& weights, const Graph& graph) {
  const auto v = graph.find(fix.vertex);
  return v && fix.status == FixStatus::accepted ? weights[static_cast<std::size_t>(*v)] : 1;
}

/// Describes what the gate and the loss did with a fix. Numbers that were not computed
/// are left out.
std::string describe(const Fix& fix, double seconds, double weight) {
  std::string text = fmt::format("fix {} at {:.1f} s: {}", fix.epoch, seconds, to_string(fix.status));
  if (fix.status == FixStatus::rejected) {
    text += ", " + fix.reason;
    if (std::isfinite(fix.chord_angle_rad))
      text += fmt::format(", angle {:.1f} deg", fix.chord_angle_rad * 180 / std::numbers::pi);
    if (std::isfinite(fix.displacement_m)) text += fmt::format(", displacement {:.2f} m", fix.displacement_m);
  }
  if (weight < 1) text += fmt::format(", weight {:.2f}", weight);
  if (fix.told.quality != FixQuality::unknown) text += fmt::format(", {}", to_string(fix.told.quality));
  return text + fmt::format(", stated sigma {:.3g} m", std::sqrt(fix.covariance.trace() / 2));
}

/// The raw fixes by status, the accepted ones by the quality of their solution.
struct FixSeries {
  drawing::Series accepted{.name = "raw GNSS", .mark = drawing::Mark::points, .look = drawing::Look::raw};
  drawing::Series fixed{
      .name = "raw GNSS, fixed", .mark = drawing::Mark::points, .look = drawing::Look::first};
  drawing::Series floating{
      .name = "raw GNSS, float", .mark = drawing::Mark::points, .look = drawing::Look::third};
  drawing::Series dead_reckoned{
      .name = "raw GNSS, dead reckoned", .mark = drawing::Mark::points, .look = drawing::Look::fourth};
  drawing::Series light{
      .name = "raw GNSS, weight below 1/3", .mark = drawing::Mark::points, .look = drawing::Look::second};
  drawing::Series rejected{
      .name = "raw GNSS, rejected", .mark = drawing::Mark::points, .look = drawing::Look::rejected};
  drawing::Series withheld{
      .name = "raw GNSS, withheld", .mark = drawing::Mark::points, .look = drawing::Look::withheld};

  [[nodiscard]] drawing::Series& of(const Fix& fix, double weight) {
    if (fix.status == FixStatus::rejected) return rejected;
    if (fix.status == FixStatus::withheld) return withheld;
    if (weight < kSmallWeight) return light;
    switch (fix.told.quality) {
      case FixQuality::fixed:
        return fixed;
      case FixQuality::floating:
        return floating;
      case FixQuality::dead_reckoned:
        return dead_reckoned;
      default:
        return accepted;
    }
  }
};

FixSeries fixes(const ReportedDrive& drive) {
  const std::vector<double> weights = weights_of_fixes(drive);
  FixSeries all;
  for (const Fix& fix : drive.document.fixes) {
    const double weight = weight_of(fix, weights, drive.document.graph);
    drawing::Series& series = all.of(fix, weight);
    const double seconds = drive.seconds(fix.stamp);
    add_point(series, fix.position.x(), fix.position.y(), seconds);
    series.note.push_back(static_cast<int>(series.notes.size()));
    series.notes.push_back(describe(fix, seconds, weight));
  }
  return all;
}

/// Adds the qualities of the fixes if the receiver tells any.
void add_quality(const ReportedDrive& drive, drawing::Places& places) {
  if (drive.evaluation.by_quality.empty()) return;
  std::map<FixQuality, int> index_of;
  for (const evaluation::EpochResult& epoch : drive.evaluation.epochs) {
    if (!epoch.fused_place || !epoch.fused_position) continue;
    const auto [known, is_new] = index_of.try_emplace(epoch.told.quality, static_cast<int>(index_of.size()));
    if (is_new) places.qualities.emplace_back(to_string(epoch.told.quality));
    places.quality.push_back(known->second);
  }
}

/// Returns where the epochs are on Earth, and their covariances.
drawing::Places places(const ReportedDrive& drive) {
  drawing::Places places;
  const auto& epochs = drive.evaluation.epochs;
  const bool stated = std::all_of(epochs.begin(), epochs.end(),
                                  [](const auto& epoch) { return epoch.position_covariance.has_value(); });
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    if (!epochs[i].fused_place || !epochs[i].fused_position) continue;
    places.time.push_back(drive.seconds(epochs[i].stamp));
    places.x.push_back(epochs[i].fused_position->x());
    places.y.push_back(epochs[i].fused_position->y());
    places.latitude_deg.push_back(epochs[i].fused_place->latitude_deg);
    places.longitude_deg.push_back(epochs[i].fused_place->longitude_deg);
    if (!stated) continue;
    places.xx.push_back((*epochs[i].position_covariance)(0, 0));
    places.xy.push_back((*epochs[i].position_covariance)(0, 1));
    places.yy.push_back((*epochs[i].position_covariance)(1, 1));
  }
  add_quality(drive, places);
  if (const auto utc = formats::date_of(drive.start, drive.document.time_scale))
    places.start_utc_s = static_cast<double>(utc->nanoseconds) * 1e-9;
  return places;
}

/// Returns the time between marks: a round one, of which a drive has at most ten.
double between_marks_s(double duration_s) {
  for (const double seconds : {10.0, 30.0, 60.0, 300.0, 600.0, 1800.0, 3600.0}) {
    if (duration_s <= 10 * seconds) return seconds;
  }
  return 7200;
}

/// Returns start, end and time marks on the fused trajectory.
std::vector<drawing::Series> marks(const drawing::Series& fused) {
  if (fused.x.size() < 2) return {};
  const auto mark = [&](drawing::Series& series, std::size_t i, std::string note) {
    series.x.push_back(fused.x[i]);  // without a time: the cursor is not to stop at marks
    series.y.push_back(fused.y[i]);
    series.note.push_back(static_cast<int>(series.notes.size()));
    series.notes.push_back(std::move(note));
  };
  drawing::Series times{
      .name = "time marks", .mark = drawing::Mark::points, .look = drawing::Look::reference};
  const double every = between_marks_s(fused.time.back() - fused.time.front());
  double next = every;
  for (std::size_t i = 0; i < fused.time.size(); ++i) {
    if (fused.time[i] < next) continue;
    mark(times, i, fmt::format("{:g} s after the start", next));
    while (next <= fused.time[i]) next += every;
  }
  drawing::Series start{.name = "start", .mark = drawing::Mark::points, .look = drawing::Look::first};
  drawing::Series end{.name = "end", .mark = drawing::Mark::points, .look = drawing::Look::second};
  mark(start, 0, "start of the drive");
  mark(end, fused.x.size() - 1, "end of the drive");
  std::vector<drawing::Series> all;
  if (!times.x.empty()) all.push_back(std::move(times));
  all.push_back(std::move(start));
  all.push_back(std::move(end));
  return all;
}

}  // namespace

std::size_t nearly_left_out(const ReportedDrive& drive) {
  const std::vector<double> weights = weights_of_fixes(drive);
  const std::vector<Fix>& all = drive.document.fixes;
  return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](const Fix& fix) {
    return weight_of(fix, weights, drive.document.graph) < kSmallWeight;
  }));
}

drawing::Figure trajectory_figure(const ReportedDrive& drive) {
  drawing::Figure figure;
  figure.id = "trajectory";
  figure.title = "Trajectory";
  figure.description = "Fused poses of the body point, raw fixes of the antenna with their verdicts" +
                       std::string(drive.truth.empty() ? "" : ", and the truth") +
                       (drive.dead_reckoned.empty() ? "" : ", and the odometry alone from the first fix on") +
                       ". The axes are grid metres of the drive's UTM frame, grid north is up. "
                       "Point at a fix to read its verdict.";
  figure.x = {.title = "east", .unit = "m"};
  figure.y = {.title = "north", .unit = "m"};
  figure.motion = drawing::Motion::map;
  figure.geographic = true;
  figure.height = 620;
  drawing::Series fused = poses(drive);
  const double end_s = fused.time.empty() ? 0 : fused.time.back();
  FixSeries raw = fixes(drive);
  const std::vector<drawing::Series> marked = marks(fused);
  if (drawing::Places known = places(drive); !known.time.empty()) figure.places = std::move(known);
  std::vector<drawing::Series> layers = drive.ground;
  const std::vector<drawing::Series> tracks = {
      dead_reckoning(drive),   truth(drive, end_s),  std::move(raw.accepted), std::move(raw.dead_reckoned),
      std::move(raw.floating), std::move(raw.fixed), std::move(raw.light),    std::move(raw.rejected),
      std::move(raw.withheld), std::move(fused)};
  layers.insert(layers.end(), tracks.begin(), tracks.end());
  layers.insert(layers.end(), marked.begin(), marked.end());
  for (const drawing::Series& series : layers) {
    if (!series.x.empty()) figure.series.push_back(series);
  }
  return figure;
}

}  // namespace waymark::report
