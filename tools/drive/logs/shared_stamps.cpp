#include <waymark/tools/drive/logs/shared_stamps.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/detail/median.hpp>
#include <waymark/core/base/error.hpp>

namespace waymark::drive {
namespace {

constexpr std::size_t kFewest = 20;
constexpr std::size_t kShareOf = 5;  // a fifth

/// The fixes of one stamp: places in the list.
struct Group {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool differ = false;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

bool same_position(const GeodeticFix& a, const GeodeticFix& b) {
  return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg;
}

std::vector<Group> groups_of(std::span<const GeodeticFix> fixes) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (i == 0 || fixes[i].stamp != fixes[i - 1].stamp) groups.push_back({i, i, false});
    groups.back().end = i + 1;
    groups.back().differ = groups.back().differ || !same_position(fixes[i], fixes[groups.back().begin]);
  }
  return groups;
}

/// East and north from one fix to another, m.
Eigen::Vector2d way(const GeodeticFix& from, const GeodeticFix& to) {
  constexpr double kEarthRadius = 6'371'008.8;
  const double north = (to.latitude_deg - from.latitude_deg) * kDegree;
  const double east = std::remainder(to.longitude_deg - from.longitude_deg, 360) * kDegree *
                      std::cos(from.latitude_deg * kDegree);
  return kEarthRadius * Eigen::Vector2d(east, north);
}

/// What the fixes of the stamps do while the vehicle moves.
struct Pattern {
  std::size_t moving = 0;  ///< stamps that tell
  /// slope of the way within a stamp, along the way to the next stamp, over that way: (n - 1) / n for n fixes
  /// of one receiver, 0 for two antennas at a constant distance
  double slope = 0;
  double expected_slope = 0;
};

Pattern pattern_of(std::span<const GeodeticFix> fixes, const std::vector<Group>& groups) {
  constexpr double kMoves_m = 2;
  Pattern pattern;
  double x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i + 1 < groups.size(); ++i) {
    const Group& group = groups[i];
    const Eigen::Vector2d ahead = way(fixes[group.begin], fixes[groups[i + 1].begin]);
    if (group.size() < 2 || ahead.norm() < kMoves_m) continue;
    const double along = way(fixes[group.begin], fixes[group.end - 1]).dot(ahead) / ahead.norm();
    ++pattern.moving;
    pattern.expected_slope += 1 - 1 / static_cast<double>(group.size());
    x += ahead.norm();
    y += along;
    xx += ahead.squaredNorm();
    xy += ahead.norm() * along;
  }
  if (pattern.moving == 0) return pattern;
  const auto n = static_cast<double>(pattern.moving);
  pattern.expected_slope /= n;
  const double variance = xx - x * x / n;
  const bool speed_varies = variance > 0.01 * xx;
  pattern.slope = speed_varies ? (xy - x * y / n) / variance : xy / xx;
  return pattern;
}

double median_distance(std::span<const GeodeticFix> fixes, const std::vector<Group>& groups) {
  std::vector<double> distances;
  for (const Group& group : groups)
    if (group.differ) distances.push_back(way(fixes[group.begin], fixes[group.end - 1]).norm());
  return upper_median(std::move(distances));
}

/// Spreads the fixes of a stamp over the time to the next one.
void spread(const std::vector<Group>& groups, std::span<GeodeticFix> fixes) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < groups.size(); ++i)
    intervals.push_back(seconds_between(fixes[groups[i - 1].begin].stamp, fixes[groups[i].begin].stamp));
  const double interval_s = upper_median(std::move(intervals));
  for (const Group& group : groups)
    for (std::size_t i = group.begin; i < group.end; ++i)
      fixes[i].stamp = fixes[i].stamp.later(interval_s * static_cast<double>(i - group.begin) /
                                            static_cast<double>(group.size()));
}

/// The usual case needs no more: fixes that share a stamp follow each other.
std::size_t adjacent_differences(std::span<const GeodeticFix> fixes) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < fixes.size(); ++i)
    count += fixes[i].stamp == fixes[i - 1].stamp && !same_position(fixes[i], fixes[i - 1]);
  return count;
}

