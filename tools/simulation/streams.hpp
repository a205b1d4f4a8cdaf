/// The random streams of one seed. New ones go to the end: a number that changes its meaning changes every
/// drive.
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
  kTruthStream
};

}  // namespace waymark::simulation
