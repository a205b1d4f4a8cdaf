#include <waymark/tools/drive/comparison/precise_jumps.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Geometry>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

constexpr double kLongestStep_s = 5;
constexpr double kBeside_s = 10;

/// What a step of the fixes leaves beside that of the odometry.
struct Left {
  bool is_known = false;
  Eigen::Vector2d by = Eigen::Vector2d::Zero();  ///< m, in the frame of the vehicle at the step's beginning
  double turned_rad = 0;                         ///< from that frame to the frame of the fixes
};

/// Returns the way of the odometry from the first fix to each one, m.
std::vector<double> ways_of(const ReckonedFixes& receiver) {
  std::vector<double> ways(receiver.fixes.size());
  for (std::size_t i = 1; i < ways.size(); ++i)
    ways[i] = ways[i - 1] + chord_between(receiver, i - 1, i).odometry.norm();
  return ways;
}

/// How the odometry lies in the fixes.
struct Lie {
  double turned_rad = 0;  ///< of the fixes against it
  double scale = 1;       ///< of the fixes by it
};

/// Returns how the odometry lies around the step to fix i, without that step. Empty if the vehicle drives too little
/// before and after it.
std::optional<Lie> lie_around(const ReckonedFixes& receiver, const std::vector<double>& ways, std::size_t i) {
  constexpr double kWay_m = 30;
  constexpr double kShortest_m = 10;
  constexpr double kLonger = 2;
  const auto is_long = [](const ChordPair& chord) { return chord.odometry.norm() >= kShortest_m; };
  const auto begin = ways.begin();
  const auto from = static_cast<std::size_t>(
      std::max<std::ptrdiff_t>(0, std::upper_bound(begin, ways.end(), ways[i - 1] - kWay_m) - begin - 1));
  const auto to =
      std::min(ways.size() - 1,
               static_cast<std::size_t>(std::lower_bound(begin, ways.end(), ways[i] + kWay_m) - begin));
  ChordPair before = chord_between(receiver, from, i - 1);
  ChordPair after = chord_between(receiver, i, to);
  // In a stop the bias of a gyro turns the odometry.
  if (before.duration_s > kLonger * after.duration_s && is_long(after)) before = {};
  if (after.duration_s > kLonger * before.duration_s && is_long(before)) after = {};
  const Eigen::Vector2d odometry = before.odometry + after.odometry;
  const Eigen::Vector2d gnss = before.gnss + after.gnss;
  if (odometry.norm() < kShortest_m || gnss.norm() < kShortest_m) return std::nullopt;
  return Lie{angle_between(odometry, gnss), gnss.norm() / odometry.norm()};
}

/// Returns what the step to each fix leaves; that to the first one is not known.
std::vector<Left> left_of_steps(const ReckonedFixes& receiver) {
  const std::vector<double> ways = ways_of(receiver);
  std::vector<Left> left(receiver.fixes.size());
  for (std::size_t i = 1; i < left.size(); ++i) {
    const ChordPair step = chord_between(receiver, i - 1, i);
    if (step.duration_s > kLongestStep_s) continue;
    const std::optional<Lie> lie = lie_around(receiver, ways, i);
    if (!lie) continue;
    const double heading_rad = receiver.antenna[i - 1][2];
    const double turned_rad = lie->turned_rad + heading_rad;
    left[i] = {true,
               rotate_back(turned_rad, step.gnss) - lie->scale * rotate_back(heading_rad, step.odometry),
               turned_rad};
  }
  return left;
}

/// The steps beside one: at most ten before and ten after it, within 10 s.
std::vector<Eigen::Vector2d> beside(const ReckonedFixes& receiver, const std::vector<Left>& left,
                                    std::size_t i) {
  constexpr std::size_t kMost = 10;
  std::vector<Eigen::Vector2d> kept;
  const auto add = [&](std::size_t j) {
    if (std::abs(seconds_between(receiver.fixes[i].stamp, receiver.fixes[j].stamp)) > kBeside_s) return false;
    if (left[j].is_known) kept.push_back(left[j].by);
    return true;
  };
  for (std::size_t j = i; j-- > 1 && i - j <= kMost && add(j);) {
  }
  for (std::size_t j = i + 1; j < left.size() && j - i <= kMost && add(j); ++j) {
  }
  return kept;
}

