#include <waymark/formats/satellites/correction.hpp>

#include <algorithm>
#include <cmath>

#include <waymark/core/drive/place_from_ranges.hpp>
#include <waymark/core/drive/signal_travel.hpp>
#include <waymark/formats/logs/detail/place/geocentric.hpp>

namespace waymark::formats::satellites {
namespace {

SkyDirection direction_of(const Eigen::Vector3d& satellite, const Eigen::Vector3d& receiver,
                          const GeodeticPlace& place) {
  const Eigen::Vector3d enu =
      enu_from_ecef(place.latitude_deg, place.longitude_deg) * (satellite - receiver).normalized();
  return {std::atan2(enu.x(), enu.y()), std::asin(std::clamp(enu.z(), -1.0, 1.0))};
}

}  // namespace

std::optional<RawMeasurement> raw_measurement(const SatelliteName& satellite, double pseudorange_m,
                                              double doppler_hz, double cn0_dbhz) {
  constexpr double kNearest_m = 1e6;
  constexpr double kFarthest_m = 1e8;
  constexpr double kLargestDoppler_hz = 1e5;
  if (!(pseudorange_m > kNearest_m && pseudorange_m < kFarthest_m)) return std::nullopt;
  RawMeasurement measurement{satellite, pseudorange_m};
  if (std::abs(doppler_hz) < kLargestDoppler_hz) measurement.doppler_hz = doppler_hz;
  if (cn0_dbhz > 0 && cn0_dbhz < 100) measurement.cn0_dbhz = cn0_dbhz;
  return measurement;
}

std::optional<PlacedMeasurement> placed(const RawMeasurement& raw, Stamp moment,
                                        const Ephemerides& ephemerides) {
  const Stamp by_its_clock = moment.later(-raw.pseudorange_m / kLight_mps);
  const auto rough = ephemerides.state(raw.satellite, by_its_clock);
  if (!rough) return std::nullopt;
  // The clock of the satellite is known well enough a millisecond away.
  const auto state = ephemerides.state(raw.satellite, by_its_clock.later(-rough->clock_s));
  if (!state) return std::nullopt;
  return PlacedMeasurement{raw, *state, ephemerides.carrier_hz(raw.satellite)};
}

std::optional<Eigen::Vector3d> rough_place(std::span<const PlacedMeasurement> measurements,
                                           const Eigen::Vector3d& guess) {
  std::vector<MeasuredRange> ranges;
  for (const PlacedMeasurement& measurement : measurements)
    ranges.push_back(
        {turned_with_earth(measurement.satellite.position, measurement.raw.pseudorange_m / kLight_mps),
         measurement.raw.pseudorange_m + kLight_mps * measurement.satellite.clock_s});
  const auto place = place_from_ranges(ranges, guess);
  if (!place) return std::nullopt;
  return place->position;
}

CorrectedMeasurement corrected(const PlacedMeasurement& measurement, Stamp moment,
                               const Eigen::Vector3d& place, const Ephemerides& ephemerides) {
  const SatelliteState& satellite = measurement.satellite;
  const double travel_s = (satellite.position - place).norm() / kLight_mps;
  const GeodeticPlace geodetic = geodetic_from_ecef(place);
  CorrectedMeasurement result;
  result.placed = measurement;
  result.direction = direction_of(turned_with_earth(satellite.position, travel_s), place, geodetic);
  const double ratio = kL1_hz / measurement.carrier_hz;
  const double ionosphere_m = ratio * ratio *
                              klobuchar_delay_m(ephemerides.ionosphere.value_or(kTypicalIonosphere), moment,
                                                geodetic, result.direction);
  result.pseudorange_m = measurement.raw.pseudorange_m + kLight_mps * satellite.clock_s - ionosphere_m -
                         troposphere_delay_m(geodetic, result.direction.elevation_rad);
  result.range_rate_mps =
      kLight_mps * satellite.clock_rate - measurement.raw.doppler_hz * kLight_mps / measurement.carrier_hz;
  return result;
}

}  // namespace waymark::formats::satellites
