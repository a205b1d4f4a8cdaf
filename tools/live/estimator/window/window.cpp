#include <waymark/tools/live/estimator/window/window.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/LU>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/window/marginalization.hpp>
#include <waymark/tools/drive/model/minimize.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::live {
namespace {

constexpr double kInputsKept_s = 600;

}  // namespace

Window::Window(const drive::DriveFacts& facts, std::vector<drive::PreparedSensor> sensors,
               const drive::FusionSettings& settings, const TypeRegistry& registry)
    : sensors_(std::move(sensors)),
      registry_(registry),
      several_odometries_(facts.relative.size() > 1),
      builder_(facts, sensors_, settings, registry),
      graph_(builder_.graph()),
      solver_(graph_) {
  inputs_.set_before({facts.first_pose, {}});
}

namespace {

constexpr double kPiece_s = 1;  // of a stretch

/// Returns intervals by the odometry that they come from. @param first, last nodes that they join
std::vector<drive::MotionRun> runs_of(const PlacedStretch& stretch, std::size_t first, std::size_t last) {
  std::vector<drive::MotionRun> runs;
  for (std::size_t i = first; i < last; ++i) {
    if (runs.empty() || runs.back().source != stretch.givers[i])
      runs.push_back({.source = stretch.givers[i], .nodes = {i}, .intervals = {}, .beside = {0}});
    runs.back().nodes.push_back(i + 1);
    runs.back().intervals.push_back(stretch.intervals[i]);
    runs.back().beside.push_back(0);
  }
  return runs;
}

}  // namespace

/// @param first, last nodes of the stretch
void Window::add_nodes(const PlacedStretch& stretch, std::size_t first, std::size_t last) {
  const std::size_t before = first == 0 ? 0 : first - 1;  // the node where the motion begins
  std::vector<drive::MotionRun> runs;
  if (several_odometries_) runs = runs_of(stretch, before, last);
  for (std::size_t i = first; i <= last; ++i)
    inputs_.add(i == 0 ? NodeInput{stretch.stamps[0], stretch.poses[0]}
                       : NodeInput{stretch.stamps[i], stretch.poses[i], stretch.intervals[i - 1],
                                   stretch.givers[i - 1]});
  extend({.stamps = std::span(stretch.stamps).subspan(first, last - first + 1),
          .poses = std::span(stretch.poses).subspan(first, last - first + 1),
          .intervals = std::span(stretch.intervals).subspan(before, last - before),
          .fixes = {},
          .fix_nodes = {},
          .runs = runs});
}

// Nodes, ways, readings and fixes are added a second at a time, in the order in which they come: states that follow
// one another in time are then summed out one after the other.
bool Window::begin(const PlacedStretch& stretch) {
  std::map<int, std::vector<Fix>> by_source;
  for (const Fix& fix : stretch.fixes) by_source[fix.source].push_back(fix);
  std::map<int, ClaimedAccuracies> claimed;
  for (const auto& [source, fixes] : by_source) claimed[source] = claimed_accuracies(fixes);
  std::vector<SensorTable> waiting;
  for (drive::PreparedSensor& sensor : sensors_) {
    waiting.push_back(sensor.readings);
    sensor.readings.stamps.clear();
    sensor.readings.values.clear();
  }
  readings_wait_ = false;
  std::vector<std::size_t> next_row(waiting.size(), 0);
  auto fix = stretch.fixes.begin();
  auto way = stretch.ways.begin();
  for (std::size_t first = 0, last = 0; first < stretch.stamps.size(); first = last + 1) {
    last = first;
    while (last + 1 < stretch.stamps.size() &&
           seconds_between(stretch.stamps[first], stretch.stamps[last]) < kPiece_s)
      ++last;
    const bool ends = last + 1 == stretch.stamps.size();
    for (std::size_t s = 0; s < waiting.size(); ++s)
      for (std::size_t& row = next_row[s];
           row < waiting[s].size() && (ends || waiting[s].stamps[row] <= stretch.stamps[last]); ++row)
        give_reading(s, waiting[s].stamps[row],
                     std::span(waiting[s].values).subspan(row * waiting[s].columns, waiting[s].columns));
    add_nodes(stretch, first, last);
    for (; way != stretch.ways.end() && way->to <= stretch.stamps[last]; ++way) add_way(*way);
    for (; fix != stretch.fixes.end() && (ends || fix->stamp <= stretch.stamps[last]); ++fix)
      add_fix(*fix, claimed[fix->source]);
  }
  drive::Minimization how;
  const std::unique_ptr<Algorithm> algorithm = registry_.make_algorithm(how.algorithm, how.options);
  const std::unique_ptr<LinearSolver> solver =
      registry_.make_linear_solver(drive::solver_name(how, registry_), how.solver_options);
  const Summary summary = optimize(graph_, *algorithm, *solver, drive::optimizer_options(how));
  return summary.converged() && solve();
}

