#include <waymark/tools/drive/estimation/speed_slip.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

namespace waymark::drive {

void change_by_slope(double Interval::*quantity,
                     const std::function<double(const Interval& read, double slope)>& changed,
                     PlacedDrive& drive) {
  std::vector<Interval>& intervals = drive.timeline.intervals;
  const std::vector<Interval> read = intervals;
  for (std::size_t i = 1; i + 1 < read.size(); ++i) {
    const Interval& before = read[i - 1];
    const Interval& after = read[i + 1];
    if (before.bridged || read[i].bridged || after.bridged) continue;
    const double apart_s = read[i].dt_s + 0.5 * (before.dt_s + after.dt_s);
    intervals[i].*quantity = changed(read[i], (after.*quantity - before.*quantity) / apart_s);
  }
}

void remove_slip(double per_mps2, PlacedDrive& drive) {
  change_by_slope(
      &Interval::speed_mps,
      [&](const Interval& read, double acceleration_mps2) {
        return read.speed_mps * (1 - per_mps2 * acceleration_mps2);
      },
      drive);
}

PreparedDrive without_slip(PreparedDrive drive, const SpeedSlip& slip) {
  constexpr double kHalf_s = 0.5;
  constexpr double kGap_s = 3;
  const std::vector<OdometrySample> read = drive.odometry;
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < read.size(); ++i) {
    while (seconds_between(read[first].stamp, read[i].stamp) > kHalf_s && first + 1 < i) ++first;
    while (last + 1 < read.size() && seconds_between(read[i].stamp, read[last].stamp) < kHalf_s) ++last;
    const double apart_s = seconds_between(read[first].stamp, read[last].stamp);
    if (!(apart_s > 0) || apart_s > kGap_s) continue;
    const double acceleration_mps2 = (read[last].speed_mps - read[first].speed_mps) / apart_s;
    if (std::isfinite(acceleration_mps2))
      drive.odometry[i].speed_mps = read[i].speed_mps * (1 - slip.per_mps2 * acceleration_mps2);
  }
  return drive;
}

std::string warning_of(const SpeedSlip& slip) {
  return fmt::format(
      "the speeds of the odometry are wrong by {:.2f} +- {:.2f} % for each m/s^2 of acceleration, as those of wheels that "
      "slip when they pull and brake; they are taken without that (it looks like fixes that are late: where a 'delay' "
      "is advised too, it may be none)",
      100 * slip.per_mps2, 100 * slip.sigma);
}

}  // namespace waymark::drive
