/// All broadcast ephemerides of a drive, and the satellites that follow from them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <waymark/formats/satellites/atmosphere.hpp>
#include <waymark/formats/satellites/ephemeris.hpp>

namespace waymark::formats::satellites {

/// A satellite by its system and number in it.
using SatelliteName = std::pair<System, int>;

/// "G05", "R12", as RINEX writes it.
[[nodiscard]] std::string to_string(const SatelliteName& name);

/// Ephemerides of one or several navigation files.
class Ephemerides {
 public:
  void add(const KeplerOrbit& orbit);
  void add(const GlonassOrbit& orbit);

  /// The state of a satellite by the ephemeris nearest in time; an ephemeris is used up to 2 h (GPS), 3 h (Galileo), 1 h
  /// (BeiDou), 30 min (GLONASS) from its time, and a minute more.
  /// @param moment on the GPS scale
  /// @returns nothing without such an ephemeris, or if the satellite is unhealthy
  [[nodiscard]] std::optional<SatelliteState> state(const SatelliteName& name, Stamp moment) const;

  /// Returns the first carrier of a satellite, Hz. Those of GLONASS need an ephemeris; 0 without one.
  [[nodiscard]] double carrier_hz(const SatelliteName& name) const;

  /// Returns how many ephemerides each satellite has.
  [[nodiscard]] std::map<SatelliteName, std::size_t> counts() const;
  [[nodiscard]] bool empty() const { return kepler_.empty() && glonass_.empty(); }
  /// The first and the last time of an ephemeris. Precondition: not empty.
  [[nodiscard]] std::pair<Stamp, Stamp> times() const;

  /// Coefficients of the ionosphere, if a file has them.
  std::optional<KlobucharCoefficients> ionosphere{};

 private:
  std::map<SatelliteName, std::vector<KeplerOrbit>> kepler_;
  std::map<int, std::vector<GlonassOrbit>> glonass_;
};

}  // namespace waymark::formats::satellites
