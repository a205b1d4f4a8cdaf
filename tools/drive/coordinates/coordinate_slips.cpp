#include <waymark/tools/drive/coordinates/coordinate_slips.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

namespace waymark::drive {
namespace {

constexpr double kMetresPerDegree = 111'195;  // of latitude, on a sphere of 6371 km
constexpr double kRadians = std::numbers::pi / 180;

/// "52.162147" for 52 degrees and 16.2147 minutes.
double from_minutes(double written) {
  const double degrees = std::trunc(written);
  return degrees + (written - degrees) / 0.6;
}

constexpr std::array<CoordinateSlip, 4> kSlips{{
    {"latitude and longitude are exchanged",
     [](const GeodeticPoint& at) {
       return GeodeticPoint{at.longitude_deg, at.latitude_deg};
     }},
    {"the sign of the longitude is lost (W is negative)",
     [](const GeodeticPoint& at) {
       return GeodeticPoint{at.latitude_deg, -at.longitude_deg};
     },
     true},
    {"the sign of the latitude is lost (S is negative)",
     [](const GeodeticPoint& at) {
       return GeodeticPoint{-at.latitude_deg, at.longitude_deg};
     },
     true},
    {"degrees and minutes are read as degrees (NMEA's ddmm.mmmm divided by 100; state the column as it was, "
     "with 'unit: ddmm')",
     [](const GeodeticPoint& at) {
       return GeodeticPoint{from_minutes(at.latitude_deg), from_minutes(at.longitude_deg)};
     }},
}};

bool is_place(const GeodeticPoint& at) {
  return std::abs(at.latitude_deg) <= 90 && std::abs(at.longitude_deg) <= 360;
}

/// On a sphere, which is near enough to tell kilometres.
double distance_m(const GeodeticPoint& a, const GeodeticPoint& b) {
  const double half_latitude = (a.latitude_deg - b.latitude_deg) * kRadians / 2;
  const double half_longitude = (a.longitude_deg - b.longitude_deg) * kRadians / 2;
  const double chord = std::pow(std::sin(half_latitude), 2) + std::cos(a.latitude_deg * kRadians) *
                                                                  std::cos(b.latitude_deg * kRadians) *
                                                                  std::pow(std::sin(half_longitude), 2);
  return 2 * kMetresPerDegree / kRadians * std::asin(std::min(1.0, std::sqrt(chord)));
}

struct Pair {
  GeodeticPoint fix, truth;
};

/// Fixes with the truth of their time, at most a hundred.
std::vector<Pair> pairs_of(std::span<const GeodeticFix> fixes, std::span<const GeodeticTruth> truth) {
  constexpr std::size_t kMost = 100;
  constexpr double kSameTime_s = 5;
  std::vector<Pair> pairs;
  const std::size_t step = std::max<std::size_t>(1, fixes.size() / kMost);
  for (std::size_t i = 0; i < fixes.size(); i += step) {
    const auto after = std::lower_bound(truth.begin(), truth.end(), fixes[i].stamp,
                                        [](const GeodeticTruth& t, Stamp stamp) { return t.stamp < stamp; });
    if (after == truth.end() || seconds_between(fixes[i].stamp, after->stamp) > kSameTime_s) continue;
    pairs.push_back(
        {{fixes[i].latitude_deg, fixes[i].longitude_deg}, {after->latitude_deg, after->longitude_deg}});
  }
  return pairs;
}

/// @param mend_fix, mend_truth null: as written
double median_distance_m(std::span<const Pair> pairs, const CoordinateSlip* mend_fix,
                         const CoordinateSlip* mend_truth) {
  constexpr double kNowhere_m = 1e8;
  std::vector<double> distances;
  for (const Pair& pair : pairs) {
    const GeodeticPoint fix = mend_fix == nullptr ? pair.fix : mend_fix->mended(pair.fix);
    const GeodeticPoint truth = mend_truth == nullptr ? pair.truth : mend_truth->mended(pair.truth);
    distances.push_back(is_place(fix) && is_place(truth) ? distance_m(fix, truth) : kNowhere_m);
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

std::span<const CoordinateSlip> coordinate_slips() {
  return kSlips;
}

std::vector<std::string> words_of(std::span<const CoordinateSlip* const> slips) {
  std::vector<std::string> words;
  bool mirrored = false;
  for (const CoordinateSlip* slip : slips) {
    if (slip->mirrors && mirrored) continue;
    mirrored = mirrored || slip->mirrors;
    words.emplace_back(slip->mirrors ? "the sign of a longitude (W) or latitude (S) is lost" : slip->words);
  }
  return words;
}

Eigen::Matrix2d mending(const CoordinateSlip& slip, const GeodeticPoint& at) {
  constexpr double kStep_deg = 1e-6;
  const GeodeticPoint here = slip.mended(at);
  const auto way = [&](const GeodeticPoint& written) -> Eigen::Vector2d {
    const GeodeticPoint meant = slip.mended(written);
    return kMetresPerDegree * Eigen::Vector2d((meant.longitude_deg - here.longitude_deg) *
                                                  std::cos(here.latitude_deg * kRadians),
                                              meant.latitude_deg - here.latitude_deg);
  };
  const double east_m = kMetresPerDegree * kStep_deg * std::cos(at.latitude_deg * kRadians);
  const double north_m = kMetresPerDegree * kStep_deg;
  Eigen::Matrix2d result;
  result.col(0) = way({at.latitude_deg, at.longitude_deg + kStep_deg}) / east_m;
  result.col(1) = way({at.latitude_deg + kStep_deg, at.longitude_deg}) / north_m;
  return result;
}

std::string warning_of_distance(std::span<const GeodeticFix> fixes, std::span<const GeodeticTruth> truth) {
  constexpr double kFar_m = 1000;
  const std::vector<Pair> pairs = pairs_of(fixes, truth);
  if (pairs.empty()) return {};
  const double apart_m = median_distance_m(pairs, nullptr, nullptr);
  if (!(apart_m > kFar_m)) return {};
  const std::string fact = fmt::format("the truth is {:.1f} km from the fixes of its time (median of {})",
                                       apart_m / 1000, pairs.size());
  for (const CoordinateSlip& slip : kSlips) {
    const bool in_fixes = median_distance_m(pairs, &slip, nullptr) < kFar_m;
    const bool in_truth = median_distance_m(pairs, nullptr, &slip) < kFar_m;
    if (!in_fixes && !in_truth) continue;
    const char* where = in_fixes && in_truth ? "one of them" : in_fixes ? "the fixes" : "the truth";
    return fmt::format("{}: in {} {}", fact, where, slip.words);
  }
  return fact + ": they are of different drives or frames";
}

}  // namespace waymark::drive
