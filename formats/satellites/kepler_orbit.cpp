#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <waymark/core/drive/signal_travel.hpp>
#include <waymark/formats/satellites/ephemeris.hpp>

namespace waymark::formats::satellites {
namespace {

constexpr double kHalfStep_s = 0.5;
constexpr double kGeostationaryTilt_rad = 5 * std::numbers::pi / 180;
constexpr int kKeplerIterations = 30;

struct Earth {
  double gravity;  ///< m^3/s^2
  double rotation_radps;
};

Earth earth_of(System system) {
  if (system == System::gps) return {3.986005e14, kEarthRate_radps};
  if (system == System::galileo) return {3.986004418e14, kEarthRate_radps};
  return {3.986004418e14, 7.292115e-5};
}

double eccentric_anomaly(double mean, double eccentricity) {
  double anomaly = mean;
  for (int i = 0; i < kKeplerIterations; ++i) {
    const double step =
        (anomaly - eccentricity * std::sin(anomaly) - mean) / (1 - eccentricity * std::cos(anomaly));
    anomaly -= step;
    if (std::abs(step) < 1e-14) break;
  }
  return anomaly;
}

struct InPlane {
  double anomaly_rad;  ///< eccentric
  double latitude_rad, radius_m, inclination_rad;
};

InPlane in_plane(const KeplerOrbit& orbit, double dt, double gravity) {
  const double a = orbit.sqrt_a * orbit.sqrt_a;
  const double motion = std::sqrt(gravity / (a * a * a)) + orbit.mean_motion_difference_radps;
  const double e = orbit.eccentricity;
  const double anomaly = eccentric_anomaly(orbit.mean_anomaly_rad + motion * dt, e);
  const double argument =
      std::atan2(std::sqrt(1 - e * e) * std::sin(anomaly), std::cos(anomaly) - e) + orbit.perigee_rad;
  const double c = std::cos(2 * argument);
  const double s = std::sin(2 * argument);
  return {anomaly, argument + orbit.cus * s + orbit.cuc * c,
          a * (1 - e * std::cos(anomaly)) + orbit.crs * s + orbit.crc * c,
          orbit.inclination_rad + orbit.inclination_rate_radps * dt + orbit.cis * s + orbit.cic * c};
}

Eigen::Vector3d position_at(const KeplerOrbit& orbit, double dt) {
  const Earth earth = earth_of(orbit.system);
  const InPlane plane = in_plane(orbit, dt, earth.gravity);
  const bool geostationary = orbit.system == System::beidou && is_geostationary_beidou(orbit.number);
  const double turned = earth.rotation_radps * (orbit.toe_sow_s + (geostationary ? 0 : dt));
  const double node = orbit.node_rad + orbit.node_rate_radps * dt - turned;
  const Eigen::Vector3d place(plane.radius_m * std::cos(plane.latitude_rad),
                              plane.radius_m * std::sin(plane.latitude_rad), 0);
  const Eigen::Matrix3d to_equator = (Eigen::AngleAxisd(node, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(plane.inclination_rad, Eigen::Vector3d::UnitX()))
                                         .toRotationMatrix();
  if (!geostationary) return to_equator * place;
  // Their elements are in a frame that does not turn, tilted by 5 degrees.
  return Eigen::AngleAxisd(-earth.rotation_radps * dt, Eigen::Vector3d::UnitZ()) *
         (Eigen::AngleAxisd(kGeostationaryTilt_rad, Eigen::Vector3d::UnitX()) * (to_equator * place));
}

/// -2 sqrt(mu) / c^2 e sqrt(a) sin E: the clock of an eccentric orbit.
double relativity_s(const KeplerOrbit& orbit, double dt) {
  const double gravity = earth_of(orbit.system).gravity;
  const double anomaly = in_plane(orbit, dt, gravity).anomaly_rad;
  return -2 * std::sqrt(gravity) / (kLight_mps * kLight_mps) * orbit.eccentricity * orbit.sqrt_a *
         std::sin(anomaly);
}

}  // namespace

bool is_geostationary_beidou(int number) {
  return number <= 5 || number >= 59;
}

bool is_possible(const KeplerOrbit& orbit) {
  constexpr double kWeek_s = 604'800;
  return orbit.eccentricity >= 0 && orbit.eccentricity < 0.5 && orbit.sqrt_a > 4000 && orbit.sqrt_a < 8000 &&
         orbit.toe_sow_s >= 0 && orbit.toe_sow_s <= kWeek_s;
}

SatelliteState state_of(const KeplerOrbit& orbit, Stamp moment) {
  const double dt = seconds_between(orbit.toe, moment);
  const double since_toc = seconds_between(orbit.toc, moment);
  SatelliteState state;
  state.position = position_at(orbit, dt);
  state.velocity =
      (position_at(orbit, dt + kHalfStep_s) - position_at(orbit, dt - kHalfStep_s)) / (2 * kHalfStep_s);
  state.clock_s = orbit.clock_bias_s +
                  since_toc * (orbit.clock_drift + since_toc * orbit.clock_drift_rate_1_s) +
                  relativity_s(orbit, dt) - orbit.group_delay_s;
  state.clock_rate =
      orbit.clock_drift + 2 * since_toc * orbit.clock_drift_rate_1_s +
      (relativity_s(orbit, dt + kHalfStep_s) - relativity_s(orbit, dt - kHalfStep_s)) / (2 * kHalfStep_s);
  return state;
}

}  // namespace waymark::formats::satellites
