/// Tells for reports which satellite each measurement is of.
#pragma once

#include <string>

#include <waymark/core/drive/measurement_groups.hpp>
#include <waymark/plugins/gnss_raw/detail/epochs.hpp>
#include <waymark/plugins/gnss_raw/detail/local_sky.hpp>

namespace waymark::plugins::gnss_raw {

/// Returns "G05", as RINEX names satellites. A system without a letter keeps its number: "16-05".
[[nodiscard]] std::string satellite_name(int system, int satellite);
/// Returns "GPS", or "system 16".
[[nodiscard]] std::string system_name(int system);

class SatelliteGroups {
 public:
  /// @param groups to fill; null: nobody asks
  explicit SatelliteGroups(MeasurementGroups* groups) : groups_(groups) {}

  void add_pseudorange(EdgePlace edge, const SatelliteReading& reading, const LocalSky& sky) {
    add(edge, reading, sky, "pseudorange", "m");
  }
  void add_range_rate(EdgePlace edge, const SatelliteReading& reading, const LocalSky& sky) {
    add(edge, reading, sky, "range rate", "m/s");
  }

 private:
  void add(EdgePlace edge, const SatelliteReading& reading, const LocalSky& sky, std::string_view quantity,
           std::string_view unit);

  MeasurementGroups* groups_;
};

}  // namespace waymark::plugins::gnss_raw
