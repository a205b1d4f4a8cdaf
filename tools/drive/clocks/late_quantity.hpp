/// Whether one of speed and yaw rate is late and the other one is not: OBD and CAN deliver speeds late, a gyro is on
/// time. An offset of all stamps is the wrong remedy then.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// One of the two quantities of an odometry that is later than the other one.
struct LateQuantity {
  using Kind = OdometryQuantity;
  Kind kind = Kind::speed;
  /// positive, later than the other one. A gyro is on time and fixes are seldom late, within 0.15 s: where the drive
  /// knows less of them than that, this counts
  double late_s = 0;
  double sigma_s = 0;

  /// Returns "speed" or "yaw rate", for messages.
  [[nodiscard]] std::string name() const;
  /// Returns "speed_delay" or "yaw_rate_delay", the key of the drive.yaml.
  [[nodiscard]] std::string key() const;
  /// Returns what to do where nothing is moved: "increase 'speed_delay' by 0.41".
  [[nodiscard]] std::string increase() const;
  /// Returns the delay of an odometry that is to be larger by late_s.
  [[nodiscard]] double& delay_in(OdometryConfig& odometry) const;
};

/// Returns the quantity that is late by 0.15 s and four sigmas more than the other one against the fixes; a speed by
/// three sigmas if it is late by four of its own as well, because fixes are never early. A yaw rate must be late
/// itself: wheels that slip as they pull make speeds early, an antenna ahead of where it is stated makes bends early.
/// Positions tell, and speeds with courses of a receiver that gives both. Of these, and of several receivers, the one
/// that is known best tells, if no other one contradicts it. Withheld fixes do not count.
/// @param rest of the same odometry: the yaw rate of wheels is as late as their speed
[[nodiscard]] std::optional<LateQuantity> late_quantity_shown(const std::vector<OdometrySample>& odometry,
                                                              const std::vector<Fix>& fixes,
                                                              const YawRateAtRest& rest);

/// Tells whether the yaw rate shows that it is late itself, by two sigmas at least. If not, a clock that seems late may
/// be a late speed alone.
[[nodiscard]] bool yaw_rate_is_late(const std::vector<OdometrySample>& odometry,
                                    const std::vector<Fix>& fixes);

/// Returns the samples with the quantity moved earlier.
[[nodiscard]] std::vector<OdometrySample> without_lateness(const std::vector<OdometrySample>& odometry,
                                                           const LateQuantity& late);

/// Tells whether the delay of one quantity is stated: by its key (0 as well), or by parts with different offsets
/// (but for whole zones of time).
[[nodiscard]] bool states_delays(const OdometryConfig& odometry);

/// @param odometry "the odometry" or the name of one of several @param cure what to do
[[nodiscard]] std::string late_quantity_warning(const std::string& odometry, const LateQuantity& late,
                                                const std::string& cure);

}  // namespace waymark::drive
