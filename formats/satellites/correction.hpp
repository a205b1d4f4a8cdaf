/// From what a receiver measures to what a position is computed from: satellites at the moment of
/// transmission, and pseudoranges without the satellite's clock and the atmosphere.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/formats/satellites/ephemerides.hpp>

namespace waymark::formats::satellites {

/// One satellite on its first frequency, as it was measured. NaN: not measured.
struct RawMeasurement {
  SatelliteName satellite;
  double pseudorange_m = 0;
  double doppler_hz = std::numeric_limits<double>::quiet_NaN();  ///< positive while the satellite comes near
  double cn0_dbhz = std::numeric_limits<double>::quiet_NaN();
};

/// Makes a measurement of the numbers of a log. A Doppler shift or C/N0 that no receiver measures counts as not measured.
/// @returns nothing if the pseudorange is impossible
[[nodiscard]] std::optional<RawMeasurement> raw_measurement(const SatelliteName& satellite,
                                                            double pseudorange_m, double doppler_hz,
                                                            double cn0_dbhz);

struct RawEpoch {
  Stamp moment;  ///< of the receiver's clock, on the GPS scale
  std::vector<RawMeasurement> satellites;
};

/// A measurement and its satellite at the moment of transmission (axes of that moment, ECEF).
struct PlacedMeasurement {
  RawMeasurement raw;
  SatelliteState satellite;
  double carrier_hz = kL1_hz;
};

/// A measurement that is ready for positioning. NaN: not measured.
struct CorrectedMeasurement {
  PlacedMeasurement placed;
  double pseudorange_m = 0;   ///< distance + clock of the receiver + error
  double range_rate_mps = 0;  ///< with the drift of the receiver's clock only
  SkyDirection direction;
};

/// Finds the satellite of a measurement: the signal left at the moment minus pseudorange / c, by the
/// satellite's own clock, so the clock of the receiver does not matter.
/// @returns nothing without a usable ephemeris
[[nodiscard]] std::optional<PlacedMeasurement> placed(const RawMeasurement& raw, Stamp moment,
                                                      const Ephemerides& ephemerides);

/// Returns about where the receiver is, by the pseudoranges of one epoch (place_from_ranges).
[[nodiscard]] std::optional<Eigen::Vector3d> rough_place(std::span<const PlacedMeasurement> measurements,
                                                         const Eigen::Vector3d& guess);

/// Takes off the satellite's clock, the troposphere and the ionosphere (kTypicalIonosphere without coefficients). A
/// kilometre in the place makes less than a millimetre in the zenith and a few centimetres at the horizon.
/// @param place of the receiver, ECEF, m
[[nodiscard]] CorrectedMeasurement corrected(const PlacedMeasurement& measurement, Stamp moment,
                                             const Eigen::Vector3d& place, const Ephemerides& ephemerides);

}  // namespace waymark::formats::satellites
