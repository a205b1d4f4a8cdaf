/// The random streams of one seed. Add new ones at the end: a number with a new meaning would
/// change every drive.
#pragma once

#include <cstdint>

namespace waymark::simulation {

enum SimulationStream : std::uint64_t {
  kRoadStream,
  kTrafficStream,
  kSpeedStream,
  kYawRateStream,
  kOdometryCalibrationStream,
  kGnssBiasStream,
  kGnssFastStream,
  kGnssJitterStream,
  kGnssBurstStream,
  kGnssOutageStream,
  kGnssStatedStream,
  kGnssVelocityStream,
  kTruthStream,
  kVariedStream
};

}  // namespace waymark::simulation
