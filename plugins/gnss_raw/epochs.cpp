#include <waymark/plugins/gnss_raw/detail/epochs.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <waymark/types_se2/plugin_kit/sensor_readings.hpp>

namespace waymark::plugins::gnss_raw {
namespace {

constexpr double kSameEpoch_s = 1e-3;
constexpr double kLowestOrbit_m = 1e7;
constexpr double kHighestOrbit_m = 6e7;
/// A receiver whose clock is a tenth of a second off is wrong by this much.
constexpr double kLargestPseudorange_m = 1e8;
constexpr double kLargestRate_mps = 1e5;

enum Column : std::size_t {
  kSystem,
  kSatellite,
  kPseudorange,
  kRangeRate,
  kX,
  kY,
  kZ,
  kVx,
  kVy,
  kVz,
  kElevation,
  kCn0
};

int whole_number(const SensorTable& readings, std::size_t row, std::size_t column, const char* name,
                 int otherwise) {
  const double number = readings.at(row, column);
  if (std::isnan(number)) return otherwise;
  if (number != std::floor(number) || number < 0 || number > 1e6)
    fail_reading(readings, row, name, "expected a whole number of 0 to 1000000, got " + shortest(number));
  return static_cast<int>(number);
}

/// Returns a number of a row that may have none.
double measured(const SensorTable& readings, std::size_t row, std::size_t column, const char* name,
                double largest) {
  if (std::isnan(readings.at(row, column))) return readings.at(row, column);
  return number_of_reading(readings, row, column, name, largest);
}

SatelliteReading reading_of(const SensorTable& readings, std::size_t row) {
  SatelliteReading reading;
  reading.system = whole_number(readings, row, kSystem, "system", kGps);
  reading.satellite = whole_number(readings, row, kSatellite, "satellite", 0);
  reading.pseudorange_m = measured(readings, row, kPseudorange, "pseudorange", kLargestPseudorange_m);
  reading.range_rate_mps = measured(readings, row, kRangeRate, "range_rate", kLargestRate_mps);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto column = static_cast<std::size_t>(axis);
    reading.position[axis] = readings.at(row, kX + column);
    reading.velocity[axis] = readings.at(row, kVx + column);
  }
  const double radius = reading.position.norm();
  if (!(radius > kLowestOrbit_m && radius < kHighestOrbit_m))
    fail_reading(readings, row, "satellite_x",
                 "the satellite is " + shortest(std::round(radius / 1000)) +
                     " km from the centre of the Earth; the columns are ECEF, in m");
  if (!std::isnan(reading.range_rate_mps) && reading.velocity.hasNaN())
    fail_reading(readings, row, "satellite_vx", "a range rate needs the velocity of its satellite");
  reading.elevation_rad = readings.at(row, kElevation);
  reading.cn0_dbhz = readings.at(row, kCn0);
  return reading;
}

}  // namespace

std::vector<SensorColumn> raw_columns() {
  return {
      {"system", "1", "", false, "1 GPS (default), 2 SBAS, 4 GLONASS, 8 Galileo, 32 BeiDou"},
      {"satellite", "1", "", true, "number of the satellite in its system"},
      {"pseudorange", "m", "", false, "without the satellite's clock, ionosphere and troposphere"},
      {"range_rate", "m/s", "", false, "from the Doppler shift, without the drift of the satellite's clock"},
      {"satellite_x", "m", "", true, "position of the satellite, ECEF"},
      {"satellite_y", "m", "", true, "position of the satellite, ECEF"},
      {"satellite_z", "m", "", true, "position of the satellite, ECEF"},
      {"satellite_vx", "m/s", "", false, "velocity of the satellite, ECEF; with range_rate"},
      {"satellite_vy", "m/s", "", false, "velocity of the satellite, ECEF"},
      {"satellite_vz", "m/s", "", false, "velocity of the satellite, ECEF"},
      {"elevation", "rad", "", false, "of the satellite above the horizon"},
      {"cn0", "1", "", false, "carrier-to-noise density, dB-Hz"}};
}

std::vector<Epoch> epochs_of(const SensorTable& readings) {
  std::vector<std::size_t> order(readings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return readings.stamps[a] < readings.stamps[b]; });
  std::vector<Epoch> epochs;
  for (const std::size_t row : order) {
    const Stamp stamp = readings.stamps[row];
    if (epochs.empty() || seconds_between(epochs.back().stamp, stamp) > kSameEpoch_s)
      epochs.push_back({stamp, {}});
    const SatelliteReading reading = reading_of(readings, row);
    const bool tells = !std::isnan(reading.pseudorange_m) || !std::isnan(reading.range_rate_mps);
    if (tells) epochs.back().satellites.push_back(reading);
  }
  return epochs;
}

}  // namespace waymark::plugins::gnss_raw
