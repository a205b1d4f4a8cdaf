#include <waymark/tools/drive/mending/creeping.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include <waymark/tools/drive/mending/fix_motion.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kLeastZone = 0.25;  // m/s
constexpr double kShortestCreep_s = 3;
constexpr double kLargestAngle = 35 * std::numbers::pi / 180;

/// A line through fixes: where they go per second.
struct Line {
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  double duration_s = 0;
};

std::optional<Line> line_through(std::span<const Fix> fixes) {
  constexpr std::size_t kFewestInLine = 4;
  if (fixes.size() < kFewestInLine) return std::nullopt;
  const double count = static_cast<double>(fixes.size());
  double middle_s = 0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Fix& fix : fixes) {
    middle_s += seconds_between(fixes.front().stamp, fix.stamp) / count;
    middle += fix.position / count;
  }
  double squares = 0;
  Eigen::Vector2d products = Eigen::Vector2d::Zero();
  for (const Fix& fix : fixes) {
    const double away_s = seconds_between(fixes.front().stamp, fix.stamp) - middle_s;
    squares += away_s * away_s;
    products += away_s * (fix.position - middle);
  }
  if (!(squares > 0)) return std::nullopt;
  return Line{products / squares, seconds_between(fixes.front().stamp, fixes.back().stamp)};
}

/// Returns the chord of 5 m or more that ends at a fix, or begins there.
std::optional<Eigen::Vector2d> way_beside(const std::vector<Fix>& fixes, std::size_t at, bool before) {
  constexpr double kDirection = 5;       // m
  constexpr std::size_t kFurthest = 60;  // fixes
  for (std::size_t away = 1; away <= kFurthest; ++away) {
    if (before ? away > at : at + away >= fixes.size()) break;
    const Eigen::Vector2d chord = before ? Eigen::Vector2d(fixes[at].position - fixes[at - away].position)
                                         : Eigen::Vector2d(fixes[at + away].position - fixes[at].position);
    if (chord.norm() >= kDirection) return chord;
  }
  return std::nullopt;
}

bool leads_along(const Eigen::Vector2d& velocity, const std::vector<Fix>& fixes, std::size_t first,
                 std::size_t last) {
  const auto is_near = [&](const std::optional<Eigen::Vector2d>& way) {
    return way && std::abs(angle_between(*way, velocity)) < kLargestAngle;
  };
  return is_near(way_beside(fixes, first, true)) || is_near(way_beside(fixes, last, false));
}

/// A receiver may lose its corrections while the vehicle stands: the worst fix counts.
double worst_accuracy_m(std::span<const Fix> fixes) {
  double worst = 0;
  for (const Fix& fix : fixes) worst = std::max(worst, fix.accuracy_m());
  return worst;
}

/// Returns the speed of the fixes from one moment to another if the vehicle creeps.
std::optional<double> creeping_speed(const std::vector<Fix>& fixes, Stamp from, Stamp to, double zone_mps) {
  constexpr double kErrorsLast_s = 30;
  constexpr double kSigmas = 2.5;
  constexpr double kLeast_m = 0.3;
  const auto is_earlier = [](const Fix& fix, Stamp stamp) { return fix.stamp < stamp; };
  const auto begin = std::lower_bound(fixes.begin(), fixes.end(), from, is_earlier);
  const auto end = std::lower_bound(begin, fixes.end(), to, is_earlier);
  const std::span<const Fix> during(begin, end);
  const std::optional<Line> line = line_through(during);
  if (!line) return std::nullopt;
  const double speed = line->velocity.norm();
  const double drift = std::sqrt(2 * (1 - std::exp(-line->duration_s / kErrorsLast_s)));
  const double least_m = std::max(kLeast_m, kSigmas * drift * worst_accuracy_m(during));
  if (speed > 1.2 * zone_mps || speed * line->duration_s < least_m) return std::nullopt;
  const auto first = static_cast<std::size_t>(begin - fixes.begin());
  const auto last = static_cast<std::size_t>(end - fixes.begin()) - 1;
  return leads_along(line->velocity, fixes, first, last) ? std::optional(speed) : std::nullopt;
}

