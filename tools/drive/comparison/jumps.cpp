#include <waymark/tools/drive/comparison/jumps.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/tools/drive/comparison/precise_jumps.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

/// Times that a slide may take.
constexpr std::array<double, 3> kSlides_s = {5, 10, 20};
/// The fixes stay for so long on both sides of a jump.
constexpr double kSettled_s = 10;
/// What takes longer than from a fix to the next one is so many times what is usual.
constexpr double kUnusual = 5;
/// Of a jump: what the fixes beside it may differ from the odometry.
constexpr double kQuarter = 0.25;

double disagreement(const ReckonedFixes& receiver, std::size_t first, std::size_t last) {
  const ChordPair pair = chord_between(receiver, first, last);
  return std::abs(pair.gnss.norm() - pair.odometry.norm());
}

double seconds_from(const ReckonedFixes& receiver, std::size_t first, std::size_t last) {
  return seconds_between(receiver.fixes[first].stamp, receiver.fixes[last].stamp);
}

/// Returns the fix 10 s before (step -1) or after (step 1) another one. Empty if the log ends earlier.
std::optional<std::size_t> fix_10_s_from(const ReckonedFixes& receiver, std::size_t from, int step) {
  for (auto i = static_cast<std::ptrdiff_t>(from); i >= 0 && i < std::ssize(receiver.fixes); i += step) {
    const auto at = static_cast<std::size_t>(i);
    if (std::abs(seconds_from(receiver, from, at)) >= kSettled_s) return at;
  }
  return std::nullopt;
}

/// Tells whether all fixes from `first` to `last` are as far from `from` as the odometry says.
bool agree(const ReckonedFixes& receiver, std::size_t from, std::size_t first, std::size_t last,
           double tolerance_m) {
  for (std::size_t i = first; i <= last; ++i)
    if (disagreement(receiver, from, i) >= tolerance_m) return false;
  return true;
}

/// Returns the size from which a chord between two fixes is no noise of them.
double least_m(const ReckonedFixes& receiver, std::size_t from, std::size_t to) {
  constexpr double kSmallest_m = 20;
  constexpr double kSigmas = 5;
  return std::max(kSmallest_m,
                  kSigmas * std::max(receiver.fixes[to].accuracy_m(), receiver.fixes[from].accuracy_m()));
}

/// Returns the part of a chord that the odometry does not explain, if the fixes are turned by an angle against it.
Eigen::Vector2d unexplained(const ChordPair& step, double angle) {
  return step.gnss - Eigen::Rotation2Dd(angle) * step.odometry;
}

/// Returns the jump to fix i from the one before it. Empty if there is none.
std::optional<Jump> jump_to(const ReckonedFixes& receiver, std::size_t i) {
  constexpr double kLongest_s = 5;
  if (seconds_from(receiver, i - 1, i) > kLongest_s) return std::nullopt;
  const ChordPair step = chord_between(receiver, i - 1, i);
  double least = least_m(receiver, i - 1, i);
  if (step.gnss.norm() + step.odometry.norm() < least) return std::nullopt;
  const std::optional<std::size_t> before = fix_10_s_from(receiver, i - 1, -1);
  const std::optional<std::size_t> after = fix_10_s_from(receiver, i, 1);
  if (!before || !after) return std::nullopt;
  const ChordPair way = chord_between(receiver, *before, i - 1);
  const double step_m = step.odometry.norm();
  const double way_m = way.odometry.norm();
  // A short way turns a long step by what its fixes are off.
  if (step_m > way_m) least += std::min(2 * step_m, least * step_m / way_m);
  const Eigen::Vector2d by = unexplained(step, angle_between(way.odometry, way.gnss));
  const double tolerance_m = kQuarter * by.norm();
  if (by.norm() < least || !agree(receiver, i - 1, *before, i - 1, tolerance_m) ||
      !agree(receiver, i, i, *after, tolerance_m))
    return std::nullopt;
  return Jump{.first = i, .settled = i, .by = by};
}

/// How the odometry lies along the fixes on one side of a moment.
struct Side {
  double angle = std::numeric_limits<double>::quiet_NaN();   ///< by which the fixes are turned against it
  double way_m = 0;                                          ///< that shows the angle, of the odometry
  double usual_m = std::numeric_limits<double>::infinity();  ///< four in five differ by at most that
};

