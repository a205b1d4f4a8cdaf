#include <waymark/tools/drive/comparison/turn_factor.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include <waymark/core/base/detail/median.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {
namespace {

/// A turn from one straight chord to the next one.
struct Turn {
  double odometry_rad = 0;
  double gnss_rad = 0;  ///< without whole turns that the odometry does not show
  double duration_s = 0;
};

/// Turns between chords that are nearly straight, whatever lies between them: along a bend the direction of a chord
/// depends on where its ends are, and so on the delay of the fixes.
std::vector<Turn> turns_along(const ReckonedFixes& receiver, double length_m) {
  constexpr double kLongest_s = 30;
  constexpr double kLongestTurn_s = 60;
  constexpr double kStraight_rad = 0.6;
  std::vector<ChordPair> chords =
      chords_of(receiver, kLongest_s, [&](const ChordPair& chord) { return chord.gnss.norm() >= length_m; });
  std::erase_if(chords, [](const ChordPair& chord) { return std::abs(chord.turn_rad) > kStraight_rad; });
  std::vector<Turn> turns;
  for (std::size_t i = 1; i < chords.size(); ++i) {
    const ChordPair& one = chords[i - 1];
    const ChordPair& next = chords[i];
    const double duration_s = next.middle_s - one.middle_s;
    if (duration_s > kLongestTurn_s) continue;
    const double heading = next.heading_rad - one.heading_rad;
    const double odometry = heading + wrap_angle(angle_between(one.odometry, next.odometry) - heading);
    turns.push_back({odometry, odometry - turns_apart(one, next), duration_s});
  }
  return turns;
}

/// The slope of a line y = slope x + rate t, and its standard deviation.
struct Slope {
  double value = 0;
  double sigma = 0;
};

/// Fits a line robustly (Huber's weights, iterated). Its deviation is that of the residuals where they are, because
/// turns err by more than straight ways do (White 1980). @param x, y, t of the same size, at least 3
std::optional<Slope> slope_of(const Eigen::VectorXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& t) {
  constexpr int kIterations = 20;
  constexpr double kHuber = 1.345;
  constexpr double kLeastSpread = 0.01;  // rad: no chord shows a heading better
  Eigen::Matrix<double, Eigen::Dynamic, 2> columns(x.size(), 2);
  columns << x, t;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(x.size());
  Slope slope;
  for (int i = 0; i < kIterations; ++i) {
    const auto weighted = (weights.asDiagonal() * columns).eval();
    const Eigen::Matrix2d normal = columns.transpose() * weighted;
    if (!(normal.determinant() > 1e-12 * normal(0, 0) * normal(1, 1))) return std::nullopt;
    const Eigen::Matrix2d inverse = normal.inverse();
    const Eigen::Vector2d found = inverse * (weighted.transpose() * y);
    const Eigen::VectorXd apart = (y - columns * found).cwiseAbs();
    const auto influence = (apart.asDiagonal() * weighted * inverse).eval();
    slope = {found[0], influence.col(0).norm()};
    const double spread = std::max(
        kLeastSpread, 1.4826 * upper_median<double>({apart.begin(), apart.end()}));  // of a normal one
    weights = (kHuber * spread / apart.array().max(kHuber * spread)).matrix();
  }
  return slope;
}

/// The turns of the odometry per turn of the fixes, if neither the fixes nor the odometry had errors of their own.
struct Bounds {
  Slope by_odometry;  ///< errors of the odometry make it larger
  Slope by_gnss;      ///< errors of the fixes make it smaller
};

std::optional<Bounds> bounds_of(std::span<const Turn> turns) {
  const auto count = static_cast<Eigen::Index>(turns.size());
  Eigen::VectorXd odometry(count);
  Eigen::VectorXd gnss(count);
  Eigen::VectorXd duration(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Turn& turn = turns[static_cast<std::size_t>(i)];
    odometry[i] = turn.odometry_rad;
    gnss[i] = turn.gnss_rad;
    duration[i] = turn.duration_s;
  }
  const std::optional<Slope> forward = slope_of(odometry, gnss, duration);
  const std::optional<Slope> backward = slope_of(gnss, odometry, duration);
  if (!forward || !backward || !(forward->value > 0) || !(backward->value > 0)) return std::nullopt;
  const double inverse = 1 / forward->value;
  return Bounds{{inverse, forward->sigma * inverse * inverse}, *backward};
}

Slope times(double factor, const Slope& slope) {
  return {factor * slope.value, factor * slope.sigma};
}

/// Returns which of both says less, if both say it. The deviation of few turns says little, so they must differ by more.
std::optional<Slope> agreed(const Bounds& bounds, std::size_t turns) {
  constexpr double kSigmas = 5;
  const double usual = 0.04 * (1 + 12 / static_cast<double>(turns));
  const auto is_wrong = [&](const Slope& slope) {
    return std::abs(std::log(slope.value)) > std::log1p(usual) &&
           std::abs(slope.value - 1) > kSigmas * slope.sigma;
  };
  if (!is_wrong(bounds.by_odometry) || !is_wrong(bounds.by_gnss)) return std::nullopt;
  if ((bounds.by_odometry.value > 1) != (bounds.by_gnss.value > 1)) return std::nullopt;
  const bool odometry_says_less = std::abs(bounds.by_odometry.value - 1) < std::abs(bounds.by_gnss.value - 1);
  return odometry_says_less ? bounds.by_odometry : bounds.by_gnss;
}

std::size_t large_turns(std::span<const Turn> turns) {
  constexpr double kLarge = 15 * std::numbers::pi / 180;
  return static_cast<std::size_t>(std::count_if(turns.begin(), turns.end(), [](const Turn& turn) {
    return std::max(std::abs(turn.gnss_rad), std::abs(turn.odometry_rad)) >= kLarge;
  }));
}

/// Bounds by the chords that tell most, and how many large turns they are from.
struct BestBounds {
  Bounds bounds;
  std::size_t turns = 0;
};

std::optional<BestBounds> best_bounds(const ReckonedFixes& receiver) {
  constexpr std::array kLengths_m = {20.0, 60.0, 180.0};
  constexpr std::size_t kFewest = 6;
  std::optional<BestBounds> best;
  for (const double length_m : kLengths_m) {
    const std::vector<Turn> turns = turns_along(receiver, length_m);
    const std::size_t large = large_turns(turns);
    if (large < kFewest) continue;
    const std::optional<Bounds> bounds = bounds_of(turns);
    if (bounds && (!best || bounds->by_gnss.sigma < best->bounds.by_gnss.sigma)) best = {*bounds, large};
  }
  return best;
}

}  // namespace

std::optional<TurnFactor> turn_factor(const ReckonedFixes& receiver, double first) {
  constexpr int kRefinements = 3;
  double factor = first;
  std::optional<TurnFactor> found;
  for (int i = 0; i < kRefinements; ++i) {
    const std::optional<BestBounds> best = best_bounds(without_error(receiver, {.factor = factor}));
    if (!best) return std::nullopt;
    const std::optional<Slope> slope =
        agreed({times(factor, best->bounds.by_odometry), times(factor, best->bounds.by_gnss)}, best->turns);
    if (!slope || !is_scale(slope->value)) return std::nullopt;
    found = TurnFactor{slope->value, slope->sigma, best->turns};
    factor = slope->value;
  }
  return found;
}

}  // namespace waymark::drive
