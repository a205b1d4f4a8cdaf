#include <waymark/tools/drive/trials/clock_drift.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <waymark/tools/drive/trials/trial_drive.hpp>

namespace waymark::drive {
namespace {

constexpr double kLargest = 3e-4;

/// A coarse drive whose fixes are moved along the way, as a drift would have moved them.
class DriftedDrive {
 public:
  explicit DriftedDrive(TrialDrive& trial) : trial_(trial) {
    const std::vector<Fix>& fixes = trial.drive().fixes;
    for (std::size_t i = 0; i < fixes.size(); ++i)
      moved_m_.push_back(seconds_between(fixes.front().stamp, fixes[i].stamp) * trial.velocity_at(i));
  }

  [[nodiscard]] double cost_at(double rate) {
    return trial_.cost_with([&](PlacedDrive& drive) {
      for (std::size_t i = 0; i < moved_m_.size(); ++i) drive.fixes[i].position += rate * moved_m_[i];
    });
  }

  /// Returns by how much a drift of 1 moves the fixes, at their accuracy: the largest.
  [[nodiscard]] double largest_in_accuracies() const {
    double largest = 0;
    for (std::size_t i = 0; i < moved_m_.size(); ++i)
      largest = std::max(largest, moved_m_[i].norm() / trial_.drive().fixes[i].accuracy_m());
    return largest;
  }

 private:
  TrialDrive& trial_;
  std::vector<Eigen::Vector2d> moved_m_;  ///< of each fix, by a drift of 1
};

}  // namespace

std::optional<ClockDrift> find_clock_drift(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                           const FusionSettings& settings, const TypeRegistry& registry,
                                           const std::function<void()>& between) {
  constexpr double kFixPeriod_s = 4;
  constexpr double kNodePeriod_s = 1;
  constexpr double kStep = 2e-5;
  constexpr double kLeast = 5e-6;
  constexpr double kSigmas = 3;
  constexpr double kMasked = 3;  // accuracies: so far off, noise was found instead
  constexpr double kMaskedSigmas = 1.5;
  constexpr double kMatters = 0.1;  // of the accuracy of a fix
  if (placed.fixes.empty()) return std::nullopt;
  TrialDrive trial(sample_of(coarsen(placed, sensors, kFixPeriod_s, kNodePeriod_s)), settings, registry,
                   between);
  DriftedDrive drive(trial);
  if (kLargest * drive.largest_in_accuracies() < kMatters) return std::nullopt;
  const auto least = trial.least_near(0, kStep, [&](double rate) { return drive.cost_at(rate); });
  if (!least) return std::nullopt;
  ClockDrift drift{least->at, least->sigma};
  const double rate = std::abs(drift.rate);
  const double moved = rate * drive.largest_in_accuracies();
  const double sigmas = moved > kMasked ? kMaskedSigmas : kSigmas;
  drift.is_probable = moved >= kMatters && rate >= kLeast && rate <= kLargest && rate >= sigmas * drift.sigma;
  return drift;
}

PreparedDrive without_drift(PreparedDrive drive, const ClockDrift& drift) {
  if (drive.fixes.empty()) return drive;
  const Stamp agreed = drive.fixes.front().stamp;
  return with_stamps_later(std::move(drive),
                           [&](Stamp stamp) { return drift.rate * seconds_between(agreed, stamp); });
}

PreparedDrive with_stamps_later(PreparedDrive drive, const std::function<double(Stamp)>& by_s) {
  std::vector<OdometrySample>& odometry = drive.odometry;
  if (odometry.size() < 2) return drive;
  const Stamp end = odometry.back().stamp;
  const double usual_s =
      seconds_between(odometry.front().stamp, end) / static_cast<double>(odometry.size() - 1);
  for (OdometrySample& sample : odometry) sample.stamp = sample.stamp.later(by_s(sample.stamp));
  // A single interval to the end might be longer than a gap may be.
  while (odometry.back().stamp < end) {
    OdometrySample held = odometry.back();
    held.stamp = std::min(end, held.stamp.later(usual_s));
    odometry.push_back(std::move(held));
  }
  return drive;
}

std::string warning_of(const ClockDrift& drift, double duration_s) {
  constexpr double kMillion = 1e6;
  const double ppm = kMillion * drift.rate;
  return fmt::format(
      "the clock of the odometry {} by {:.1f} +- {:.1f} ppm beside that of the fixes, {:.3f} s from the first one to "
      "the last; its readings are taken at the times of that clock, as if both agreed at the first fix",
      ppm > 0 ? "falls behind" : "hurries", std::abs(ppm), kMillion * drift.sigma,
      std::abs(drift.rate) * duration_s);
}

}  // namespace waymark::drive
