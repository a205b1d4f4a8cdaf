/// The rows of a log of raw measurements, as epochs of satellites.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/drive/signal_travel.hpp>

namespace waymark::plugins::gnss_raw {

/// Satellite systems by the numbers of libRSF.
enum System : int { kGps = 1, kSbas = 2, kGlonass = 4, kGalileo = 8, kBeidou = 32 };

/// One satellite at one moment. NaN: not measured, or not told.
struct SatelliteReading {
  int system = kGps;
  int satellite = 0;
  double pseudorange_m = 0;
  double range_rate_mps = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< ECEF, m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< ECEF, m/s
  double elevation_rad = 0;
  double cn0_dbhz = 0;
};

struct Epoch {
  Stamp stamp;
  std::vector<SatelliteReading> satellites;
};

/// Returns the columns of the log, in the order that epochs_of() expects.
[[nodiscard]] std::vector<SensorColumn> raw_columns();

/// Gathers rows whose stamps differ by less than a millisecond.
/// @throws InputError for a row that cannot be; it names row and column
[[nodiscard]] std::vector<Epoch> epochs_of(const SensorTable& readings);

}  // namespace waymark::plugins::gnss_raw