bool Window::begin_again(const WindowInputs& inputs, Stamp oldest) {
  for (const auto& [number, reading] : inputs.readings())
    add_reading(reading.sensor, reading.stamp, reading.values);
  if (!begin(inputs.stretch())) return false;
  if (!inputs.before().states.empty()) add_known(inputs.before().states);
  (void)drop_before(oldest);
  return solve();
}

void Window::catch_up(const WindowInputs& inputs, std::uint64_t first) {
  std::vector<std::pair<std::uint64_t, std::function<void()>>> later;
  const auto collect = [&](const auto& kind, auto add) {
    for (const auto& [number, input] : kind)
      if (number >= first) later.emplace_back(number, [&input = input, add] { add(input); });
  };
  collect(inputs.nodes(), [this](const NodeInput& node) { add_node(node.stamp, node.interval, node.giver); });
  collect(inputs.fixes(), [this](const ClaimedFix& fix) { add_fix(fix.fix, fix.claimed); });
  collect(inputs.readings(), [this](const SensorReading& reading) {
    add_reading(reading.sensor, reading.stamp, reading.values);
  });
  collect(inputs.ways(), [this](const MeasuredWay& way) { add_way(way); });
  std::sort(later.begin(), later.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [number, add] : later) add();
  use_readings();
}

const WindowInputs& Window::inputs() {
  inputs_.correct(remaining());
  return inputs_;
}

void Window::add_known(std::span<const KnownState> states) {
  inputs_.set_before({inputs_.before().first_pose, {states.begin(), states.end()}});
  for (const VertexId id : predictor_.vertices()) {
    const VertexIndex v = graph_.find(id).value_or(-1);
    if (v < 0 || graph_.vertex_type(v).position != nullptr) continue;
    const auto known = std::find_if(states.begin(), states.end(), [&](const KnownState& state) {
      return state.tag == graph_.vertex_type(v).tag;
    });
    if (known == states.end()) continue;
    std::vector<double> fields = known->value;
    fields.resize(fields.size() + static_cast<std::size_t>(known->covariance.rows()), 0.0);
    const Eigen::MatrixXd information = known->covariance.inverse();
    graph_.add_edge(gaussian_prior_type(), std::span(&v, 1), fields,
                    0.5 * (information + information.transpose()));
  }
}

void Window::extend(const drive::DrivePart& part) {
  drive::DrivePart whole = part;
  if (readings_wait_) whole.sensors = sensors_;
  const auto first = static_cast<VertexIndex>(graph_.vertex_count());
  builder_.extend(whole);
  for (VertexIndex v = first; v < static_cast<VertexIndex>(graph_.vertex_count()); ++v)
    if (graph_.vertex_type(v).height) height_ = graph_.id(v);
  if (!readings_wait_) return;
  for (drive::PreparedSensor& sensor : sensors_) {
    sensor.readings.stamps.clear();
    sensor.readings.values.clear();
  }
  readings_wait_ = false;
}

