#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/tools/drive/nodes/plausibility.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kLongestChord_s = 5;
constexpr double kShortestChord_s = 0.95;
constexpr double kShortestChord_m = 5;  // a shorter one is mainly noise of its fixes
constexpr std::size_t kFewestChords = 20;
constexpr std::size_t kFewestTurns = 10;
constexpr double kLargestFactor = 1.5;
constexpr double kSmallestTurn = 5 * std::numbers::pi / 180;
constexpr double kOppositeSigns = -0.3;

/// The distance between two fixes of the first receiver.
struct ChordPair {
  Eigen::Vector2d gnss;
  Eigen::Vector2d odometry;
  bool follows = false;  ///< it begins at the end of the previous chord
};

/// Returns chords that are long enough, whatever the rate of the fixes. Each is extended until it
/// spans a second and is no longer mainly noise, at most for kLongestChord_s.
std::vector<ChordPair> chords_of(std::span<const Fix> fixes, std::span<const Eigen::Vector3d> antenna) {
  std::vector<ChordPair> chords;
  std::size_t first = fixes.size();
  bool unbroken = false;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].source != fixes.front().source) continue;
    const double elapsed_s = first < fixes.size() ? seconds_between(fixes[first].stamp, fixes[i].stamp) : 0;
    if (first == fixes.size() || elapsed_s > kLongestChord_s) {
      first = i;
      unbroken = false;
      continue;
    }
    const Eigen::Vector2d gnss = fixes[i].position - fixes[first].position;
    if (elapsed_s < kShortestChord_s || gnss.norm() < kShortestChord_m) continue;
    chords.push_back({gnss, antenna[i].head<2>() - antenna[first].head<2>(), unbroken});
    unbroken = true;
    first = i;
  }
  return chords;
}

bool is_long(const ChordPair& chord) {
  return chord.gnss.norm() >= kShortestChord_m && chord.odometry.norm() >= 0.1 * kShortestChord_m;
}

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
}

}  // namespace

std::vector<std::string> compare_odometry_with_fixes(std::span<const Fix> fixes,
                                                     std::span<const Eigen::Vector3d> antenna) {
  std::vector<std::string> warnings;
  const std::vector<ChordPair> chords = chords_of(fixes, antenna);
  std::vector<double> factors;
  double gnss_squared = 0;
  double odometry_squared = 0;
  double product = 0;
  std::size_t turns = 0;
  for (std::size_t i = 0; i < chords.size(); ++i) {
    if (!is_long(chords[i])) continue;
    factors.push_back(chords[i].odometry.norm() / chords[i].gnss.norm());
    if (!chords[i].follows || !is_long(chords[i - 1])) continue;
    const double odometry_turn = turn(chords[i - 1].odometry, chords[i].odometry);
    if (std::abs(odometry_turn) < kSmallestTurn) continue;
    const double gnss_turn = turn(chords[i - 1].gnss, chords[i].gnss);
    gnss_squared += gnss_turn * gnss_turn;
    odometry_squared += odometry_turn * odometry_turn;
    product += gnss_turn * odometry_turn;
    ++turns;
  }
  if (factors.size() >= kFewestChords) {
    const auto middle = factors.begin() + static_cast<std::ptrdiff_t>(factors.size() / 2);
    std::nth_element(factors.begin(), middle, factors.end());
    if (*middle > kLargestFactor || *middle < 1 / kLargestFactor) {
      warnings.push_back(fmt::format(
          "the odometry's distance between fixes is {:.2f} times the distance of the fixes (median "
          "of {}); check the unit of the speed ({})",
          *middle, factors.size(),
          *middle > 1 ? "3.6: km/h read as m/s"
                      : "0.28: m/s read as km/h; otherwise the odometry stands still, or the "
                        "coordinates have few digits"));
    }
  }
  if (turns >= kFewestTurns && product < kOppositeSigns * std::sqrt(gnss_squared * odometry_squared)) {
    warnings.push_back(fmt::format(
        "the odometry turns against the fixes (correlation {:.2f} over {} turns); if the yaw rate "
        "is positive clockwise, state 'convention: cw'",
        product / std::sqrt(gnss_squared * odometry_squared), turns));
  }
  return warnings;
}

}  // namespace waymark::drive
