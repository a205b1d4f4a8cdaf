#include <waymark/tools/drive/estimation/coarse.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kReadingPeriod_s = 0.25;

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
  whole.distance_sigma_m = std::hypot(whole.distance_sigma_m, part.distance_sigma_m);
  whole.turn_sigma_rad = std::hypot(whole.turn_sigma_rad, part.turn_sigma_rad);
  whole.dt_s = dt;
}

/// Merges intervals one after the other.
class Merger {
 public:
  explicit Merger(const Interval& first) { begin(first); }

  [[nodiscard]] const Interval& open() const { return open_; }
  void begin(const Interval& first) {
    open_ = first;
    way_ = way_of(first);
  }
  /// Adds the part that follows, unless the mean twist would then end elsewhere than the parts.
  /// @returns whether it was added
  [[nodiscard]] bool add(const Interval& part) {
    Interval whole = open_;
    merge(whole, part);
    const Pose2<double> way = compose(way_, way_of(part));
    if ((way.position - way_of(whole).position).norm() > kEndsWithin_m) return false;
    open_ = whole;
    way_ = way;
    return true;
  }

 private:
  static constexpr double kEndsWithin_m = 0.001;
  static Pose2<double> way_of(const Interval& interval) {
    return se2_exp<double>({interval.speed_mps * interval.dt_s, 0, interval.yaw_rate_radps * interval.dt_s});
  }

  Interval open_;
  Pose2<double> way_;  ///< of the parts
};

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

/// Returns what does not depend on nodes and fixes.
PlacedDrive without_course(const PlacedDrive& placed) {
  PlacedDrive result;
  result.surroundings = placed.surroundings;
  result.first_pose = placed.first_pose;
  result.gate = placed.gate;
  result.receivers = placed.receivers;
  result.time_offsets_s = placed.time_offsets_s;
  result.odometry_name = placed.odometry_name;
  result.relative = placed.relative;
  result.standstill_mps = placed.standstill_mps;
  result.gap_noise_factor = placed.gap_noise_factor;
  return result;
}

}  // namespace

CoarseDrive coarsen(const PlacedDrive& placed, std::span<const PreparedSensor> sensors, double fix_period_s,
                    double node_period_s) {
  const Timeline& timeline = placed.timeline;
  const std::vector<std::size_t> kept = kept_fixes(placed.fixes, fix_period_s);
  std::vector<char> needed(timeline.stamps.size(), 0);
  for (const std::size_t fix : kept) needed[timeline.fix_node[fix]] = 1;
  for (const PreparedSensor& sensor : sensors) need_nodes_of(sensor, timeline, kReadingPeriod_s, needed);

  CoarseDrive result;
  PlacedDrive& coarse = result.drive;
  coarse = without_course(placed);
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
  Merger merger(timeline.intervals.front());
  for (std::size_t i = 1; i < timeline.intervals.size(); ++i) {
    const Interval& next = timeline.intervals[i];
    const Interval& open = merger.open();
    const bool alike = stands(open) == stands(next) && open.bridged == next.bridged;
    if (alike && needed[i] == 0 && open.dt_s + next.dt_s <= node_period_s && merger.add(next)) continue;
    coarse.timeline.intervals.push_back(open);
    add_node(i);
    merger.begin(next);
  }
  coarse.timeline.intervals.push_back(merger.open());
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

CoarseDrive middle_of(const CoarseDrive& whole, double length_s) {
  const PlacedDrive& drive = whole.drive;
  const std::vector<Stamp>& stamps = drive.timeline.stamps;
  const double whole_s = seconds_between(stamps.front(), stamps.back());
  const Stamp begin = stamps.front().later(0.5 * (whole_s - length_s));
  const auto node_at = [&](Stamp moment) {
    return std::lower_bound(stamps.begin(), stamps.end(), moment) - stamps.begin();
  };
  const std::ptrdiff_t first = std::max<std::ptrdiff_t>(node_at(begin) - 1, 0);
  const std::ptrdiff_t last = std::min(node_at(begin.later(length_s)), std::ssize(stamps) - 1);

  CoarseDrive piece;
  piece.drive = without_course(drive);
  piece.drive.first_pose.reset();
  Timeline& timeline = piece.drive.timeline;
  timeline.stamps.assign(stamps.begin() + first, stamps.begin() + last + 1);
  timeline.intervals.assign(drive.timeline.intervals.begin() + first,
                            drive.timeline.intervals.begin() + last);
  piece.drive.start.poses.assign(drive.start.poses.begin() + first, drive.start.poses.begin() + last + 1);
  for (std::size_t i = 0; i < drive.fixes.size(); ++i) {
    const auto node = static_cast<std::ptrdiff_t>(drive.timeline.fix_node[i]);
    if (node < first || node > last) continue;
    timeline.fix_node.push_back(static_cast<std::size_t>(node - first));
    piece.drive.fixes.push_back(drive.fixes[i]);
    piece.drive.fixes.back().vertex = vertex_of(timeline.fix_node.back());
  }
  if (!drive.relative.empty()) piece.drive.runs = motion_runs(timeline, drive.relative, piece.drive.fixes);
  const std::vector<char> kept(timeline.stamps.size(), 1);
  for (const PreparedSensor& sensor : whole.sensors)
    piece.sensors.push_back(at_kept_nodes(sensor, timeline, kept));
  return piece;
}

}  // namespace waymark::drive
