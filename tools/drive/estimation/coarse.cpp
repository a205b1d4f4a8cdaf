#include <waymark/tools/drive/estimation/coarse.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kReadingPeriod_s = 0.25;

/// Tells whether a moment is less than a period after the last one that was kept; a tenth less is jitter.
bool comes_too_soon(const std::optional<Stamp>& last, Stamp moment, double period_s) {
  constexpr double kWithoutJitter = 0.9;
  return last && seconds_between(*last, moment) < kWithoutJitter * period_s;
}

std::vector<std::size_t> kept_fixes(const std::vector<Fix>& fixes, double period_s) {
  std::map<int, std::optional<Stamp>> last_of_receiver;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].status != FixStatus::accepted) continue;
    std::optional<Stamp>& last = last_of_receiver[fixes[i].source];
    if (comes_too_soon(last, fixes[i].stamp, period_s)) continue;
    last = fixes[i].stamp;
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

/// Returns the noise of the yaw rate of an odometry by its second differences, rad/sqrt(s): an interval has the
/// mean of two readings, so that their variance is that of one reading. 0 if few tell.
double yaw_noise_of(std::span<const Interval> intervals, double standstill_mps) {
  constexpr std::size_t kFewest = 20;
  constexpr double kOfNormal = 1.4826;  // standard deviation by the median of the size
  std::vector<double> noise;
  for (std::size_t i = 1; i + 1 < intervals.size(); ++i) {
    const auto counts = [&](const Interval& of) { return !of.bridged && !of.stands(standstill_mps); };
    const Interval& here = intervals[i];
    if (!counts(intervals[i - 1]) || !counts(here) || !counts(intervals[i + 1])) continue;
    const double bend =
        intervals[i - 1].yaw_rate_radps - 2 * here.yaw_rate_radps + intervals[i + 1].yaw_rate_radps;
    noise.push_back(std::abs(bend) * std::sqrt(here.dt_s));
  }
  return noise.size() < kFewest ? 0 : kOfNormal * upper_median(std::move(noise));
}

/// Merges intervals one after the other.
class Merger {
 public:
  /// @param yaw_noise as of yaw_noise_of()
  Merger(const Interval& first, double yaw_noise) : yaw_noise_(yaw_noise) { begin(first); }

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
    if ((way.position - way_of(whole).position).norm() > ends_within_m(whole)) return false;
    open_ = whole;
    way_ = way;
    return true;
  }

 private:
  /// A millimetre, or how far the noise of the yaw rate leads astray. The mean twist keeps the turn; what the
  /// noise does on the way to it is half of that (a Brownian bridge), is no motion, and the model of the merged
  /// interval has it.
  [[nodiscard]] double ends_within_m(const Interval& interval) const {
    constexpr double kLeast_m = 0.001;
    const double astray_m = interval.speed_mps * yaw_noise_ * std::sqrt(std::pow(interval.dt_s, 3) / 3);
    return std::max(kLeast_m, std::abs(astray_m));
  }
  static Pose2<double> way_of(const Interval& interval) {
    return se2_exp<double>({interval.speed_mps * interval.dt_s, 0, interval.yaw_rate_radps * interval.dt_s});
  }

  double yaw_noise_;
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
    if (comes_too_soon(last, stamp, period_s)) continue;
    const auto node = node_of(timeline, stamp);
    if (!node) continue;
    needed[*node] = 1;
    last = stamp;
  }
}

/// Returns a sensor with the readings whose stamp is kept.
template <typename Keeps>
PreparedSensor with_readings(const PreparedSensor& sensor, const Keeps& keeps) {
  PreparedSensor result = sensor;
  result.readings = {{}, {}, sensor.readings.columns};
  for (std::size_t row = 0; row < sensor.readings.size(); ++row) {
    if (!keeps(sensor.readings.stamps[row])) continue;
    result.readings.stamps.push_back(sensor.readings.stamps[row]);
    for (std::size_t column = 0; column < sensor.readings.columns; ++column)
      result.readings.values.push_back(sensor.readings.at(row, column));
  }
  return result;
}

/// Returns a sensor with the readings of the nodes that are kept.
PreparedSensor at_kept_nodes(const PreparedSensor& sensor, const Timeline& timeline,
                             const std::vector<char>& kept) {
  return with_readings(sensor, [&](Stamp stamp) {
    const auto node = node_of(timeline, stamp);
    return node && kept[*node] != 0;
  });
}

