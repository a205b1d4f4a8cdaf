#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/core/graph/checks/finite_check.hpp>
#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/program/jobs/conformance/trials.hpp>
#include <waymark/types_se2/se2.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

namespace waymark::program {
namespace {

constexpr double kSpeed = 8;
constexpr double kYawRate = 0.1;
constexpr double kDt_s = 0.1;
constexpr std::size_t kNodes = 601;
constexpr std::size_t kPerFix = 10;

Pose2<double> truth_at(double t) {
  return compose(Pose2<double>(40, -15, 0.8), se2_exp<double>(Eigen::Vector3d(kSpeed * t, 0, kYawRate * t)));
}

/// A place that is as good as any: UTM 32, near Heidelberg.
const drive::Projection& projection() {
  static const drive::Projection there(Frame{32, true, 477'000, 5'473'000});
  return there;
}

/// A minute on a circle, in a graph that models fill.
struct TrialDrive {
  Graph graph;
  std::vector<Stamp> stamps;
  std::vector<VertexIndex> poses;
  std::vector<Interval> intervals;
  std::vector<OdometrySample> odometry;
  std::vector<Fix> fixes;
  std::vector<FixMoment> moments;
  std::vector<DriveSource> sources;

  TrialDrive() {
    for (std::size_t i = 0; i < kNodes; ++i) {
      const double t = static_cast<double>(i) * kDt_s;
      stamps.push_back(Stamp::from_seconds(1000 + t));
      poses.push_back(graph.add_vertex<VertexSe2>(graph.free_id(), truth_at(t)));
      graph.set_stamp(poses.back(), stamps.back());
      odometry.push_back({.stamp = stamps.back(), .speed_mps = kSpeed, .yaw_rate_radps = kYawRate});
      if (i > 0) intervals.push_back({.speed_mps = kSpeed, .yaw_rate_radps = kYawRate, .dt_s = kDt_s});
      if (i % kPerFix == 0) add_fix(i, t);
    }
    sources = {{.name = "odometry", .kind = "odometry", .odometry = odometry},
               {.name = "gnss", .kind = "gnss", .fixes = fixes}};
  }
  TrialDrive(const TrialDrive&) = delete;
  TrialDrive& operator=(const TrialDrive&) = delete;

  [[nodiscard]] DriveContext context() const {
    return {.geodesy = &projection(), .scale = TimeScale::utc, .sources = sources};
  }

  /// The nodes of a part: it begins at the last one of the part before.
  [[nodiscard]] DriveNodes nodes(std::size_t first, std::size_t last) const {
    return {std::span(stamps).subspan(first, last - first + 1),
            std::span(poses).subspan(first, last - first + 1),
            std::span(intervals).subspan(first, last - first)};
  }
  /// The index of the first fix at or after a node.
  [[nodiscard]] static std::size_t fix_at(std::size_t node) { return (node + kPerFix - 1) / kPerFix; }

  [[nodiscard]] double rmse() const {
    double sum = 0;
    for (std::size_t i = 0; i < kNodes; ++i)
      sum += (graph.value<VertexSe2>(poses[i]).position - truth_at(static_cast<double>(i) * kDt_s).position)
                 .squaredNorm();
    return std::sqrt(sum / kNodes);
  }

 private:
  void add_fix(std::size_t node, double t) {
    Fix fix;
    fix.stamp = stamps[node];
    fix.position = truth_at(t).position + Eigen::Vector2d(std::sin(7 * t), std::cos(5 * t));
    fix.epoch = static_cast<int>(fixes.size());
    fix.vertex = graph.id(poses[node]);
    fixes.push_back(fix);
    moments.push_back({{0, 0}, {kSpeed, 0}, 0});
  }
};

/// Adds the part of a drive from one node to another.
using AddPart = std::function<void(TrialDrive& drive, std::size_t first, std::size_t last)>;

std::size_t vertices_and_edges(const Graph& graph) {
  return graph.vertex_count() + graph.edge_count();
}

/// A drive in two parts must become the graph of the whole.
void compare_parts(const std::function<AddPart()>& make, TrialDrive& whole, Trial& trial) {
  make()(whole, 0, kNodes - 1);
  TrialDrive parts;
  const AddPart add = make();
  add(parts, 0, kNodes / 2);
  add(parts, kNodes / 2, kNodes - 1);
  if (const auto flaw = find_not_finite(whole.graph)) trial.problems.push_back(*flaw);
  const double chi2 = whole.graph.chi2();
  if (vertices_and_edges(parts.graph) != vertices_and_edges(whole.graph)) {
    trial.problems.push_back(fmt::format(
        "a drive in two parts has {} vertices and {} edges, the whole has {} and {}: keep what the next part "
        "continues from (KeptVertex)",
        parts.graph.vertex_count(), parts.graph.edge_count(), whole.graph.vertex_count(),
        whole.graph.edge_count()));
  } else if (std::abs(parts.graph.chi2() - chi2) > 1e-6 * (1 + chi2)) {
    trial.problems.push_back(
        fmt::format("a drive in two parts has chi2 {:.9g}, the whole {:.9g}", parts.graph.chi2(), chi2));
  }
}

/// Minimises the whole drive, and judges how near it comes to the truth.
void judge_minimum(const TypeRegistry& registry, TrialDrive& drive, Trial& trial) {
  if (!trial.problems.empty()) return;
  BlockCholesky solver;
  const Summary summary = optimize(drive.graph, *registry.make_algorithm("dogleg"), solver, {});
  if (!summary.converged()) trial.problems.push_back("its graph does not converge: " + summary.message);
  constexpr double kFixError_m = 1;
  if (!(drive.rmse() < kFixError_m))
    trial.problems.push_back(
        fmt::format("the minimum is {:.3g} m from the truth, the fixes are {} m", drive.rmse(), kFixError_m));
}

/// Runs steps with the default options. A type that needs stated ones is not tried.
template <typename T>
void with_defaults(const T& type, Trial& trial, const std::function<void(Trial&)>& steps) {
  const bool needs =
      std::any_of(type.options.begin(), type.options.end(), [](const OptionInfo& o) { return o.required; });
  if (needs) {
    trial.note = "not tried: it has options that must be given";
    return;
  }
  run_trial(trial, steps);
}

void try_odometry(const TypeRegistry& registry, Trial& trial) {
  TrialDrive whole;
  compare_parts(
      [&]() -> AddPart {
        std::shared_ptr<OdometryModel> model = registry.make_odometry_model(trial.name);
        return [model](TrialDrive& drive, std::size_t first, std::size_t last) {
          const DriveContext context = drive.context();
          model->extend({drive.nodes(first, last), "odometry", context}, drive.graph);
        };
      },
      whole, trial);
  registry.make_gnss_modeling("g1")->extend({whole.fixes, whole.moments}, whole.graph);
  judge_minimum(registry, whole, trial);
}

void try_modeling(const TypeRegistry& registry, Trial& trial) {
  TrialDrive whole;
  compare_parts(
      [&]() -> AddPart {
        std::shared_ptr<GnssModeling> model = registry.make_gnss_modeling(trial.name);
        return [model](TrialDrive& drive, std::size_t first, std::size_t last) {
          const std::size_t begin = first == 0 ? 0 : TrialDrive::fix_at(first + 1);
          const std::size_t count = TrialDrive::fix_at(last + 1) - begin;
          const DriveContext context = drive.context();
          model->extend({.fixes = std::span<const Fix>(drive.fixes).subspan(begin, count),
                         .moments = std::span<const FixMoment>(drive.moments).subspan(begin, count),
                         .source = "gnss",
                         .context = context},
                        drive.graph);
        };
      },
      whole, trial);
  registry.make_odometry_model("constant_twist")->extend({whole.nodes(0, kNodes - 1)}, whole.graph);
  judge_minimum(registry, whole, trial);
}

/// What a column would read on the circle.
double reading_of(const SensorColumn& column, double t) {
  const Pose2<double> pose = truth_at(t);
  if (column.sense == "ccw_from_east") return pose.heading;
  if (column.sense == "x") return pose.position.x();
  if (column.sense == "y") return pose.position.y();
  if (column.unit == "m/s") return kSpeed;
  if (column.unit == "rad/s") return kYawRate;
  if (column.unit == "s") return -0.5;  // readings look back
  return column.unit == "1" ? 1 : 0.5;
}

SensorTable readings_of(const SensorModelType& type, const TrialDrive& drive, std::size_t first,
                        std::size_t last) {
  SensorTable table;
  table.columns = type.columns.size();
  if (type.columns.empty()) return table;
  for (std::size_t node = first == 0 ? 0 : first + 1; node <= last; ++node) {
    if (node % 5 != 0) continue;
    table.stamps.push_back(drive.stamps[node]);
    for (const SensorColumn& column : type.columns)
      table.values.push_back(reading_of(column, static_cast<double>(node) * kDt_s));
  }
  return table;
}

void try_sensor(const TypeRegistry& registry, const SensorModelType& type, Trial& trial) {
  TrialDrive whole;
  const auto make = [&]() -> AddPart {
    std::shared_ptr<SensorModel> model = registry.make_sensor_model(trial.name);
    return [model, &type](TrialDrive& drive, std::size_t first, std::size_t last) {
      const SensorTable table = readings_of(type, drive, first, last);
      const DriveContext context = drive.context();
      model->extend({.nodes = drive.nodes(0, last),
                     .fixes = drive.fixes,
                     .readings = table,
                     .source = "sensor",
                     .context = context},
                    drive.graph);
    };
  };
  try {
    compare_parts(make, whole, trial);
  } catch (const InputError& error) {
    trial.note = std::string("refuses readings made by the units of its columns: ") + error.what();
  }
}

}  // namespace

std::vector<Trial> try_models(const TypeRegistry& registry, const Wanted& wanted) {
  std::vector<Trial> trials;
  for (const auto& [type, origin] : registry.odometry_models())
    if (wanted(origin))
      with_defaults(type, trials.emplace_back(Trial{"odometry model", type.name, origin, {}, {}}),
                    [&](Trial& trial) { try_odometry(registry, trial); });
  for (const auto& [type, origin] : registry.gnss_modelings())
    if (wanted(origin))
      with_defaults(type, trials.emplace_back(Trial{"GNSS modeling", type.name, origin, {}, {}}),
                    [&](Trial& trial) { try_modeling(registry, trial); });
  for (const auto& entry : registry.sensor_models())
    if (wanted(entry.origin))
      with_defaults(entry.type,
                    trials.emplace_back(Trial{"sensor model", entry.type.name, entry.origin, {}, {}}),
                    [&](Trial& trial) { try_sensor(registry, entry.type, trial); });
  return trials;
}

}  // namespace waymark::program