constexpr double kHard = 4;       // m/s^2
constexpr double kStands = 0.01;  // m/s

/// Where the readings of a vehicle that slows down end at a dead zone, or one that starts shows its first.
struct ZoneEdge {
  std::ptrdiff_t at = 0;    ///< the reading beside those of 0
  std::ptrdiff_t step = 1;  ///< to those: 1: later, -1: earlier
  double rate = 0;          ///< by which it slows down in the half second before, m/s^2
  double speed_mps = 0;     ///< in the zone, at the first reading of 0
};

std::optional<ZoneEdge> zone_edge(std::ptrdiff_t at, std::ptrdiff_t step, double zone_mps,
                                  std::span<const OdometrySample> odometry) {
  constexpr double kBefore_s = 0.5;
  constexpr double kGentle = 0.3;  // m/s^2; slower changes say nothing
  constexpr double kSeen = 0.5;    // of the zone: what may pass between two readings
  constexpr double kInside = 0.3;  // of the zone
  const auto size = static_cast<std::ptrdiff_t>(odometry.size());
  const auto sample = [&](std::ptrdiff_t i) -> const OdometrySample& {
    return odometry[static_cast<std::size_t>(i)];
  };
  const auto away_s = [&](std::ptrdiff_t i) {
    return std::abs(seconds_between(sample(at).stamp, sample(i).stamp));
  };
  const double speed = std::abs(sample(at).speed_mps);
  std::ptrdiff_t beyond = at - step;
  while (beyond >= 0 && beyond < size && away_s(beyond) < kBefore_s) beyond -= step;
  if (beyond < 0 || beyond >= size || sample(at).assumed) return std::nullopt;
  const double rate = std::min(kHard, (std::abs(sample(beyond).speed_mps) - speed) / away_s(beyond));
  const double passed = rate * away_s(at + step);
  const double left = std::min(speed - passed, zone_mps);
  const bool leaps = speed - kHard * away_s(at + step) > zone_mps;
  if (leaps || rate < kGentle || passed > kSeen * zone_mps || left < kInside * zone_mps) return std::nullopt;
  return ZoneEdge{at, step, rate, left};
}

/// Tells whether readings differ by less than half the zone: one as large as the steps of the readings is rounding.
bool is_finer_than(double zone_mps, std::span<const OdometrySample> odometry) {
  constexpr double kShare = 0.1;
  double changes = 0;
  double small = 0;
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const double change = std::abs(odometry[i].speed_mps - odometry[i - 1].speed_mps);
    if (change == 0 || odometry[i].speed_mps == 0 || odometry[i - 1].speed_mps == 0) continue;
    ++changes;
    small += change < 0.5 * zone_mps ? 1 : 0;
  }
  return small > kShare * changes;
}

/// Gives the readings of 0 behind an edge the speed that goes on. @returns its way, m
double go_on(const ZoneEdge& edge, std::span<OdometrySample> odometry) {
  const auto size = static_cast<std::ptrdiff_t>(odometry.size());
  const auto sample = [&](std::ptrdiff_t i) -> OdometrySample& {
    return odometry[static_cast<std::size_t>(i)];
  };
  // The way of an even ramp. The rate is a guess, so that it may be as long again.
  const double way_m = 0.5 * edge.speed_mps * edge.speed_mps / edge.rate;
  const double variance_per_s = way_m * way_m / (edge.speed_mps / edge.rate);
  const std::ptrdiff_t first = edge.at + edge.step;
  for (std::ptrdiff_t i = first; i >= 0 && i < size; i += edge.step) {
    const double since_s = std::abs(seconds_between(sample(first).stamp, sample(i).stamp));
    const double left = edge.speed_mps - edge.rate * since_s;
    const bool read_zero = sample(i).speed_mps == 0 || sample(i).distance_variance_per_s > 0;
    if (left <= std::max(kStands, std::abs(sample(i).speed_mps)) || !read_zero) break;
    sample(i).speed_mps = std::copysign(left, sample(edge.at).speed_mps);
    sample(i).distance_variance_per_s = variance_per_s;
  }
  return way_m;
}

}  // namespace

