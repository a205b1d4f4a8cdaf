/// The random streams of one seed. Add new ones at the end: a number with a new meaning would
/// change every drive.
#pragma once

#include <cstddef>
#include <cstdint>

#include <waymark/tools/simulation/random.hpp>

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
  kVariedStream,
  kOdometryOutageStream,
  kCommonBiasStream,
  kCommonFastStream
};

/// The streams of one source. The sources of a drive draw apart from each other.
class SourceStreams {
 public:
  /// @param index of the source among those of its kind; 0 is the source of a drive with one
  SourceStreams(std::uint64_t seed, std::size_t index) : seed_(seed), first_(kStreamsPerSource * index) {}

  [[nodiscard]] RandomStream of(SimulationStream part) const { return {seed_, first_ + part}; }

 private:
  static constexpr std::uint64_t kStreamsPerSource = 1024;
  std::uint64_t seed_;
  std::uint64_t first_;
};

}  // namespace waymark::simulation
