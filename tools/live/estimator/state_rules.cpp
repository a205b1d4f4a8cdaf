#include <waymark/tools/live/estimator/state_rules.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <Eigen/LU>

#include <waymark/core/base/detail/median.hpp>

namespace waymark::live {

std::string_view to_string(State state) {
  switch (state) {
    case State::waiting:
      return "waiting";
    case State::aligning:
      return "aligning";
    case State::tracking:
      return "tracking";
    case State::dead_reckoning:
      return "dead_reckoning";
    case State::degraded:
      return "degraded";
    case State::lost:
      return "lost";
  }
  return "";
}

bool PlaceTimes::note(Stamp stamp) {
  constexpr std::size_t kIntervals = 20;
  if (last_ && stamp < *last_) return false;
  if (last_) {
    intervals_s_.push_back(seconds_between(*last_, stamp));
    if (intervals_s_.size() > kIntervals) intervals_s_.pop_front();
  }
  last_ = stamp;
  return true;
}

bool PlaceTimes::is_old(Stamp now) const {
  constexpr double kUnknownInterval_s = 2;
  constexpr double kLeast_s = 1.5;
  constexpr double kIntervals = 2.5;
  const double usual_s = intervals_s_.empty()
                             ? kUnknownInterval_s
                             : upper_median(std::vector<double>(intervals_s_.begin(), intervals_s_.end()));
  return age_s(now) > std::max(kLeast_s, kIntervals * usual_s);
}

JudgedState judge_estimate(State before, double radius95_m, const PlaceTimes& places, Stamp now,
                           const LiveSettings& live) {
  constexpr double kLeaves = 0.8;  // of the limit: else the state changes with every fix
  if (radius95_m > live.lost_radius_m)
    return {State::lost, fmt::format("the radius of 95 % is {:.0f} m", radius95_m)};
  if (radius95_m > live.degraded_radius_m * (before == State::degraded ? kLeaves : 1))
    return {State::degraded, fmt::format("the radius of 95 % is {:.1f} m", radius95_m)};
  if (places.is_old(now))
    return {State::dead_reckoning, fmt::format("no fix was used for {:.1f} s", places.age_s(now))};
  return {State::tracking};
}

double radius95_m(const Eigen::Matrix2d& covariance) {
  constexpr double kRadius95 = 2.4477468306808161;  // sqrt of the 95 % point of chi-square with 2 freedoms
  const double half_trace = 0.5 * covariance.trace();
  const double root = std::sqrt(std::max(0.0, half_trace * half_trace - covariance.determinant()));
  return kRadius95 * std::sqrt(std::max(0.0, half_trace + root));
}

}  // namespace waymark::live