double dead_zone_mps(std::span<const OdometrySample> odometry) {
  constexpr std::size_t kFewestReadings = 100;
  constexpr std::size_t kRare = 1000;  // readings on the way through the zone
  std::vector<double> speeds;
  for (const OdometrySample& sample : odometry)
    if (sample.speed_mps != 0 && !sample.assumed) speeds.push_back(std::abs(sample.speed_mps));
  if (speeds.size() < kFewestReadings) return 0;
  const auto slow = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / kRare);
  std::nth_element(speeds.begin(), slow, speeds.end());
  return *slow >= kLeastZone ? *slow : 0;
}

std::vector<Creeping> find_creeping(std::span<const OdometrySample> odometry, std::span<const Fix> fixes) {
  std::vector<Creeping> found;
  const double zone_mps = dead_zone_mps(odometry);
  if (zone_mps == 0 || fixes.empty()) return found;
  const std::vector<Fix> used = fixes_for_motion(fixes);
  for (std::size_t first = 0; first < odometry.size(); ++first) {
    if (odometry[first].speed_mps != 0 || odometry[first].assumed) continue;
    std::size_t last = first;
    while (last + 1 < odometry.size() && odometry[last + 1].speed_mps == 0) ++last;
    const Stamp from = odometry[first].stamp;
    const Stamp to = odometry[last].stamp;
    if (seconds_between(from, to) >= kShortestCreep_s)
      if (const auto speed = creeping_speed(used, from, to, zone_mps))
        found.push_back({{first, last}, *speed});
    first = last;
  }
  return found;
}

void creep(std::span<const Creeping> found, std::span<OdometrySample> odometry) {
  for (const Creeping& time : found) {
    for (OdometrySample& sample : time.of(odometry)) {
      sample.speed_mps = time.speed_mps;
      sample.assumed = true;
    }
  }
}

PassedZone pass_dead_zone(std::span<OdometrySample> odometry) {
  constexpr double kLargestZone = 2;  // m/s; a drive without slower readings leaps
  constexpr std::size_t kFewestEdges = 5;
  PassedZone passed{dead_zone_mps(odometry), 0, 0};
  if (passed.zone_mps == 0 || passed.zone_mps > kLargestZone || !is_finer_than(passed.zone_mps, odometry))
    return passed;
  std::vector<ZoneEdge> edges;
  std::size_t changes = 0;
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const bool was_zero = odometry[i - 1].speed_mps == 0;
    if (was_zero == (odometry[i].speed_mps == 0)) continue;
    ++changes;
    const auto at = static_cast<std::ptrdiff_t>(was_zero ? i : i - 1);
    if (const auto edge = zone_edge(at, was_zero ? -1 : 1, passed.zone_mps, odometry)) edges.push_back(*edge);
  }
  if (edges.size() < kFewestEdges || 2 * edges.size() < changes) return passed;
  for (const ZoneEdge& edge : edges) passed.way_m += go_on(edge, odometry);
  passed.edges = edges.size();
  return passed;
}

std::string note_of(const PassedZone& passed) {
  return fmt::format(
      "the speed of the odometry reads 0 below {:.2g} m/s; at {} stops and starts it is taken to go on as it came there, "
      "by {:.2g} m in all",
      passed.zone_mps, passed.edges, passed.way_m);
}

std::string warning_of(std::span<const Creeping> found, std::span<const OdometrySample> odometry) {
  double total_s = 0;
  double way_m = 0;
  for (const Creeping& time : found) {
    const double length_s = time.duration_s(odometry);
    total_s += length_s;
    way_m += length_s * time.speed_mps;
  }
  return fmt::format(
      "the speed of the odometry has no readings between 0 and {:.2g} m/s, and the fixes move by {:.0f} m while it "
      "reads 0, in {} {} of {:.0f} s together, the first {:.1f} s after its start: their speed is assumed there, "
      "with the noise of a gap",
      dead_zone_mps(odometry), way_m, found.size(), found.size() == 1 ? "place" : "places", total_s,
      seconds_between(odometry.front().stamp, odometry[found.front().first].stamp));
}

}  // namespace waymark::drive