/// What the odometry does not explain between two fixes further apart than neighbours.
struct Residual {
  std::size_t from = 0;
  std::size_t to = 0;
  Eigen::Vector2d by = Eigen::Vector2d::Zero();
  double beside_m = 0;  ///< the larger Side::usual_m before and after it
  double way_m = 0;     ///< of the odometry
  double levers = 0;    ///< of its ways, by those that show how it lies: errors at these turn the others
};

/// How large residuals usually are while the vehicle moves. Infinite if few are known.
struct Usual {
  double size_m = std::numeric_limits<double>::infinity();
  double per_metre = 0;  ///< of the way: headings that wander leave more on a fast road

  /// Where the speed varies little on a drive both are the same; on such a way alone less is unusual: 3.8 times
  /// the median of a normal distribution in the plane is exceeded once in 20,000 times.
  [[nodiscard]] double on(double way_m) const {
    constexpr double kOfWay = 3.8 / kUnusual;
    return std::max(size_m, kOfWay * per_metre * way_m);
  }
};

/// Returns fixes at least half a second apart.
std::vector<std::size_t> sparse_fixes(const ReckonedFixes& receiver) {
  constexpr double kApart_s = 0.5;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < receiver.fixes.size(); ++i)
    if (kept.empty() || seconds_from(receiver, kept.back(), i) >= kApart_s) kept.push_back(i);
  return kept;
}

/// Returns how far four in five ways of the fixes are at most from those of the odometry.
double four_fifths(const std::vector<ChordPair>& ways, double angle) {
  std::vector<double> sizes;
  for (const ChordPair& way : ways) sizes.push_back(unexplained(way, angle).norm());
  const auto place = sizes.begin() + std::ssize(sizes) * 4 / 5;
  std::nth_element(sizes.begin(), place, sizes.end());
  return *place;
}

/// Between fixes further apart (a tunnel) the odometry may have turned by the bias of its gyro.
constexpr double kGap_s = 20;

/// Returns the ways to the kept fixes before (step -1) or after (step 1) one of them: as far as 200 m, at least
/// 20 s (in a shorter time a slide looks like a turned way), at most a minute, and to the next gap.
std::vector<ChordPair> ways_beside(const ReckonedFixes& receiver, const std::vector<std::size_t>& kept,
                                   std::ptrdiff_t from, int step) {
  constexpr double kWay_m = 200;
  constexpr double kShortest_s = 20;
  constexpr double kLongest_s = 60;
  const std::size_t here = kept[static_cast<std::size_t>(from)];
  std::vector<ChordPair> ways;
  for (std::ptrdiff_t j = from + step; j >= 0 && j < std::ssize(kept); j += step) {
    const std::size_t there = kept[static_cast<std::size_t>(j)];
    const double apart_s = std::abs(seconds_from(receiver, here, there));
    const std::size_t nearer = kept[static_cast<std::size_t>(j - step)];
    if (apart_s > kLongest_s || std::abs(seconds_from(receiver, nearer, there)) > kGap_s) break;
    ways.push_back(chord_between(receiver, here, there));
    if (apart_s >= kShortest_s && ways.back().odometry.norm() >= kWay_m) break;
  }
  return ways;
}

/// Lays the odometry along the fixes on one side of each of the kept ones. Where the vehicle stands, the angle is
/// the last one known on the same side of a gap.
std::vector<Side> sides_of(const ReckonedFixes& receiver, const std::vector<std::size_t>& kept, int step) {
  constexpr double kShortest_m = 30;
  const auto count = std::ssize(kept);
  const auto is_shorter = [](const ChordPair& a, const ChordPair& b) {
    return a.odometry.norm() < b.odometry.norm();
  };
  std::vector<Side> sides(kept.size());
  Side known;
  for (std::ptrdiff_t n = 0; n < count; ++n) {
    const std::ptrdiff_t i = step < 0 ? n : count - 1 - n;
    const std::vector<ChordPair> ways = ways_beside(receiver, kept, i, step);
    if (ways.empty()) {  // the first fix after a gap, or of all
      known = {};
      continue;
    }
    const ChordPair& longest = *std::max_element(ways.begin(), ways.end(), is_shorter);
    const double way_m = longest.odometry.norm();
    if (way_m >= kShortest_m) known = {angle_between(longest.odometry, longest.gnss), way_m};
    known.usual_m = four_fifths(ways, known.angle);
    sides[static_cast<std::size_t>(i)] = known;
  }
  return sides;
}

