/// Where a receiver that smooths its positions has the vehicle.
///
/// A receiver that filters its positions with a model of constant velocity, and does not measure the velocity, is right
/// on straight ways at constant speed alone: it runs on where the vehicle brakes, stays behind where it pulls away, and
/// swings out of bends. The steady state of such a Kalman filter (acceleration as white noise) is, between position p
/// and filtered position s, with the velocity u that it believes in,
///   s' = u + sqrt(2) / T (p - s),   u' = (p - s) / T^2
/// for one time T, which the noise of ranges over that of acceleration gives (Bar-Shalom, Li and Kirubarajan,
/// "Estimation with Applications to Tracking and Navigation", 2001, 6.5: damping 1 / sqrt(2)). So s is p - T^2 p'' where
/// the acceleration hardly changes: 6 m behind for T = 2 s and 1.5 m/s^2.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Follows a vehicle from interval to interval. It begins settled: at the right place, with the right velocity.
class ReceiverFilter {
 public:
  /// After so many times its time less than 1 % of what a filter was off is left.
  static constexpr double kForgotten = 8;

  /// @param time_s T, > 0
  explicit ReceiverFilter(double time_s) : time_s_(time_s) {}

  /// Goes on to the end of an interval. @param standstill_mps as Interval::stands
  void advance(const Interval& interval, double standstill_mps);
  /// Returns where the filter has the vehicle, beside where it is: body frame, m.
  [[nodiscard]] const Eigen::Vector2d& beside_m() const { return beside_m_; }

 private:
  double time_s_;
  bool is_settled_ = true;  ///< it takes the velocity of the next interval
  Eigen::Vector2d beside_m_{0, 0};
  Eigen::Vector2d velocity_mps_{0, 0};  ///< that the filter believes in, body frame
};

/// Returns where such a receiver has the vehicle beside where it is at each node of a drive, body frame, m.
/// @param intervals between the n nodes: n - 1
[[nodiscard]] std::vector<Eigen::Vector2d> smoothed_beside(std::span<const Interval> intervals, double time_s,
                                                           double standstill_mps);

}  // namespace waymark::drive
