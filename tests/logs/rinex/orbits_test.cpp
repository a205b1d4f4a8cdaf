// Orbits and delays by theory.
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <waymark/core/drive/signal_travel.hpp>
#include <waymark/formats/satellites/atmosphere.hpp>
#include <waymark/formats/satellites/ephemeris.hpp>

namespace orbits_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark::formats::satellites;

namespace {

constexpr double kGravity = 3.986005e14;
constexpr double kTurn_radps = 7.2921151467e-5;

KeplerOrbit circular() {
  KeplerOrbit orbit;
  orbit.sqrt_a = 5153.7;
  orbit.inclination_rad = 0.96;
  orbit.toe = orbit.toc = Stamp::from_seconds(1e9);
  orbit.toe_sow_s = 0;
  return orbit;
}

/// The velocity in axes that do not turn.
Eigen::Vector3d inertial_velocity(const SatelliteState& state, double turn_radps) {
  return state.velocity + turn_radps * Eigen::Vector3d::UnitZ().cross(state.position);
}

}  // namespace

TEST_CASE("orbits: a circle has the radius and the speed of Kepler, and its clock no relativity") {
  const KeplerOrbit orbit = circular();
  const double radius = orbit.sqrt_a * orbit.sqrt_a;
  for (const double after_s : {-7000.0, 0.0, 1234.5}) {
    const SatelliteState state = state_of(orbit, orbit.toe.later(after_s));
    CHECK(state.position.norm() == Approx(radius).epsilon(1e-12));
    CHECK(inertial_velocity(state, kTurn_radps).norm() == Approx(std::sqrt(kGravity / radius)).epsilon(1e-9));
    CHECK(state.clock_s == 0);
  }
}

TEST_CASE("orbits: the clock has its polynomial, -2 r v / c^2 and the group delay") {
  KeplerOrbit orbit = circular();
  orbit.eccentricity = 0.02;
  orbit.mean_anomaly_rad = 1;
  orbit.clock_bias_s = 1e-4, orbit.clock_drift = 1e-11, orbit.clock_drift_rate_1_s = 1e-17;
  orbit.group_delay_s = 5e-9;
  const double after_s = 3000;
  const SatelliteState state = state_of(orbit, orbit.toe.later(after_s));
  // The mean motion is that of GPS' gravity; r v is the same in turning axes.
  const double relativity = -2 * state.position.dot(state.velocity) / (kLight_mps * kLight_mps);
  CHECK(std::abs(relativity) > 1e-8);
  CHECK(state.clock_s == Approx(1e-4 + 1e-11 * after_s + 1e-17 * after_s * after_s + relativity - 5e-9)
                             .epsilon(1e-12)
                             .margin(1e-14));
  const double rate = (state_of(orbit, orbit.toe.later(after_s + 10)).clock_s -
                       state_of(orbit, orbit.toe.later(after_s - 10)).clock_s) /
                      20;
  CHECK(state.clock_rate == Approx(rate).margin(1e-17));
}

TEST_CASE("orbits: a geostationary satellite of BeiDou hardly moves, by the frame of its own") {
  KeplerOrbit orbit;
  orbit.system = System::beidou;
  orbit.number = 3;
  orbit.toe = orbit.toc = Stamp::from_seconds(1e9);
  orbit.toe_sow_s = 90'000;
  // Its frame is tilted by 5 degrees, so an inclination of 5 degrees there lies in the equator.
  orbit.inclination_rad = 5 * std::numbers::pi / 180;
  orbit.sqrt_a = std::sqrt(std::cbrt(3.986004418e14 / (7.292115e-5 * 7.292115e-5)));
  double least = 1e9;
  // Of the two nodes, one turns the tilt off.
  for (const double node : {0.0, std::numbers::pi}) {
    orbit.node_rad = node + 7.292115e-5 * orbit.toe_sow_s;
    double farthest = 0;
    const Eigen::Vector3d start = state_of(orbit, orbit.toe).position;
    for (double after_s = 0; after_s < 3600; after_s += 600)
      farthest = std::max(farthest, (state_of(orbit, orbit.toe.later(after_s)).position - start).norm());
    least = std::min(least, farthest);
  }
  CHECK(least < 1);
}

TEST_CASE("orbits: the integration of GLONASS goes there and back, and keeps its energy") {
  GlonassOrbit orbit;
  orbit.toe = Stamp::from_seconds(1e9);
  orbit.position = {-6553.42662695e3, 22609.1289062e3, 9851.01660156e3};  // R01 of 2016-06-06 00:15 UTC
  orbit.velocity = {-518.354415894, 1249.16648865, -3213.09471130};
  const Stamp later = orbit.toe.later(1790);
  const SatelliteState there = state_of(orbit, later);
  GlonassOrbit back = orbit;
  back.toe = later;
  back.position = there.position;
  back.velocity = there.velocity;
  CHECK((state_of(back, orbit.toe).position - orbit.position).norm() < 1e-2);
  // In turning axes v^2 / 2 - mu / r - (w rho)^2 / 2 is kept, but for the oblateness, which is known.
  constexpr double kTurn = 7.292115e-5;
  const auto energy = [](const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) {
    const double r = position.norm();
    const double s = position.z() / r;
    const double oblate =
        1.08262575e-3 * 3.9860044e14 * 6'378'136.0 * 6'378'136.0 / (2 * r * r * r) * (3 * s * s - 1);
    return velocity.squaredNorm() / 2 - 3.9860044e14 / r + oblate -
           kTurn * kTurn * position.head<2>().squaredNorm() / 2;
  };
  CHECK(energy(there.position, there.velocity) ==
        Approx(energy(orbit.position, orbit.velocity)).margin(1e-3));
}

TEST_CASE("atmosphere: at night the ionosphere delays by 5 ns in the zenith") {
  const KlobucharCoefficients coefficients{{1e-8, 1e-8, -6e-8, -1e-7}, {9e4, 1e5, -6e4, -5e5}};
  const GeodeticPlace berlin{52.5, 13.4, 80};
  const SkyDirection zenith{0, std::numbers::pi / 2};
  const Stamp midnight = Stamp::from_seconds(1000 * 604'800.0);
  // At 90 degrees the slant factor is 1 + 16 * 0.03^3.
  CHECK(klobuchar_delay_m(coefficients, midnight, berlin, zenith) ==
        Approx(kLight_mps * 5e-9 * (1 + 16 * 0.03 * 0.03 * 0.03)).epsilon(1e-9));
  const Stamp afternoon = midnight.later(13 * 3600);
  CHECK(klobuchar_delay_m(coefficients, afternoon, berlin, zenith) > 2);
  // Near the horizon it is about three times that of the zenith.
  const double low = klobuchar_delay_m(coefficients, midnight, berlin, {0, 0.05});
  CHECK(low / klobuchar_delay_m(coefficients, midnight, berlin, zenith) == Approx(3.0).margin(0.3));
}

TEST_CASE(
    "atmosphere: the troposphere delays by 2.3 m dry and some decimetres wet in the zenith at sea level") {
  const double zenith = troposphere_delay_m({45, 10, 0}, std::numbers::pi / 2);
  CHECK(zenith > 2.35);
  CHECK(zenith < 2.50);
  // Pressure falls by 11.3 % in a kilometre of the standard atmosphere.
  CHECK(troposphere_delay_m({45, 10, 1000}, std::numbers::pi / 2) < zenith - 0.113 * 2.3);
  // 30 degrees above the horizon the way is twice as long.
  CHECK(troposphere_delay_m({45, 10, 0}, std::numbers::pi / 6) == Approx(2 * zenith).epsilon(0.01));
}

}  // namespace orbits_test