/// Returns what the odometry does not explain in a time, from every kept fix. It is laid along the fixes before as
/// far as the middle, and from there along those after.
std::vector<Residual> residuals_over(double slide_s, const ReckonedFixes& receiver,
                                     const std::vector<std::size_t>& kept, const std::vector<Side>& before,
                                     const std::vector<Side>& after) {
  constexpr double kLongest_s = 30;
  std::vector<Residual> residuals;
  std::size_t to = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    while (to < kept.size() && seconds_from(receiver, kept[i], kept[to]) < slide_s) ++to;
    if (to == kept.size()) break;
    const double angle = before[i].angle;
    const double turned = after[to].angle;
    if (!std::isfinite(angle) || !std::isfinite(turned)) continue;
    if (seconds_from(receiver, kept[i], kept[to]) > kLongest_s) continue;
    const ChordPair step = chord_between(receiver, kept[i], kept[to]);
    const Eigen::Vector2d middle = receiver.antenna[kept[(i + to) / 2]].head<2>();
    const Eigen::Vector2d first = middle - receiver.antenna[kept[i]].head<2>();
    const Eigen::Vector2d second = receiver.antenna[kept[to]].head<2>() - middle;
    residuals.push_back({kept[i], kept[to],
                         step.gnss - Eigen::Rotation2Dd(angle) * first - Eigen::Rotation2Dd(turned) * second,
                         std::max(before[i].usual_m, after[to].usual_m), step.odometry.norm(),
                         first.norm() / before[i].way_m + second.norm() / after[to].way_m});
  }
  return residuals;
}

Usual usual_of(const std::vector<Residual>& residuals) {
  constexpr double kMoves_m = 20;
  constexpr std::size_t kFewest = 20;
  std::vector<double> sizes;
  std::vector<double> per_metre;
  for (const Residual& residual : residuals) {
    if (residual.way_m < kMoves_m) continue;
    sizes.push_back(residual.by.norm());
    per_metre.push_back(residual.by.norm() / residual.way_m);
  }
  if (sizes.size() < kFewest) return {};
  return {upper_median(std::move(sizes)), upper_median(std::move(per_metre))};
}

/// Returns what may be a jump that takes longer than from a fix to the next one, the clearest first.
std::vector<Jump> slides_of(const ReckonedFixes& receiver) {
  constexpr double kLever = 3;  // a way turned by what is usual on shorter ones
  const std::vector<std::size_t> kept = sparse_fixes(receiver);
  const std::vector<Side> before = sides_of(receiver, kept, -1);
  const std::vector<Side> after = sides_of(receiver, kept, 1);
  std::vector<Jump> slides;
  for (const double slide_s : kSlides_s) {
    const std::vector<Residual> residuals = residuals_over(slide_s, receiver, kept, before, after);
    const Usual usual = usual_of(residuals);
    for (const auto& [from, to, by, beside_m, way_m, levers] : residuals) {
      const double usual_m = usual.on(way_m);
      const double least =
          std::max(1.0, levers / kLever) * std::max(kUnusual * usual_m, least_m(receiver, from, to));
      if (by.norm() < least || beside_m > kQuarter * by.norm()) continue;
      slides.push_back({.first = from + 1, .settled = to, .by = by, .usual_m = usual_m});
    }
  }
  const auto clearness = [](const Jump& slide) { return slide.by.norm() / slide.usual_m; };
  std::stable_sort(slides.begin(), slides.end(),
                   [&](const Jump& a, const Jump& b) { return clearness(a) > clearness(b); });
  return slides;
}

/// Adds those that are not within 10 s of a jump or a clearer one: the fixes beside a slide slide too.
void add_others(const ReckonedFixes& receiver, const std::vector<Jump>& others, std::vector<Jump>& jumps) {
  for (const Jump& other : others) {
    const bool is_known = std::any_of(jumps.begin(), jumps.end(), [&](const Jump& jump) {
      return seconds_from(receiver, other.settled, jump.first) <= kSettled_s &&
             seconds_from(receiver, jump.settled, other.first) <= kSettled_s;
    });
    if (!is_known) jumps.push_back(other);
  }
  std::sort(jumps.begin(), jumps.end(), [](const Jump& a, const Jump& b) { return a.first < b.first; });
}

