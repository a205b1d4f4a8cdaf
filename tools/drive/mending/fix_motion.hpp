/// The motion of the vehicle by its fixes. It stands in where the odometry has no readings.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Returns the fixes of the first receiver that are not withheld.
[[nodiscard]] std::vector<Fix> fixes_for_motion(std::span<const Fix> fixes);

/// Speed and yaw rate by the fixes of fixes_for_motion. The vehicle is taken to drive forwards.
class MotionOfFixes {
 public:
  /// @param fixes sorted by stamp; at least one is usable
  explicit MotionOfFixes(std::span<const Fix> fixes) : fixes_(fixes_for_motion(fixes)) {}

  /// Returns the speed that the receiver measures, or that of its positions over 5 s.
  [[nodiscard]] double speed(Stamp at) const;
  /// Returns the turn of two chords of 5 s whose middles are 3 s apart, per time; 0 if one of them is
  /// too short for a direction.
  [[nodiscard]] double yaw_rate(Stamp at) const;
  /// Tells whether fixes are at most 5 s apart all along a time.
  [[nodiscard]] bool covers(Stamp from, Stamp to) const;

 private:
  struct Neighbours {
    const Fix& left;
    const Fix& right;
    double share = 0;  ///< of the right one
  };
  struct TimedChord {
    Eigen::Vector2d chord = Eigen::Vector2d::Zero();
    double duration_s = 0;
  };
  [[nodiscard]] Stamp clamped(Stamp at) const;
  [[nodiscard]] Neighbours around(Stamp at) const;
  [[nodiscard]] Eigen::Vector2d position(Stamp at) const;
  [[nodiscard]] TimedChord chord_at(Stamp at) const;

  std::vector<Fix> fixes_;
};

/// Fills gaps of 2 s or more that fixes cover with two samples per second of their motion, marked as
/// assumed. @param gap_s samples further apart have a gap between them
/// @return how many gaps are filled
std::size_t fill_gaps(std::vector<OdometrySample>& odometry, std::span<const Fix> fixes, double gap_s);

}  // namespace waymark::drive