/// Returns what does not depend on nodes and fixes.
PlacedDrive without_course(const PlacedDrive& placed) {
  PlacedDrive result;
  result.surroundings = placed.surroundings;
  result.first_pose = placed.first_pose;
  result.start.follows_fixes = placed.start.follows_fixes;
  result.gate = placed.gate;
  result.receivers = placed.receivers;
  result.time_offsets_s = placed.time_offsets_s;
  result.smoothings_s = placed.smoothings_s;
  result.odometry_name = placed.odometry_name;
  result.relative = placed.relative;
  result.standstill_mps = placed.standstill_mps;
  result.gap_noise_factor = placed.gap_noise_factor;
  return result;
}

/// Nodes [first, last].
struct NodeRange {
  std::size_t first = 0;
  std::size_t last = 0;
};

NodeRange nodes_within(const std::vector<Stamp>& stamps, Stamp begin, double length_s) {
  const auto node_at = [&](Stamp moment) {
    return std::lower_bound(stamps.begin(), stamps.end(), moment) - stamps.begin();
  };
  return {static_cast<std::size_t>(std::max<std::ptrdiff_t>(node_at(begin) - 1, 0)),
          static_cast<std::size_t>(std::min(node_at(begin.later(length_s)), std::ssize(stamps) - 1))};
}

/// Returns an unknown motion from one pose to another: the arc that leaves the first along its heading. Its
/// covariance is that of a gap, with which far ends know nothing of each other.
Interval across(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double length_s) {
  const Eigen::Vector2d way = rotate(-from[2], Eigen::Vector2d(to.head<2>() - from.head<2>()));
  const double half_turn = way.isZero() ? 0 : std::atan2(way.y(), way.x());
  const double stretch = std::abs(half_turn) < 1e-6 ? 1 : half_turn / std::sin(half_turn);
  // an arc of a whole turn and more has no end
  const bool is_arc = std::abs(stretch) < 10;
  return {.speed_mps = is_arc ? stretch * way.norm() / length_s : 0,
          .yaw_rate_radps = is_arc ? 2 * half_turn / length_s : 0,
          .dt_s = length_s,
          .bridged = true,
          .gap_s = length_s};
}

/// Returns parts of a drive, one after the other.
CoarseDrive parts_of(const CoarseDrive& whole, const std::vector<NodeRange>& ranges) {
  const PlacedDrive& drive = whole.drive;
  const std::vector<Stamp>& stamps = drive.timeline.stamps;
  CoarseDrive parts;
  PlacedDrive& result = parts.drive;
  result = without_course(drive);
  result.first_pose.reset();
  Timeline& timeline = result.timeline;
  std::vector<char> kept(stamps.size(), 0);
  std::vector<std::size_t> place(stamps.size(), 0);
  for (const NodeRange& range : ranges) {
    if (!timeline.stamps.empty())
      timeline.intervals.push_back(across(result.start.poses.back(), drive.start.poses[range.first],
                                          seconds_between(timeline.stamps.back(), stamps[range.first])));
    for (std::size_t node = range.first; node <= range.last; ++node) {
      kept[node] = 1;
      place[node] = timeline.stamps.size();
      timeline.stamps.push_back(stamps[node]);
      result.start.poses.push_back(drive.start.poses[node]);
      if (node < range.last) timeline.intervals.push_back(drive.timeline.intervals[node]);
    }
  }
  for (std::size_t i = 0; i < drive.fixes.size(); ++i) {
    const std::size_t node = drive.timeline.fix_node[i];
    if (kept[node] == 0) continue;
    timeline.fix_node.push_back(place[node]);
    result.fixes.push_back(drive.fixes[i]);
    result.fixes.back().vertex = vertex_of(place[node]);
  }
  if (!drive.relative.empty()) result.runs = motion_runs(timeline, drive.relative, result.fixes);
  for (const PreparedSensor& sensor : whole.sensors)
    parts.sensors.push_back(at_kept_nodes(sensor, drive.timeline, kept));
  return parts;
}

/// Where a drive is parked: a stop of hours is worth no hours of a sample, and a part that only stands has no heading.
struct Driving {
  std::vector<double> until_s;  ///< driven up to each node, the beginning of each stop included
  std::vector<char> is_parked;  ///< of each interval: it belongs to the rest of a stop

  /// Returns the nodes of a time that is driven.
  [[nodiscard]] NodeRange nodes_within(double begin_s, double length_s) const {
    const auto node_at = [&](double moment_s) {
      return std::lower_bound(until_s.begin(), until_s.end(), moment_s) - until_s.begin();
    };
    return {static_cast<std::size_t>(std::max<std::ptrdiff_t>(node_at(begin_s) - 1, 0)),
            static_cast<std::size_t>(std::min(node_at(begin_s + length_s), std::ssize(until_s) - 1))};
  }
};

