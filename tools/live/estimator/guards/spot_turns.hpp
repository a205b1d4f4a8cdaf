/// A vehicle that turns without moving, slower than one reading of a gyro tells from its bias: on a turntable, a robot.
/// In a batch run drive::mark_turns_on_spot finds such times; here only what was read before is known.
#pragma once

#include <deque>
#include <utility>

#include <waymark/core/drive/sample.hpp>

namespace waymark::live {

/// One odometry.
class SpotTurns {
 public:
  /// Judges the next sample, in order of the stamps. While the vehicle stands, its yaw rate over a second is compared
  /// with that of the standing before, of a second at least. From a difference of 0.015 rad/s and of five deviations
  /// on, samples are marked (OdometrySample::turns_on_spot), and the second one has the turn that was missed. What would be
  /// a turn of two minutes is standing after all: the standing before was a turn.
  [[nodiscard]] OdometrySample judged(OdometrySample sample);

 private:
  void keep_calm(const OdometrySample& sample);
  [[nodiscard]] double clear_radps() const;
  [[nodiscard]] std::pair<double, double> turn_in_window() const;
  void forget_calm();

  std::deque<OdometrySample> window_;  // of the present stop, as read
  double calm_ = 0;                    // mean of the readings before the window at rest, rad/s
  double calm_count_ = 0;
  double noise_ = 0;  // variance of a reading, by successive differences
  double differences_ = 0;
  double missed_rad_ = 0;  // turned before it was known
  bool turns_ = false;
  Stamp turns_since_;
};

}  // namespace waymark::live
