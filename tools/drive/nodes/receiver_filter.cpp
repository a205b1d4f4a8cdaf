#include <waymark/tools/drive/nodes/receiver_filter.hpp>

#include <cmath>
#include <numbers>
#include <utility>

#include <waymark/types_se2/se2.hpp>

namespace waymark::drive {

void ReceiverFilter::advance(const Interval& interval, double standstill_mps) {
  const bool stands = interval.stands(standstill_mps);
  const double half_turn_rad = stands ? 0 : 0.5 * interval.yaw_rate_radps * interval.dt_s;
  const Eigen::Vector2d velocity(stands ? 0 : interval.speed_mps, 0);
  // The motion in a long gap is not known: it begins anew behind it.
  const bool begins = std::exchange(is_settled_, false);
  if (begins) velocity_mps_ = velocity;
  if (interval.bridged && interval.dt_s > kForgotten * time_s_) {
    beside_m_.setZero();
    is_settled_ = true;
    return;
  }
  // Along the chord of the interval the velocity is constant: the exact solution of the linear equations, whose
  // eigenvalues are -rate +- i rate.
  const double rate = 1 / (std::numbers::sqrt2 * time_s_);
  const double angle = rate * interval.dt_s;
  const double decay = std::exp(-angle);
  const double cosine = decay * std::cos(angle);
  const double sine = decay * std::sin(angle);
  const Eigen::Vector2d beside = rotate(-half_turn_rad, beside_m_);
  const Eigen::Vector2d faster = rotate(-half_turn_rad, velocity_mps_) - velocity;
  const Eigen::Vector2d beside_then = cosine * beside + sine * (faster / rate - beside);
  const Eigen::Vector2d faster_then = cosine * faster + sine * (faster - 2 * rate * beside);
  beside_m_ = rotate(-half_turn_rad, beside_then);
  velocity_mps_ = rotate(-half_turn_rad, Eigen::Vector2d(velocity + faster_then));
}

std::vector<Eigen::Vector2d> smoothed_beside(std::span<const Interval> intervals, double time_s,
                                             double standstill_mps) {
  ReceiverFilter filter(time_s);
  std::vector<Eigen::Vector2d> beside{filter.beside_m()};
  beside.reserve(intervals.size() + 1);
  for (const Interval& interval : intervals) {
    filter.advance(interval, standstill_mps);
    beside.push_back(filter.beside_m());
  }
  return beside;
}

}  // namespace waymark::drive
