/// Broadcast ephemerides: where a satellite is, and how wrong its clock is.
#pragma once

#include <Eigen/Core>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/satellites/constants.hpp>

namespace waymark::formats::satellites {

/// A satellite at a moment, in the axes that the Earth has at that moment (ECEF).
struct SatelliteState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  double clock_s =
      0;  ///< its clock is fast by this, relativity and group delay of the first frequency included
  double clock_rate = 0;  ///< s/s
};

/// Kepler's elements with the corrections of GPS, Galileo and BeiDou. Names and formulas are those of
/// IS-GPS-200, table 20-IV; the others have the same elements.
struct KeplerOrbit {
  System system = System::gps;
  int number = 0;
  Stamp toe;             ///< time of ephemeris on the GPS scale
  Stamp toc;             ///< time of the clock polynomial on the GPS scale
  double toe_sow_s = 0;  ///< time of ephemeris, s of the week of the system's own scale
  double clock_bias_s = 0, clock_drift = 0, clock_drift_rate_1_s = 0;
  double group_delay_s = 0;  ///< TGD, BGD or TGD1: taken off the clock for the first frequency
  double sqrt_a = 0;         ///< sqrt(m)
  double eccentricity = 0;
  double mean_anomaly_rad = 0;
  double mean_motion_difference_radps = 0;
  double node_rad = 0, node_rate_radps = 0;  ///< longitude of the ascending node at the begin of the week
  double inclination_rad = 0, inclination_rate_radps = 0;
  double perigee_rad = 0;
  double cuc = 0, cus = 0;  ///< rad
  double crc = 0, crs = 0;  ///< m
  double cic = 0, cis = 0;  ///< rad
  bool is_healthy = true;
};

/// Tells whether a satellite of BeiDou stands still over the equator: BDS-2 has 1 to 5, BDS-3 59 to 63.
[[nodiscard]] bool is_geostationary_beidou(int number);

/// Tells whether the elements are those of an orbit that navigation satellites have.
[[nodiscard]] bool is_possible(const KeplerOrbit& orbit);

/// Position, velocity and acceleration of a GLONASS satellite at one moment.
struct GlonassOrbit {
  int number = 0;
  Stamp toe;                                               ///< on the GPS scale
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< PZ-90, m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< of Sun and Moon, m/s^2
  double clock_bias_s = 0;                                 ///< -TauN
  double clock_drift = 0;                                  ///< GammaN
  int channel = 0;                                         ///< of its frequency, -7 .. 6
  bool is_healthy = true;
};

/// Tells whether the numbers are those of a GLONASS satellite.
[[nodiscard]] bool is_possible(const GlonassOrbit& orbit);

/// Computes a satellite of Kepler's elements (IS-GPS-200, 20.3.3.4.3; BeiDou's geostationary satellites by
/// its BDS-SIS-ICD, 5.2.4.12). The velocity is the difference of positions half a second before and after:
/// its error is a few micrometres per second.
/// @param moment on the GPS scale
[[nodiscard]] SatelliteState state_of(const KeplerOrbit& orbit, Stamp moment);

/// Integrates the motion of a GLONASS satellite by Runge-Kutta of fourth order in steps of a minute, with
/// the Earth's oblateness and the stated acceleration of Sun and Moon (GLONASS ICD 5.1, A.3.1.2).
[[nodiscard]] SatelliteState state_of(const GlonassOrbit& orbit, Stamp moment);

}  // namespace waymark::formats::satellites
