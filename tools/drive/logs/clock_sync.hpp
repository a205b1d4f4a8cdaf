/// How late the odometry is stamped against the GNSS, from what both say of the same motion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// One comparison. With the odometry's stamps reduced by late_s, it agrees best with the GNSS.
struct ClockOffset {
  std::string against;     ///< what of the GNSS: "receiver's speed", "distance between fixes", "receiver's
                           ///< course", "..."
  double late_s = 0;       ///< positive: the odometry's stamps are late
  double sigma_s = 0;      ///< one standard deviation, from the residuals and their autocorrelation
  double correlation = 0;  ///< Pearson's, at late_s
  std::size_t samples = 0;
};

struct SyncReport {
  std::optional<ClockOffset> speed;     ///< empty: too little driving, or no correlation beyond chance
  std::optional<ClockOffset> yaw_rate;  ///< empty: too few turns, or no correlation beyond chance
};

struct SyncOptions {
  double largest_s =
      30;  ///< offsets are looked for in [-largest_s, largest_s]; above 18: a missing leap second shows
};

/// Compares speed with speed and turning with turning: the odometry's means over the time between two fixes,
/// moved by an offset, against what the GNSS says of that time (the receiver's Doppler speed and course where
/// most fixes have them, else distance between fixes and angle between chords). The offset of largest
/// correlation, found on a grid of 0.1 s and then to a thousandth; once more without the readings that lie
/// more than 4 median deviations off, so that jumps do not decide. sigma_s^2 = s^2 (1 + r) / (1 - r) / sum (b
/// do/dt)^2 with the residuals' variance s^2 and autocorrelation r, and the slope b.
[[nodiscard]] SyncReport estimate_clock_offsets(const PreparedDrive& drive, const SyncOptions& options);

/// What the messages of a log say of the clock that stamped them; empty where it holds no GNSS time.
[[nodiscard]] std::optional<ClockReport> clock_of(const DriveLogs::Log& log);

/// Puts fixes onto the GNSS time that their log tells of. @return what was done, a sentence for each such log
std::vector<std::string> put_on_told_time(DriveLogs& logs);

/// Odometry with speed and yaw rate moved earlier by their delays: all stamps by what both have in common,
/// the rest on the lines between readings. Samples whose reading would lie beyond an end are dropped.
[[nodiscard]] std::vector<OdometrySample> without_delays(const std::vector<OdometrySample>& odometry,
                                                         double speed_delay_s, double yaw_rate_delay_s);

}  // namespace waymark::drive
