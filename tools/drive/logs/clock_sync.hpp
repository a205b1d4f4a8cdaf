/// Estimates how late the stamps of the odometry are against GNSS, from the motion that
/// both measure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// An offset within this many of its sigmas counts as zero.
inline constexpr double kOffsetSigmas = 3;

/// The result of one comparison. If the odometry's stamps are reduced by late_s, it agrees
/// best with GNSS.
struct ClockOffset {
  /// the GNSS side: "receiver's speed", "distance between fixes", "receiver's course", "..."
  std::string against;
  double late_s = 0;       ///< positive: the stamps of the odometry are late
  double sigma_s = 0;      ///< one standard deviation, from the residuals and their autocorrelation
  double correlation = 0;  ///< Pearson's, at late_s
  std::size_t samples = 0;

  /// Tells whether it differs from 0 by more than kOffsetSigmas.
  [[nodiscard]] bool is_significant() const;
};

struct SyncReport {
  /// empty: there is too little driving, or no correlation beyond chance
  std::optional<ClockOffset> speed;
  /// empty: there are too few turns, or no correlation beyond chance
  std::optional<ClockOffset> yaw_rate;
};

struct SyncOptions {
  /// offsets are searched in [-largest_s, largest_s]; above 18, so that a missing leap
  /// second is found
  double largest_s = 30;
};

/// Compares speed with speed and yaw rate with yaw rate. The odometry side is the mean between two
/// fixes, shifted by an offset. The GNSS side is the Doppler speed and course of the receiver if
/// most fixes have them, or else the distance between fixes and the angle between chords. The
/// result is the offset with the largest correlation, found on a grid of 0.1 s and then to a
/// thousandth. The search is repeated without readings more than 4 median deviations away, so that
/// jumps do not decide. sigma_s^2 = s^2 (1 + r) / (1 - r) / sum (b do/dt)^2, where s^2 is the
/// variance of the residuals, r their autocorrelation, and b the slope.
[[nodiscard]] SyncReport estimate_clock_offsets(const PreparedDrive& drive, const SyncOptions& options);

/// Returns what the messages of a log reveal about the clock of its stamps. Empty if the log holds
/// no GNSS time.
[[nodiscard]] std::optional<ClockReport> clock_of(const DriveLogs::Log& log);

/// Moves fixes to the GNSS time that is in their log. @return one sentence for each such log
std::vector<std::string> put_on_told_time(DriveLogs& logs);

/// Returns odometry with speed and yaw rate moved earlier by their delays. All stamps move by the
/// common part. The rest is interpolated between readings. Samples whose reading would be beyond an
/// end are dropped.
[[nodiscard]] std::vector<OdometrySample> without_delays(const std::vector<OdometrySample>& odometry,
                                                         double speed_delay_s, double yaw_rate_delay_s);

}  // namespace waymark::drive
