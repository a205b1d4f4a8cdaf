#include <waymark/tools/drive/mending/reversing.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/tools/drive/mending/laid_odometry.hpp>
#include <waymark/tools/drive/nodes/yaw_rate_at_rest.hpp>

namespace waymark::drive {
namespace {

constexpr double kShortest_m = 5;
constexpr double kEnd_s = 30;        // the ends of a long way are compared with its neighbours
constexpr double kFurthest_s = 120;  // a gyro drifts
constexpr double kPreference = 0.3;  // for forwards

/// The way between two stops.
struct Way {
  Reversing samples;
  LaidTime begin;
  LaidTime end;
  double length_m = 0;
  std::size_t first_part = 0;  ///< of the odometry, at its begin: parts_of()
  std::size_t last_part = 0;
  bool backwards = false;
};

/// Returns for each sample how many silences of the odometry were before it in which the vehicle may have moved.
/// How it turned then is not known, so the frames of the odometry before and after are two.
std::vector<std::size_t> parts_of(std::span<const OdometrySample> odometry, const LaidOdometry& laid) {
  std::vector<std::size_t> parts(odometry.size(), 0);
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const OdometrySample& before = odometry[i - 1];
    const OdometrySample& after = odometry[i];
    const bool stands =
        std::max(before.speed_mps, after.speed_mps) < kMoves_mps && laid.stays(before.stamp, after.stamp);
    parts[i] = parts[i - 1] + (laid.is_silent_before(i) && !stands ? 1 : 0);
  }
  return parts;
}

std::vector<Way> ways_of(std::span<const OdometrySample> odometry, const LaidOdometry& laid) {
  std::vector<Way> ways;
  const std::vector<std::size_t> parts = parts_of(odometry, laid);
  for (std::size_t first = 0; first < odometry.size(); ++first) {
    if (odometry[first].speed_mps < kMoves_mps) continue;
    std::size_t last = first;
    while (last + 1 < odometry.size() && odometry[last + 1].speed_mps >= kMoves_mps) ++last;
    const Stamp from = odometry[first].stamp;
    const Stamp to = odometry[last].stamp;
    Way way{.samples = {{first, last}},
            .begin = laid.alignment(from, std::min(to, from.later(kEnd_s))),
            .end = laid.alignment(std::max(from, to.later(-kEnd_s)), to),
            .length_m = laid.length_m(first, last),
            .first_part = parts[first],
            .last_part = parts[last]};
    if (way.length_m >= kShortest_m && way.begin.weight_m > 0 && way.end.weight_m > 0) ways.push_back(way);
    first = last;
  }
  return ways;
}

/// How much better a way fits its neighbours in the direction that it has than in the other one.
double fit_of(const std::vector<Way>& ways, std::size_t i, std::span<const OdometrySample> odometry) {
  const double sign = ways[i].backwards ? -1 : 1;
  double fit = sign * kPreference * ways[i].length_m;
  const auto add = [&](const Way& earlier, const Way& later, const Way& other) {
    const double apart_s =
        seconds_between(odometry[earlier.samples.last].stamp, odometry[later.samples.first].stamp);
    if (apart_s > kFurthest_s || earlier.last_part != later.first_part) return;
    const double agree = (later.begin.turn * std::conj(earlier.end.turn)).real();
    fit += sign * (other.backwards ? -1 : 1) * agree * std::min(earlier.end.weight_m, later.begin.weight_m);
  };
  for (std::size_t back = 1; back <= 2; ++back) {
    if (i >= back) add(ways[i - back], ways[i], ways[i - back]);
    if (i + back < ways.size()) add(ways[i], ways[i + back], ways[i + back]);
  }
  return fit;
}

/// Extends a way to where its speed is least, before and after it: there the vehicle stands.
Reversing to_the_stops(Reversing way, std::span<const OdometrySample> odometry) {
  while (way.first > 0 && odometry[way.first - 1].speed_mps > 0 &&
         odometry[way.first - 1].speed_mps <= odometry[way.first].speed_mps)
    --way.first;
  while (way.last + 1 < odometry.size() && odometry[way.last + 1].speed_mps > 0 &&
         odometry[way.last + 1].speed_mps <= odometry[way.last].speed_mps)
    ++way.last;
  return way;
}

}  // namespace

std::vector<Reversing> find_reversing(std::span<const OdometrySample> odometry, std::span<const Fix> fixes) {
  const bool has_sign = std::any_of(odometry.begin(), odometry.end(),
                                    [](const OdometrySample& sample) { return sample.speed_mps < 0; });
  if (has_sign || fixes.empty()) return {};
  std::vector<Way> ways = ways_of(odometry, LaidOdometry::without_drift(odometry, fixes));
  // Each turn makes the whole fit better, so that the loop ends.
  for (std::size_t turns = 0; turns < ways.size(); ++turns) {
    std::size_t worst = ways.size();
    double least = 0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const double fit = fit_of(ways, i, odometry);
      if (fit >= least) continue;
      least = fit;
      worst = i;
    }
    if (worst == ways.size()) break;
    ways[worst].backwards = !ways[worst].backwards;
  }
  std::vector<Reversing> found;
  for (const Way& way : ways)
    if (way.backwards) found.push_back(to_the_stops(way.samples, odometry));
  return found;
}

void drive_backwards(std::span<const Reversing> found, std::span<OdometrySample> odometry) {
  const bool is_derived = yaw_rate_at_rest(odometry).is_derived();
  for (const Reversing& time : found) {
    for (OdometrySample& sample : time.of(odometry)) {
      sample.speed_mps = -sample.speed_mps;
      if (is_derived) sample.yaw_rate_radps = -sample.yaw_rate_radps;
    }
  }
}

std::string warning_of(std::span<const Reversing> found, std::span<const OdometrySample> odometry) {
  std::string times;
  constexpr std::size_t kMost = 5;
  for (std::size_t i = 0; i < std::min(found.size(), kMost); ++i)
    times += fmt::format("{}{:.1f} to {:.1f} s", i == 0 ? "" : ", ",
                         seconds_between(odometry.front().stamp, odometry[found[i].first].stamp),
                         seconds_between(odometry.front().stamp, odometry[found[i].last].stamp));
  if (found.size() > kMost) times += fmt::format(" and {} more times", found.size() - kMost);
  return fmt::format(
      "no speed of the odometry is negative, but the fixes move backwards {} after its start: the vehicle is "
      "taken to reverse there; give the speed its sign (a column or signal of the gear or the direction)",
      times);
}

}  // namespace waymark::drive
