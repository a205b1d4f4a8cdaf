/// The motion that a receiver measures, for comparisons with the odometry.
#pragma once

#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// A GNSS measurement over a stretch of time.
struct Stretch {
  Stamp from;
  Stamp to;
  double value = 0;  ///< mean over it: m/s, rad/s
};

/// One quantity, as a receiver measures it.
struct GnssMotion {
  std::string source;  ///< "receiver's speed", "distance between fixes", ...
  std::vector<Stretch> stretches;
};

/// Returns the fixes of the receiver with the most fixes. They must outlive the result.
[[nodiscard]] std::vector<const Fix*> of_one_receiver(const std::vector<Fix>& fixes);
/// Tells whether the speeds of a receiver fit its own positions better by a fifth (in squares) when they are
/// moved in time by 0.25 s or more: receivers filter them. They tell nothing of the clock of the positions then.
/// @param fixes of one receiver, sorted by stamp
[[nodiscard]] bool velocity_lags(const std::vector<const Fix*>& fixes);

/// The motion of one receiver: Doppler speeds and the changes of Doppler courses if most fixes have them and
/// they do not lag, else distances between fixes over their time, and the angles between chords.
struct ReceiverMotion {
  GnssMotion speeds;
  GnssMotion turns;
};
/// @param fixes of one receiver, sorted by stamp
[[nodiscard]] ReceiverMotion receiver_motion(const std::vector<const Fix*>& fixes);

}  // namespace waymark::drive