void Window::add_node(Stamp stamp, const Interval& interval, std::size_t giver) {
  const Eigen::Vector3d from = newest_pose();
  const Eigen::Vector3d twist(interval.speed_mps * interval.dt_s, 0, interval.yaw_rate_radps * interval.dt_s);
  const Eigen::Vector3d to = compose(Pose2<double>(from[0], from[1], from[2]), se2_exp(twist)).vector();
  inputs_.add(NodeInput{stamp, to, interval, giver});
  const std::size_t last = poses() - 1;
  drive::MotionRun run;
  if (several_odometries_)
    run = {.source = giver, .nodes = {last, last + 1}, .intervals = {interval}, .beside = {0, 0}};
  predictor_.mark(graph_);
  extend({.stamps = std::span(&stamp, 1),
          .poses = std::span(&to, 1),
          .intervals = std::span(&interval, 1),
          .fixes = {},
          .fix_nodes = {},
          .runs = std::span(&run, several_odometries_ ? 1 : 0)});
  predictor_.follow(graph_, builder_.nodes().poses.back());
}

void Window::add_way(const MeasuredWay& way) {
  inputs_.add(way);
  const std::span<const Stamp> nodes = stamps();
  const auto index = [&](Stamp stamp) {
    return static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), stamp) - nodes.begin());
  };
  const drive::MotionRun run{.source = way.source,
                             .nodes = {index(way.from), index(way.to)},
                             .intervals = {way.interval},
                             .beside = {1, 1}};
  const auto first = static_cast<VertexIndex>(graph_.vertex_count());
  predictor_.mark(graph_);
  extend(
      {.stamps = {}, .poses = {}, .intervals = {}, .fixes = {}, .fix_nodes = {}, .runs = std::span(&run, 1)});
  // Poses beside the nodes are eliminated at their time. Without a stamp they would come last, all together.
  std::vector<VertexIndex> beside;
  for (auto v = first; v < static_cast<VertexIndex>(graph_.vertex_count()); ++v)
    if (graph_.vertex_type(v).position != nullptr && !graph_.stamp(v)) beside.push_back(v);
  for (const VertexIndex v : beside) graph_.set_stamp(v, v == beside.back() ? way.to : way.from);
  predictor_.settle(graph_, first);
}

ClaimedAccuracies Window::with_kept(int source, ClaimedAccuracies claimed) const {
  const auto kept = kept_claims_.find(source);
  if (kept == kept_claims_.end()) return claimed;
  for (std::size_t kind = 0; kind < claimed.median_m.size(); ++kind) {
    if (!kept->second.median_m[kind]) continue;
    claimed.median_m[kind] = kept->second.median_m[kind];
    claimed.stand_in_m[kind] = kept->second.stand_in_m[kind];
  }
  return claimed;
}

void Window::add_fix(const Fix& fix, const ClaimedAccuracies& claimed) {
  inputs_.add(ClaimedFix{fix, claimed});
  builder_.set_claimed(fix.source, with_kept(fix.source, claimed));
  const auto first = static_cast<VertexIndex>(graph_.vertex_count());
  predictor_.mark(graph_);
  extend({.stamps = {}, .poses = {}, .intervals = {}, .fixes = std::span(&fix, 1), .fix_nodes = {}});
  predictor_.settle(graph_, first);
}

void Window::add_reading(std::size_t sensor, Stamp stamp, std::span<const double> values) {
  inputs_.add(SensorReading{stamp, sensor, {values.begin(), values.end()}});
  give_reading(sensor, stamp, values);
}

void Window::give_reading(std::size_t sensor, Stamp stamp, std::span<const double> values) {
  SensorTable& table = sensors_[sensor].readings;
  const auto place = std::upper_bound(table.stamps.begin(), table.stamps.end(), stamp);
  const auto row = place - table.stamps.begin();
  table.stamps.insert(place, stamp);
  table.values.insert(table.values.begin() + row * static_cast<std::ptrdiff_t>(table.columns), values.begin(),
                      values.end());
  readings_wait_ = true;
}

