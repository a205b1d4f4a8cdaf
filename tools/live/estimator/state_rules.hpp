/// How much the poses are worth, by rules with numbers (tools/live/README.md has the table).
#pragma once

#include <deque>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/tools/live/estimator/reports.hpp>
#include <waymark/tools/live/estimator/settings.hpp>

namespace waymark::live {

/// When something told where the vehicle was: fixes that were used, or epochs of raw measurements.
class PlaceTimes {
 public:
  /// @returns false if it is older than the last one
  bool note(Stamp stamp);
  [[nodiscard]] bool any() const { return last_.has_value(); }
  /// Returns the time since the last one; 0 without one.
  [[nodiscard]] double age_s(Stamp now) const { return last_ ? seconds_between(*last_, now) : 0; }
  /// Tells whether the last one is older than it usually is.
  [[nodiscard]] bool is_old(Stamp now) const;
  void forget_last() { last_.reset(); }

 private:
  std::optional<Stamp> last_;
  std::deque<double> intervals_s_;
};

struct JudgedState {
  State state = State::waiting;
  std::string why{};
};

/// Returns the state of an estimate. @param before the state so far @param radius95_m of its place
[[nodiscard]] JudgedState judge_estimate(State before, double radius95_m, const PlaceTimes& places, Stamp now,
                                         const LiveSettings& live);

/// Returns the radius of the circle that holds a place with 95 %, by the longer axis of its covariance, m.
[[nodiscard]] double radius95_m(const Eigen::Matrix2d& covariance);

}  // namespace waymark::live
