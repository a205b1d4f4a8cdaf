/// Turns from readings of a direction: the heading of an IMU or a compass, or the direction of motion that a
/// receiver calls course. Their errors do not add up over time, as those of a gyro do, but each reading has one.
#pragma once

#include <cstddef>
#include <optional>

#include <waymark/tools/drive/logs/time_series.hpp>

namespace waymark::drive {

/// Angles without jumps by whole turns, and how far turns between them may be off.
struct Direction {
  TimeSeries angle;                ///< rad, counter-clockwise
  TimeSeries turn_variance_per_s;  ///< rad^2/s, at the stamps of the angles
};

/// Angles that leap while the vehicle stands.
struct LeapsAtRest {
  std::size_t leaps = 0;
  double largest_rad = 0;
};

/// Tells whether a heading is a direction of motion. A vehicle that stands turns slowly if at all (turntable), or in
/// one sense (a robot on the spot). A receiver's course is random there, or leaps to a fixed value and back. Leaps of
/// more than 45 degrees on less than 2.5 m of way count: five and more of them, three of which go back what the one
/// before went, at the same stop. A course that is held at rest cannot be told.
/// @param heading rad @param speed m/s
/// @param gap_s the speed is not known in longer silences
[[nodiscard]] std::optional<LeapsAtRest> leaps_at_rest(const TimeSeries& heading, const TimeSeries& speed,
                                                       double gap_s);

/// Returns the turns of a heading, right at every speed. The variance of a reading s^2 is that of white noise, from
/// the median of the second differences (their variance is 6 s^2), plus that of the straight line to the next
/// reading in a turn: (0.09 times the second difference)^2, the mean square of a parabola over its chord. The
/// error of a turn between two readings is the difference of theirs. Those of neighbouring turns cancel by half, so
/// that s^2 per interval stands for them as white noise.
[[nodiscard]] Direction turns_of_heading(const TimeSeries& heading);

/// Returns the turns of a direction of motion. It is the heading at 2 m/s and more, turned round in reverse, with
/// noise that grows as 1 / speed. The turn of a slower stretch of at most 12 m is spread over its way: no car turns
/// by more than half a round there, and none turns that stands. So it is over the first and the last 2 m of the
/// log. Elsewhere the source is silent.
/// @param course rad, counter-clockwise @param speed m/s @param gap_s as above
/// @param goes_on more readings follow, so that the last ones are no end of the log
[[nodiscard]] Direction turns_of_course(const TimeSeries& course, const TimeSeries& speed, double gap_s,
                                        bool goes_on = false);

}  // namespace waymark::drive