/// Tells whether the intervals are a, b, a, b, ...
bool intervals_alternate(std::span<const GeodeticFix> fixes) {
  std::vector<double> of[2];
  for (std::size_t i = 1; i < fixes.size(); ++i)
    of[i % 2].push_back(seconds_between(fixes[i - 1].stamp, fixes[i].stamp));
  const double usual[2] = {upper_median(std::vector<double>(of[0])),
                           upper_median(std::vector<double>(of[1]))};
  constexpr double kDiffer = 0.9;  // 6 Hz in stamps of a tenth are 0.1 and 0.2 s apart
  constexpr double kRegular = 0.1;
  const double mean = (usual[0] + usual[1]) / 2;
  if (!(std::abs(usual[0] - usual[1]) > kDiffer * mean)) return false;
  std::size_t regular = 0;
  for (const std::size_t parity : {0U, 1U})
    for (const double interval : of[parity]) regular += std::abs(interval - usual[parity]) < kRegular * mean;
  return 10 * regular >= 9 * (fixes.size() - 1);
}

/// Tells whether every second position lies aside of those around it.
bool positions_alternate(std::span<const GeodeticFix> fixes) {
  constexpr double kCorrelated = 0.7;
  std::vector<Eigen::Vector2d> seconds;
  for (std::size_t i = 1; i + 1 < fixes.size(); ++i)
    seconds.push_back(way(fixes[i], fixes[i - 1]) + way(fixes[i], fixes[i + 1]));
  double variance = 0;
  double next = 0;
  double behind = 0;
  for (std::size_t i = 0; i + 2 < seconds.size(); ++i) {
    variance += seconds[i].squaredNorm();
    next += seconds[i].dot(seconds[i + 1]);
    behind += seconds[i].dot(seconds[i + 2]);
  }
  return next < -kCorrelated * variance && behind > kCorrelated * variance;
}

}  // namespace

std::string warning_of_turns(std::span<const GeodeticFix> fixes, const std::string& file) {
  constexpr std::size_t kFewestTurns = 40;
  if (fixes.size() < kFewestTurns) return {};
  const bool in_time = intervals_alternate(fixes);
  if (!in_time && !positions_alternate(fixes)) return {};
  return fmt::format(
      "{}: two receivers seem to write into this log in turn, because {}; give each its own entry of 'gnss', with "
      "'where: COLUMN == VALUE' for a table, or with the sentences of one receiver in a log of their own",
      file,
      in_time ? "the intervals of its stamps alternate" : "its positions go to and fro from fix to fix");
}

void settle_shared_stamps(std::span<GeodeticFix> fixes, const std::string& file, PrepareReport& report) {
  if (adjacent_differences(fixes) < kFewest) return;
  const std::vector<GeodeticFix> as_logged(fixes.begin(), fixes.end());
  std::stable_sort(fixes.begin(), fixes.end(),
                   [](const GeodeticFix& a, const GeodeticFix& b) { return a.stamp < b.stamp; });
  const std::vector<Group> groups = groups_of(fixes);
  const auto shared = static_cast<std::size_t>(
      std::count_if(groups.begin(), groups.end(), [](const Group& group) { return group.differ; }));
  const Pattern pattern = pattern_of(fixes, groups);
  if (shared < kFewest || kShareOf * shared < groups.size() || pattern.moving < kFewest / 2) {
    std::copy(as_logged.begin(), as_logged.end(), fixes.begin());
    return;
  }
  if (pattern.slope < 0.5 * pattern.expected_slope)
    throw InputError(fmt::format(
        "{}: several receivers write into this log: {} of {} stamps have more than one position, {:.3g} m apart "
        "in the median; give each its own entry of 'gnss', with 'where: COLUMN == VALUE' for a table, or with "
        "the sentences of one receiver in a log of their own",
        file, shared, groups.size(), median_distance(fixes, groups)));
  spread(groups, fixes);
  report.notes.push_back(fmt::format(
      "{}: the stamps are cut off: {} fixes have {} stamps; those of one stamp are spread evenly over "
      "the time to the next",
      file, fixes.size(), groups.size()));
}

}  // namespace waymark::drive
