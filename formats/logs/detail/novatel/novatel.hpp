/// ASCII logs of NovAtel receivers.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "novatel": reads the streams gnss and truth from ASCII messages (`#BESTPOSA,...`),
/// OEM4 to OEM7.
///
/// **Positions** come from the best kind of message so far; the others are counted. For gnss the
/// order is BESTGNSSPOS (BESTGPSPOS of older receivers), BESTPOS, INSPVAX, INSPVA, INSPVAS, because
/// an inertial unit smooths BESTPOS. For truth it is INSPVAX, INSPVA, INSPVAS, BESTPOS,
/// BESTGNSSPOS. The azimuth of the inertial ones is the heading of the truth.
///
/// **Speed and course** of a fix come from BESTVEL of the same GPS time, before or after the
/// position, or from the inertial velocity with its sigmas. A note states the latency of BESTVEL:
/// its velocities are older than their stamps by that time.
///
/// **Accuracy** is the sigma of latitude and longitude (1 sigma, which `request.accuracy`
/// overrides). INSPVA has none.
///
/// **Height** is above the ellipsoid: the height of BESTPOS or INSPVAX plus the undulation.
///
/// **No fix**: a solution status other than SOL_COMPUTED, an inertial status without a solution,
/// position type NONE, and GPS time UNKNOWN or APPROXIMATE. **Corrupt**: a message of these kinds
/// with a missing or wrong checksum, a garbled number or a value out of range. Everything else is
/// skipped and counted. Abbreviated ASCII (`<BESTPOS`) has no checksum and is not read.
///
/// @throws InputError for the odometry and sensor streams, a column map, companions, and a log that
/// holds only abbreviated ASCII messages
class NovatelReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