/// Returns the median of each coordinate.
Eigen::Vector2d median_of(const std::vector<Eigen::Vector2d>& steps) {
  std::vector<double> along;
  std::vector<double> across;
  for (const Eigen::Vector2d& step : steps) {
    along.push_back(step.x());
    across.push_back(step.y());
  }
  return {upper_median(std::move(along)), upper_median(std::move(across))};
}

/// A step beside those around it.
struct Unusual {
  Eigen::Vector2d by = Eigen::Vector2d::Zero();  ///< m, in the frame of the vehicle
  double around_m = 0;                           ///< the largest of those around it
};

std::optional<Unusual> unusual(const ReckonedFixes& receiver, const std::vector<Left>& left, std::size_t i) {
  constexpr std::size_t kFewest = 6;
  if (!left[i].is_known) return std::nullopt;
  const std::vector<Eigen::Vector2d> around = beside(receiver, left, i);
  if (around.size() < kFewest) return std::nullopt;
  const Eigen::Vector2d usual = median_of(around);
  double largest_m = 0;
  for (const Eigen::Vector2d& step : around) largest_m = std::max(largest_m, (step - usual).norm());
  return Unusual{left[i].by - usual, largest_m};
}

/// Returns what a fix and the one before it claim, m. Empty if one claims nothing, or no more than a usual receiver.
std::optional<double> precise_claim_m(const ReckonedFixes& receiver, std::size_t i) {
  constexpr double kPrecise_m = 1;
  const Fix& before = receiver.fixes[i - 1];
  const Fix& after = receiver.fixes[i];
  const double claimed_m = std::max(before.accuracy_m(), after.accuracy_m());
  if (!before.accuracy_claimed || !after.accuracy_claimed || claimed_m >= kPrecise_m) return std::nullopt;
  return claimed_m;
}

}  // namespace

std::vector<Jump> precise_jumps_of(const ReckonedFixes& receiver) {
  constexpr double kSigmas = 15;
  constexpr double kSmallest_m = 0.2;
  constexpr double kThird = 1.0 / 3;
  constexpr double kUnusual = 3;
  constexpr std::size_t kFewest = 100;
  std::vector<std::optional<double>> claims_m(receiver.fixes.size());
  for (std::size_t i = 1; i < claims_m.size(); ++i) claims_m[i] = precise_claim_m(receiver, i);
  if (std::count_if(claims_m.begin(), claims_m.end(), [](const auto& claim) { return claim.has_value(); }) <
      static_cast<std::ptrdiff_t>(kFewest))
    return {};

  const std::vector<Left> left = left_of_steps(receiver);
  std::vector<std::optional<Unusual>> steps(left.size());
  std::vector<double> sizes_m;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    if (claims_m[i]) steps[i] = unusual(receiver, left, i);
    if (steps[i]) sizes_m.push_back(steps[i]->by.norm());
  }
  if (sizes_m.size() < kFewest) return {};
  const auto all_but_few = sizes_m.begin() + std::ssize(sizes_m) * 98 / 100;
  std::nth_element(sizes_m.begin(), all_but_few, sizes_m.end());

  std::vector<Jump> jumps;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    if (!steps[i]) continue;
    const double size_m = steps[i]->by.norm();
    const double least_m = std::max({kSmallest_m, kSigmas * *claims_m[i], kUnusual * *all_but_few});
    if (size_m < least_m || steps[i]->around_m > kThird * size_m) continue;
    jumps.push_back({.first = i,
                     .settled = i,
                     .by = rotate(left[i].turned_rad, steps[i]->by),
                     .claimed_m = *claims_m[i]});
  }
  return jumps;
}

}  // namespace waymark::drive