Driving driving_of(const PlacedDrive& drive) {
  constexpr double kStop_s = 1200;
  Driving driving{.until_s = {0}, .is_parked = {}};
  double stood_s = 0;
  for (const Interval& interval : drive.timeline.intervals) {
    const bool stands = !interval.bridged && interval.stands(drive.standstill_mps);
    const bool is_parked = stands && stood_s >= kStop_s;
    stood_s = stands ? stood_s + interval.dt_s : 0;
    driving.is_parked.push_back(is_parked);
    driving.until_s.push_back(driving.until_s.back() + (is_parked ? 0 : interval.dt_s));
  }
  return driving;
}

/// Returns the pieces of a range between parking in which the vehicle drives far enough to have a heading.
std::vector<NodeRange> without_parking(const NodeRange& range, const Driving& driving,
                                       const PlacedDrive& drive) {
  constexpr double kLeast_m = 50;
  std::vector<NodeRange> pieces;
  NodeRange piece{range.first, range.first};
  double way_m = 0;
  const auto end_piece = [&](std::size_t next) {
    if (way_m >= kLeast_m) pieces.push_back(piece);
    piece = {next, next};
    way_m = 0;
  };
  for (std::size_t i = range.first; i < range.last; ++i) {
    if (driving.is_parked[i] != 0) {
      end_piece(i + 1);
      continue;
    }
    const Interval& interval = drive.timeline.intervals[i];
    if (!interval.bridged) way_m += std::abs(interval.speed_mps) * interval.dt_s;
    piece.last = i + 1;
  }
  end_piece(range.last);
  return pieces;
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
  const auto stands = [&](const Interval& i) { return i.stands(placed.standstill_mps); };
  add_node(0);
  Merger merger(timeline.intervals.front(), yaw_noise_of(timeline.intervals, placed.standstill_mps));
  for (std::size_t i = 1; i < timeline.intervals.size(); ++i) {
    const Interval& next = timeline.intervals[i];
    const Interval& open = merger.open();
    const bool alike = stands(open) == stands(next) && open.bridged == next.bridged &&
                       open.turns_on_spot == next.turns_on_spot;
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

void keep_poses(const Graph& graph, CoarseDrive& coarse) {
  std::vector<Eigen::Vector3d>& poses = coarse.drive.start.poses;
  for (std::size_t node = 0; node < poses.size(); ++node) {
    const auto value = graph.value(static_cast<VertexIndex>(node));
    poses[node] = {value[0], value[1], value[2]};
  }
}

PreparedSensor thinned(const PreparedSensor& sensor, double period_s) {
  constexpr double kOneReading_s = 1e-3;
  std::optional<Stamp> last;
  return with_readings(sensor, [&](Stamp stamp) {
    if (last && seconds_between(*last, stamp) <= kOneReading_s) return true;
    if (comes_too_soon(last, stamp, period_s)) return false;
    last = stamp;
    return true;
  });
}

CoarseDrive middle_of(const CoarseDrive& whole, double length_s) {
  const std::vector<Stamp>& stamps = whole.drive.timeline.stamps;
  const double whole_s = seconds_between(stamps.front(), stamps.back());
  return parts_of(whole, {nodes_within(stamps, stamps.front().later(0.5 * (whole_s - length_s)), length_s)});
}

CoarseDrive sample_of(CoarseDrive whole, std::size_t windows, double window_s) {
  constexpr double kWorth = 1.3;
  const std::vector<Stamp>& stamps = whole.drive.timeline.stamps;
  const double whole_s = seconds_between(stamps.front(), stamps.back());
  const double count = static_cast<double>(windows);
  if (whole_s < kWorth * count * window_s || whole.drive.fixes.empty() || !whole.drive.relative.empty())
    return whole;
  const Driving driving = driving_of(whole.drive);
  const double driven_s = driving.until_s.back();
  std::vector<NodeRange> ranges;
  if (driven_s < kWorth * count * window_s) {
    ranges = without_parking({0, stamps.size() - 1}, driving, whole.drive);
  } else {
    for (std::size_t i = 0; i < windows; ++i) {
      const double middle_s = (static_cast<double>(i) + 0.5) / count * driven_s;
      const NodeRange range = driving.nodes_within(middle_s - 0.5 * window_s, window_s);
      // in a gap of the odometry there is nothing
      if (range.last <= range.first || (!ranges.empty() && range.first <= ranges.back().last)) continue;
      const std::vector<NodeRange> pieces = without_parking(range, driving, whole.drive);
      ranges.insert(ranges.end(), pieces.begin(), pieces.end());
    }
  }
  if (ranges.empty()) return whole;
  return parts_of(whole, ranges);
}

}  // namespace waymark::drive
