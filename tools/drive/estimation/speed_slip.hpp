/// Speeds that are wrong in proportion to the acceleration: driven and braked tyres slip, by about 0.5 % per m/s^2 on a dry
/// road and several times that on a wet rail or snow. The way of such speeds is wrong by half of the slip times the
/// change of v^2, which looks like fixes that are late where v hardly varies.
#pragma once

#include <algorithm>
#include <functional>
#include <string>

#include <waymark/tools/drive/logs/prepare.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

struct SpeedSlip {
  double per_mps2 = 0;  ///< a speed is read times 1 + this times the acceleration; s^2/m
  double sigma = 0;

  [[nodiscard]] bool is_probable() const {
    constexpr double kSigmas = 3;
    constexpr double kLeast = 0.001;
    return per_mps2 > std::max(kLeast, kSigmas * sigma);  // below 0, speeds are late
  }
};

/// Gives a quantity of the intervals values that depend on how fast it changes there, 1/s. Beside a gap they stay.
void change_by_slope(double Interval::*quantity,
                     const std::function<double(const Interval& read, double slope)>& changed,
                     PlacedDrive& drive);

/// Makes the speeds of the intervals what they were without a slip. Beside a gap they stay.
void remove_slip(double per_mps2, PlacedDrive& drive);

/// Returns a drive of one odometry whose speeds are without a slip. The acceleration is that of a second.
[[nodiscard]] PreparedDrive without_slip(PreparedDrive drive, const SpeedSlip& slip);

/// Returns the warning about speeds that slip.
[[nodiscard]] std::string warning_of(const SpeedSlip& slip);

}  // namespace waymark::drive
