#include <waymark/tools/drive/estimation/coarse.hpp>

#include <cmath>
#include <map>
#include <optional>

namespace waymark::drive {
namespace {

std::vector<std::size_t> kept_fixes(const std::vector<Fix>& fixes, double period_s) {
  std::map<int, Stamp> last;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].status != FixStatus::accepted) continue;
    const auto before = last.find(fixes[i].source);
    if (before != last.end() && seconds_between(before->second, fixes[i].stamp) < 0.9 * period_s) continue;
    last[fixes[i].source] = fixes[i].stamp;
    kept.push_back(i);
  }
  return kept;
}

/// Adds the part that follows.
void merge(Interval& whole, const Interval& part) {
  const double dt = whole.dt_s + part.dt_s;
  const auto change = [](double mean, double before, double next, double after) {
    return next + 0.5 * after - (mean - 0.5 * before);
  };
  whole.speed_change_mps =
      change(whole.speed_mps, whole.speed_change_mps, part.speed_mps, part.speed_change_mps);
  whole.yaw_rate_change_radps = change(whole.yaw_rate_radps, whole.yaw_rate_change_radps, part.yaw_rate_radps,
                                       part.yaw_rate_change_radps);
  whole.speed_mps = (whole.speed_mps * whole.dt_s + part.speed_mps * part.dt_s) / dt;
  whole.yaw_rate_radps = (whole.yaw_rate_radps * whole.dt_s + part.yaw_rate_radps * part.dt_s) / dt;
  whole.dt_s = dt;
}

/// Returns the node that a reading belongs to; empty outside the drive.
std::optional<std::size_t> node_of(const Timeline& timeline, Stamp reading) {
  const auto near = nearest_node({timeline.stamps, {}, timeline.intervals}, reading);
  return near ? std::optional(near->node) : std::nullopt;
}

/// Marks the nodes of readings that are a period apart (a tenth less, for jitter).
void need_nodes_of(const PreparedSensor& sensor, const Timeline& timeline, double period_s,
                   std::vector<char>& needed) {
  std::optional<Stamp> last;
  for (const Stamp stamp : sensor.readings.stamps) {
    if (last && seconds_between(*last, stamp) < 0.9 * period_s) continue;
    const auto node = node_of(timeline, stamp);
    if (!node) continue;
    needed[*node] = 1;
    last = stamp;
  }
}

/// Returns a sensor with the readings of the nodes that are kept.
PreparedSensor at_kept_nodes(const PreparedSensor& sensor, const Timeline& timeline,
                             const std::vector<char>& kept) {
  PreparedSensor result = sensor;
  result.readings = {{}, {}, sensor.readings.columns};
  for (std::size_t row = 0; row < sensor.readings.size(); ++row) {
    const auto node = node_of(timeline, sensor.readings.stamps[row]);
    if (!node || kept[*node] == 0) continue;
    result.readings.stamps.push_back(sensor.readings.stamps[row]);
    for (std::size_t column = 0; column < sensor.readings.columns; ++column)
      result.readings.values.push_back(sensor.readings.at(row, column));
  }
  return result;
}

}  // namespace

CoarseDrive coarsen(const PlacedDrive& placed, std::span<const PreparedSensor> sensors, double fix_period_s,
                    double node_period_s) {
  const Timeline& timeline = placed.timeline;
  const std::vector<std::size_t> kept = kept_fixes(placed.fixes, fix_period_s);
  std::vector<char> needed(timeline.stamps.size(), 0);
  for (const std::size_t fix : kept) needed[timeline.fix_node[fix]] = 1;
  for (const PreparedSensor& sensor : sensors) need_nodes_of(sensor, timeline, node_period_s, needed);

  CoarseDrive result;
  PlacedDrive& coarse = result.drive;
  coarse.surroundings = placed.surroundings;
  coarse.first_pose = placed.first_pose;
  coarse.gate = placed.gate;
  coarse.receivers = placed.receivers;
  coarse.time_offsets_s = placed.time_offsets_s;
  coarse.odometry_name = placed.odometry_name;
  coarse.relative = placed.relative;
  coarse.standstill_mps = placed.standstill_mps;
  coarse.gap_noise_factor = placed.gap_noise_factor;
  std::vector<std::size_t> coarse_node(timeline.stamps.size(), 0);
  std::vector<char> is_kept(timeline.stamps.size(), 0);
  const auto add_node = [&](std::size_t node) {
    is_kept[node] = 1;
    coarse_node[node] = coarse.timeline.stamps.size();
    coarse.timeline.stamps.push_back(timeline.stamps[node]);
    coarse.start.poses.push_back(placed.start.poses[node]);
  };
  const auto stands = [&](const Interval& i) { return std::abs(i.speed_mps) < placed.standstill_mps; };
  add_node(0);
  Interval open = timeline.intervals.front();
  for (std::size_t i = 1; i < timeline.intervals.size(); ++i) {
    const Interval& next = timeline.intervals[i];
    const bool alike = stands(open) == stands(next) && open.bridged == next.bridged;
    if (alike && needed[i] == 0 && open.dt_s + next.dt_s <= node_period_s) {
      merge(open, next);
      continue;
    }
    coarse.timeline.intervals.push_back(open);
    add_node(i);
    open = next;
  }
  coarse.timeline.intervals.push_back(open);
  add_node(timeline.intervals.size());

  for (const std::size_t i : kept) {
    const std::size_t node = coarse_node[timeline.fix_node[i]];
    coarse.timeline.fix_node.push_back(node);
    coarse.fixes.push_back(placed.fixes[i]);
    coarse.fixes.back().vertex = vertex_of(node);
  }
  if (!coarse.relative.empty()) coarse.runs = motion_runs(coarse.timeline, coarse.relative, coarse.fixes);
  for (const PreparedSensor& sensor : sensors)
    result.sensors.push_back(at_kept_nodes(sensor, timeline, is_kept));
  return result;
}

}  // namespace waymark::drive
