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