/// Tells whether the second of two jumps takes the fixes back.
bool undoes(const Jump& second, const Jump& first) {
  constexpr double kUsual = 3;
  constexpr double kHalf = 0.5;
  const double size_m = first.by.norm();
  const double uncertain_m = kUsual * std::hypot(first.usual_m, second.usual_m);
  return (first.by + second.by).norm() <= std::clamp(uncertain_m, kQuarter * size_m, kHalf * size_m);
}

/// Judges jumps of which each undoes the one before. Two of them enclose the wrong fixes, if these are less
/// than half of the log. More have the fixes at two places in turn, and the end of one burst looks like the
/// beginning of another: fixes at one of them are wrong only if those at the other last twice as long.
void mark_undone(const ReckonedFixes& receiver, std::size_t first, std::size_t last,
                 std::vector<Jump>& jumps) {
  constexpr double kClear = 2;
  const std::vector<Fix>& fixes = receiver.fixes;
  if (last == first) return;
  if (last == first + 1) {
    jumps[first].undone =
        jumps[first].stays_s < 0.5 * seconds_between(fixes.front().stamp, fixes.back().stamp);
    return;
  }
  const Stamp begin = first == 0 ? fixes.front().stamp : fixes[jumps[first - 1].first].stamp;
  double near_s = seconds_between(begin, fixes[jumps[first].first].stamp);  // where the fixes come from
  double away_s = 0;
  for (std::size_t j = first; j <= last; ++j) ((j - first) % 2 == 0 ? away_s : near_s) += jumps[j].stays_s;
  const bool is_away_wrong = kClear * away_s <= near_s;
  if (!is_away_wrong && kClear * near_s > away_s) return;
  for (std::size_t j = is_away_wrong ? first : first + 1; j < last; j += 2) jumps[j].undone = true;
}

/// Judges the jumps of one kind, in order.
void judge(const ReckonedFixes& receiver, std::vector<Jump>& jumps) {
  const std::size_t count = receiver.fixes.size();
  for (std::size_t j = 0; j < jumps.size(); ++j) {
    jumps[j].end = j + 1 < jumps.size() ? jumps[j + 1].settled : count;
    jumps[j].stays_s = seconds_from(receiver, jumps[j].first, std::min(jumps[j].end, count - 1));
  }
  for (std::size_t first = 0; first < jumps.size();) {
    std::size_t last = first;
    while (last + 1 < jumps.size() && undoes(jumps[last + 1], jumps[last])) ++last;
    mark_undone(receiver, first, last, jumps);
    first = last + 1;
  }
}

/// Tells whether the odometry turns at most bends of the fixes, or they have few. One with a dead gyro does not, and
/// the fixes jump at each bend.
bool turns_with_fixes(const ReckonedFixes& receiver) {
  constexpr double kLeg_m = 60;
  constexpr double kLongest_s = 60;
  constexpr double kBend_rad = 0.5;
  constexpr std::size_t kFewest = 5;
  const auto is_driven =
      [](const ChordPair& leg) {  // jumps make the way of the fixes longer, bends make it shorter
        const double ratio = leg.odometry.norm() / leg.gnss.norm();
        return ratio > 0.9 && ratio < 1.6;
      };
  std::size_t bends = 0;
  std::size_t followed = 0;
  const auto is_complete = [](const ChordPair& chord) { return chord.gnss.norm() >= kLeg_m; };
  const std::vector<ChordPair> legs = chords_of(receiver, kLongest_s, is_complete);
  for (std::size_t i = 1; i < legs.size(); ++i) {
    const double turn = angle_between(legs[i - 1].gnss, legs[i].gnss);
    if (!legs[i].follows || std::abs(turn) < kBend_rad || !is_driven(legs[i - 1]) || !is_driven(legs[i]))
      continue;
    ++bends;
    followed += std::abs(turns_apart(legs[i - 1], legs[i])) < 0.5 * std::abs(turn);
  }
  return bends < kFewest || 2 * followed >= bends;
}

}  // namespace

std::vector<Jump> jumps_of(const ReckonedFixes& receiver) {
  if (!turns_with_fixes(receiver)) return {};
  std::vector<Jump> jumps;
  for (std::size_t i = 1; i < receiver.fixes.size(); ++i)
    if (const std::optional<Jump> jump = jump_to(receiver, i)) jumps.push_back(*jump);
  add_others(receiver, slides_of(receiver), jumps);
  judge(receiver, jumps);
  std::vector<Jump> precise = precise_jumps_of(receiver);
  judge(receiver, precise);
  add_others(receiver, precise, jumps);
  return jumps;
}

}  // namespace waymark::drive
