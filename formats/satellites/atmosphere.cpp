#include <waymark/formats/satellites/atmosphere.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <waymark/core/drive/signal_travel.hpp>

namespace waymark::formats::satellites {
namespace {

constexpr double kHalfTurn_rad = std::numbers::pi;
constexpr double kDay_s = 86'400;
constexpr double kNoon_s = 50'400;  // 14:00 local time, where the delay is greatest

double polynomial(const std::array<double, 4>& coefficients, double x) {
  return coefficients[0] + x * (coefficients[1] + x * (coefficients[2] + x * coefficients[3]));
}

}  // namespace

double klobuchar_delay_m(const KlobucharCoefficients& coefficients, Stamp moment, const GeodeticPlace& place,
                         const SkyDirection& direction) {
  // Angles are semicircles, as in the specification.
  const double elevation = std::max(direction.elevation_rad, 0.0) / kHalfTurn_rad;
  const double central = 0.0137 / (elevation + 0.11) - 0.022;
  const double latitude =
      std::clamp(place.latitude_deg / 180 + central * std::cos(direction.azimuth_rad), -0.416, 0.416);
  const double longitude = place.longitude_deg / 180 +
                           central * std::sin(direction.azimuth_rad) / std::cos(latitude * kHalfTurn_rad);
  const double magnetic = latitude + 0.064 * std::cos((longitude - 1.617) * kHalfTurn_rad);
  const auto day_ns = static_cast<std::int64_t>(kDay_s * 1e9);
  double local_s = 43'200 * longitude + static_cast<double>(moment.nanoseconds % day_ns) * 1e-9;
  local_s -= kDay_s * std::floor(local_s / kDay_s);
  const double slant = 1 + 16 * std::pow(0.53 - elevation, 3);
  const double period_s = std::max(polynomial(coefficients.beta, magnetic), 72'000.0);
  const double phase = 2 * kHalfTurn_rad * (local_s - kNoon_s) / period_s;
  double delay_s = 5e-9;
  if (std::abs(phase) < 1.57)
    delay_s += std::max(polynomial(coefficients.alpha, magnetic), 0.0) *
               (1 - phase * phase / 2 + phase * phase * phase * phase / 24);
  return kLight_mps * slant * delay_s;
}

double troposphere_delay_m(const GeodeticPlace& place, double elevation_rad) {
  const double height_m = std::clamp(place.height_m, 0.0, 10'000.0);
  const double pressure_hpa = 1013.25 * std::pow(1 - 2.2557e-5 * height_m, 5.2568);
  const double kelvin = 288.15 - 6.5e-3 * height_m;
  const double vapour_hpa = 0.7 * 6.108 * std::exp((17.15 * kelvin - 4684) / (kelvin - 38.45));
  const double latitude = place.latitude_deg / 180 * kHalfTurn_rad;
  const double dry_m = 0.0022768 * pressure_hpa / (1 - 0.00266 * std::cos(2 * latitude) - 0.28e-6 * height_m);
  const double wet_m = 0.002277 * (1255 / kelvin + 0.05) * vapour_hpa;
  const double s = std::sin(elevation_rad);
  return (dry_m + wet_m) * 1.001 / std::sqrt(0.002001 + s * s);
}

}  // namespace waymark::formats::satellites
