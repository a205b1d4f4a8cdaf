/// RINEX observation files with their navigation files, as raw measurements of a receiver.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "rinex": reads the sensor stream, with the columns of the plugin gnss_raw, from an observation file of RINEX
/// 2 or 3 and the companions "navigation". A row is a satellite at an epoch: corrected pseudorange, range rate from the
/// Doppler shift, position and velocity of the satellite when the signal left it, elevation and C/N0. A column of
/// another name is NaN.
///
/// **Corrections** (formats/satellites): clock of the satellite with relativity and group delay, troposphere
/// (Saastamoinen), ionosphere (Klobuchar with the coefficients of GPS, or typical ones).
///
/// **Left out** and counted in notes: satellites without a usable ephemeris or below 5 degrees, systems other than
/// GPS, GLONASS, Galileo and BeiDou, measurements without a pseudorange of the first frequency. Epochs before the first
/// one with a position wait for it.
///
/// **Week cycle**: a receiver that believes in another cycle of 1024 weeks writes dates that are 19.6 years off. If
/// the navigation files say so, whole cycles are added, and a note tells it.
///
/// **Corrupt**: an epoch that is cut off, has fewer satellites than it announces, or an impossible date.
///
/// @throws InputError for other streams, a column map, no navigation file, navigation files that cannot be read, and if
/// no satellite of the first epochs has an ephemeris (another day)
class RinexReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
