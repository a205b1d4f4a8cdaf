#include <waymark/tools/drive/trials/lag_left.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/tools/drive/clocks/late_quantity.hpp>
#include <waymark/tools/drive/estimation/speed_slip.hpp>
#include <waymark/tools/drive/trials/trial_drive.hpp>

namespace waymark::drive {
namespace {

/// Makes a quantity of the intervals what it was some time later. It stays where the vehicle would begin or end to
/// stand: the graph must have the same edges.
void move_earlier(OdometryQuantity kind, double by_s, PlacedDrive& drive) {
  double Interval::*const quantity =
      kind == OdometryQuantity::speed ? &Interval::speed_mps : &Interval::yaw_rate_radps;
  const auto changed = [&](const Interval& read, double slope) {
    Interval moved = read;
    moved.*quantity += by_s * slope;
    return moved.stands(drive.standstill_mps) == read.stands(drive.standstill_mps) ? moved.*quantity
                                                                                   : read.*quantity;
  };
  change_by_slope(quantity, changed, drive);
}

}  // namespace

bool LagLeft::is_probable() const {
  constexpr double kLeast_s = 0.002;
  constexpr double kSigmas = 3;
  return std::abs(late_s) > std::max(kLeast_s, kSigmas * sigma_s);
}

std::optional<LagLeft> find_lag_left(OdometryQuantity kind, const PlacedDrive& placed,
                                     std::span<const PreparedSensor> sensors, const FusionSettings& settings,
                                     const TypeRegistry& registry, const std::function<void()>& between) {
  constexpr double kFixPeriod_s = 1;
  constexpr double kNodePeriod_s = 0.25;
  constexpr double kFirst_s = 0.02;
  constexpr double kFinest_s = 0.002;
  constexpr double kFarthest_s = 0.15;
  constexpr double kReached = 0.25;
  constexpr int kMostSteps = 10;
  if (placed.fixes.empty()) return std::nullopt;
  TrialDrive trial(sample_of(coarsen(placed, sensors, kFixPeriod_s, kNodePeriod_s)), settings, registry,
                   between);
  const auto cost_at = [&](double late_s) {
    return trial.cost_with([&](PlacedDrive& drive) { move_earlier(kind, late_s, drive); });
  };
  LagLeft left;
  double apart_s = kFirst_s;
  for (int count = 0; count < kMostSteps; ++count) {
    const auto least = trial.least_near(left.late_s, apart_s, cost_at);
    if (!least) return std::nullopt;
    const double whole_s = least->at - left.late_s;
    const double step_s = std::clamp(whole_s, -2 * apart_s, 2 * apart_s);
    left = {left.late_s + step_s, least->sigma};
    if (!(std::abs(left.late_s) < kFarthest_s)) return std::nullopt;
    if (std::abs(whole_s) < kReached * apart_s) return left;
    if (step_s == whole_s) apart_s = std::max(kFinest_s, 0.5 * apart_s);
  }
  return std::nullopt;
}

PreparedDrive without_lag_left(PreparedDrive drive, const LagLeft& left) {
  MovedQuantity& moved = *drive.report.moved_quantity;
  std::vector<OdometrySample> readings =
      without_lateness(drive.odometry, {moved.kind, left.late_s, left.sigma_s});
  if (readings.empty()) return drive;
  const auto first =
      std::lower_bound(drive.odometry.begin(), drive.odometry.end(), readings.front().stamp,
                       [](const OdometrySample& sample, Stamp stamp) { return sample.stamp < stamp; });
  std::copy(readings.begin(), readings.end(), first);
  moved.earlier_s += left.late_s;
  moved.sigma_s = left.sigma_s;
  return drive;
}

std::string warning_of(const MovedQuantity& moved) {
  const LateQuantity late{moved.kind, moved.earlier_s, moved.sigma_s};
  return fmt::format(
      "fused, the odometry's {} is {:.3f} +- {:.3f} s late: its readings are moved by that in all; state '{}: {:.3f}'",
      late.name(), late.late_s, late.sigma_s, late.key(), late.late_s);
}

}  // namespace waymark::drive
