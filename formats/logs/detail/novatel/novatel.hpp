/// ASCII logs of NovAtel receivers.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "novatel": streams gnss and truth of ASCII messages (`#BESTPOSA,...`), OEM4 to OEM7.
///
/// **Positions** are those of the best kind that has occurred so far; the others are counted. Best first:
/// gnss BESTGNSSPOS (BESTGPSPOS of older receivers), BESTPOS, INSPVAX, INSPVA, INSPVAS: on receivers with
/// inertial unit BESTPOS is smoothed by it; truth INSPVAX, INSPVA, INSPVAS, BESTPOS, BESTGNSSPOS. Of the
/// inertial ones the azimuth becomes the heading of the truth.
///
/// **Speed and course** of a fix come from BESTVEL of the same GPS time, before or after the position, or
/// from the inertial velocity with its sigmas. BESTVEL's latency, by which its velocities are older than they
/// say, is noted.
///
/// **Accuracy**: sigma of latitude and longitude (1 sigma, which `request.accuracy` overrides). INSPVA has
/// none.
///
/// **Height** is above the ellipsoid: BESTPOS' and INSPVAX' height plus undulation.
///
/// **Without a fix**: a solution status other than SOL_COMPUTED, an inertial status without a solution,
/// position type NONE, and GPS time UNKNOWN or APPROXIMATE. **Corrupt**: a message of these kinds without or
/// with another checksum, with a garbled number or a value out of range. Everything else is passed over and
/// counted. Abbreviated ASCII (`<BESTPOS`) has no checksum and is not read.
///
/// @throws InputError for the odometry and sensor streams, a column map, companions; for a log whose messages
/// are abbreviated ASCII alone
class NovatelReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
