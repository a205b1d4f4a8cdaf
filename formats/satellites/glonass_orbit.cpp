#include <cmath>

#include <waymark/formats/satellites/ephemeris.hpp>

namespace waymark::formats::satellites {
namespace {

// PZ-90.02
constexpr double kPz90Gravity = 3.9860044e14;
constexpr double kPz90Radius_m = 6'378'136;
constexpr double kPz90Oblateness = 1.08262575e-3;
constexpr double kPz90Rotation_radps = 7.292115e-5;
constexpr double kGlonassIntegration_s = 60;

using OrbitMotion = Eigen::Matrix<double, 6, 1>;  ///< position, velocity

/// Returns the derivative of a motion in axes that turn with the Earth.
OrbitMotion derivative(const OrbitMotion& motion, const Eigen::Vector3d& sun_and_moon) {
  const Eigen::Vector3d at = motion.head<3>();
  const Eigen::Vector3d velocity = motion.tail<3>();
  const double r2 = at.squaredNorm();
  const double r = std::sqrt(r2);
  const double pull = kPz90Gravity / (r2 * r);
  const double oblate = 1.5 * kPz90Oblateness * kPz90Gravity * kPz90Radius_m * kPz90Radius_m / (r2 * r2 * r);
  const double tilt = 5 * at.z() * at.z() / r2;
  const double turn2 = kPz90Rotation_radps * kPz90Rotation_radps;
  OrbitMotion result;
  result.head<3>() = velocity;
  result[3] = (-pull - oblate * (1 - tilt) + turn2) * at.x() + 2 * kPz90Rotation_radps * velocity.y();
  result[4] = (-pull - oblate * (1 - tilt) + turn2) * at.y() - 2 * kPz90Rotation_radps * velocity.x();
  result[5] = (-pull - oblate * (3 - tilt)) * at.z();
  result.tail<3>() += sun_and_moon;
  return result;
}

OrbitMotion after(const OrbitMotion& motion, double dt, const Eigen::Vector3d& sun_and_moon) {
  const OrbitMotion k1 = derivative(motion, sun_and_moon);
  const OrbitMotion k2 = derivative(motion + dt / 2 * k1, sun_and_moon);
  const OrbitMotion k3 = derivative(motion + dt / 2 * k2, sun_and_moon);
  const OrbitMotion k4 = derivative(motion + dt * k3, sun_and_moon);
  return motion + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

}  // namespace

bool is_possible(const GlonassOrbit& orbit) {
  const double radius_m = orbit.position.norm();
  return radius_m > 2e7 && radius_m < 3e7 && orbit.velocity.norm() < 1e4 && orbit.acceleration.norm() < 1 &&
         std::abs(orbit.channel) <= 13;
}

SatelliteState state_of(const GlonassOrbit& orbit, Stamp moment) {
  const double dt = seconds_between(orbit.toe, moment);
  OrbitMotion motion;
  motion << orbit.position, orbit.velocity;
  for (double left = dt; std::abs(left) > 0;) {
    const double step =
        std::abs(left) < kGlonassIntegration_s ? left : std::copysign(kGlonassIntegration_s, dt);
    motion = after(motion, step, orbit.acceleration);
    left = std::abs(left) < kGlonassIntegration_s ? 0 : left - step;
  }
  // Relativity is in the broadcast clock already.
  return {motion.head<3>(), motion.tail<3>(), orbit.clock_bias_s + orbit.clock_drift * dt, orbit.clock_drift};
}

}  // namespace waymark::formats::satellites
