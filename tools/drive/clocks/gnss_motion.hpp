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
/// Returns Doppler speeds if most fixes have them, else distances between fixes over their time.
[[nodiscard]] GnssMotion gnss_speeds(const std::vector<const Fix*>& fixes);
/// Returns the changes of Doppler courses if most fixes have them, else the angles between chords.
[[nodiscard]] GnssMotion gnss_turns(const std::vector<const Fix*>& fixes);

}  // namespace waymark::drive
