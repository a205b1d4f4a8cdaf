/// Delays of the atmosphere by models that need no measurements.
#pragma once

#include <array>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/logs/detail/place/geocentric.hpp>

namespace waymark::formats::satellites {

/// The eight coefficients that GPS broadcasts for the ionosphere.
struct KlobucharCoefficients {
  std::array<double, 4> alpha{};  ///< s per power of a semicircle
  std::array<double, 4> beta{};   ///< s per power of a semicircle
};

/// What stands for coefficients that nobody has: those that GPS broadcast on 1 January 2004, when the Sun was
/// neither quiet nor active. They may be wrong by half of the delay, which is still better than all of it: a
/// delay that is left makes heights too large by metres. RTKLIB falls back to the same ones.
inline constexpr KlobucharCoefficients kTypicalIonosphere{{1.118e-8, -7.451e-9, -5.961e-8, 1.192e-7},
                                                          {1.167e5, -2.294e5, -1.311e5, 1.049e6}};

/// The direction of a satellite.
struct SkyDirection {
  double azimuth_rad = 0;    ///< clockwise from north
  double elevation_rad = 0;  ///< above the horizon
};

/// Returns the delay in the ionosphere at L1, m (IS-GPS-200, 20.3.3.5.2.5). At another frequency f it is
/// (L1 / f)^2 times that. @param moment on the GPS scale
[[nodiscard]] double klobuchar_delay_m(const KlobucharCoefficients& coefficients, Stamp moment,
                                       const GeodeticPlace& place, const SkyDirection& direction);

/// Returns the delay in the troposphere, m: Saastamoinen's zenith delays in the standard atmosphere at 70 %
/// humidity, mapped by 1.001 / sqrt(0.002001 + sin^2(elevation)) (RTCA DO-229, A.4.2.4).
[[nodiscard]] double troposphere_delay_m(const GeodeticPlace& place, double elevation_rad);

}  // namespace waymark::formats::satellites
