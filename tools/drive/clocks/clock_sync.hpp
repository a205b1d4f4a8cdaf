/// Estimates how late the stamps of the odometry are against GNSS, from the motion that
/// both measure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// An offset within this many of its sigmas counts as zero.
inline constexpr double kOffsetSigmas = 3;
/// Receivers and wheels smooth their speeds, and not by the same time: what no sigma of the residuals knows.
inline constexpr double kSmoothing_s = 0.05;

/// The result of one comparison. If the odometry's stamps are reduced by late_s, it agrees
/// best with GNSS.
struct ClockOffset {
  /// the GNSS side: "receiver's speed", "distance between fixes", "receiver's course", "..."
  std::string against;
  double late_s = 0;       ///< positive: the stamps of the odometry are late
  double sigma_s = 0;      ///< one standard deviation, from the residuals and their autocorrelation
  double correlation = 0;  ///< Pearson's, at late_s
  std::size_t samples = 0;

  /// Tells whether it differs from 0 by more than kOffsetSigmas of sigma_s and kSmoothing_s together.
  [[nodiscard]] bool is_significant() const;
  /// Tells whether another one may be the same: within kOffsetSigmas of both sigmas and kSmoothing_s together.
  [[nodiscard]] bool may_be(const ClockOffset& other) const;
};

struct SyncReport {
  /// empty: there is too little driving, or no correlation beyond chance
  std::optional<ClockOffset> speed;
  /// empty: there are too few turns, or no correlation beyond chance
  std::optional<ClockOffset> yaw_rate;

  /// Returns the offset of a clock that both share: the one that is known better.
  [[nodiscard]] std::optional<ClockOffset> common() const;
};

struct SyncOptions {
  /// offsets are searched in [-largest_s, largest_s]; 0: wherever the logs would overlap
  double largest_s = 0;
};

/// Compares speed with speed and yaw rate with yaw rate. The odometry side is the mean between two
/// fixes, shifted by an offset. The GNSS side is the Doppler speed and course of the receiver if
/// most fixes have them, or else the distance between fixes and the angle between chords. Both together
/// find where the logs fit (lag_search.hpp), whatever their clocks say. Each has the largest correlation
/// within 1.5 s of that, found on a grid of 0.1 s and then to a thousandth. The search is repeated without
/// readings more than 4 median deviations away, so that jumps do not decide. sigma_s^2 = s^2 (1 + r) / (1 - r)
/// / sum (b do/dt)^2, where s^2 is the variance of the residuals, r their autocorrelation, and b the slope.
/// @param fixes of all receivers, in a metric frame; the receiver with the most fixes counts
[[nodiscard]] SyncReport estimate_clock_offsets(const std::vector<OdometrySample>& odometry,
                                                const std::vector<Fix>& fixes, const SyncOptions& options);

}  // namespace waymark::drive