void Window::use_readings() {
  if (!readings_wait_) return;
  const auto first = static_cast<VertexIndex>(graph_.vertex_count());
  predictor_.mark(graph_);
  extend({.stamps = {}, .poses = {}, .intervals = {}, .fixes = {}, .fix_nodes = {}});
  predictor_.settle(graph_, first);
}

bool Window::solve() {
  // One step does if it promises less than this.
  constexpr WindowOptions kLive{
      .max_iterations = 4, .decrement_tolerance = 1, .safe_decrement = 10, .partial_updates = 9};
  const WindowSummary summary = solver_.update(kLive);
  if (!summary.solved) return false;
  const VertexIndex pose = builder_.nodes().poses.back();
  predictor_.begin(graph_, solver_.tail(pose), pose);
  return true;
}

std::vector<StampedPose> Window::drop_before(Stamp moment) {
  const DriveNodes nodes = builder_.nodes();
  std::size_t count = 0;
  while (count + 2 < nodes.stamps.size() && nodes.stamps[count] < moment) ++count;
  std::vector<StampedPose> settled;
  if (count == 0) return settled;
  for (std::size_t i = 0; i < count; ++i) {
    const auto pose = graph_.value(nodes.poses[i]);
    settled.push_back({nodes.stamps[i], {pose[0], pose[1], pose[2]}});
  }
  try {
    const Marginalization dropped = marginalize_prefix(graph_, nodes.poses[count]);
    builder_.dropped(dropped.removal);
    solver_.restart();
  } catch (const InputError&) {
    settled.clear();  // the removed edges do not determine a pose: it stays until more are removed
  }
  predictor_.mark(graph_);
  inputs_.correct(settled);
  inputs_.forget_before(std::min(oldest(), newest().later(-kInputsKept_s)));
  return settled;
}

Eigen::Vector3d Window::newest_pose() const {
  const auto pose = graph_.value(builder_.nodes().poses.back());
  return {pose[0], pose[1], pose[2]};
}

std::optional<double> Window::newest_height() const {
  const auto vertex = height_ ? graph_.find(*height_) : std::nullopt;
  return vertex ? std::optional(graph_.value(*vertex)[0]) : std::nullopt;
}

Eigen::Vector2d Window::antenna_at(const Fix& fix) const {
  const DriveNodes nodes = builder_.nodes();
  const NodeInTime near = *nearest_node(nodes, fix.stamp, std::numeric_limits<double>::infinity());
  const auto at_node = graph_.value(nodes.poses[near.node]);
  const Pose2<double> moved = compose(Pose2<double>(at_node[0], at_node[1], at_node[2]),
                                      se2_exp<double>(motion_from_node(nodes, near).way));
  return moved.position + rotate(moved.heading, fix.antenna_seen_m());
}

std::vector<KnownState> Window::open_states() const {
  std::vector<KnownState> states;
  Eigen::Index row = 0;
  for (const VertexId id : predictor_.vertices()) {
    const VertexIndex v = graph_.find(id).value_or(-1);
    if (v < 0) continue;
    const Eigen::Index size = graph_.vertex_type(v).tangent_size;
    if (graph_.vertex_type(v).position == nullptr)
      states.push_back({graph_.vertex_type(v).tag,
                        {graph_.value(v).begin(), graph_.value(v).end()},
                        predictor_.joint().block(row, row, size, size)});
    row += size;
  }
  return states;
}

std::vector<StampedPose> Window::remaining() const {
  const DriveNodes nodes = builder_.nodes();
  std::vector<StampedPose> poses;
  for (std::size_t i = 0; i < nodes.stamps.size(); ++i) {
    const auto pose = graph_.value(nodes.poses[i]);
    poses.push_back({nodes.stamps[i], {pose[0], pose[1], pose[2]}});
  }
  return poses;
}

}  // namespace waymark::live
