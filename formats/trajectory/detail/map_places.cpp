#include <waymark/formats/trajectory/detail/map_places.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/iso8601.hpp>
#include <waymark/formats/text/stamp_text.hpp>

namespace waymark::formats {
namespace {

// 1980-01-13: the second week of GPS
constexpr std::int64_t kEarliestDate = 316'569'600'000'000'000;
constexpr std::int64_t kLatestDate = 8'835'955'200'000'000'000;  // 2250-01-01

MapPlace checked(std::string_view format, std::string_view what, std::size_t index, Stamp stamp,
                 const std::optional<double>& latitude_deg, const std::optional<double>& longitude_deg) {
  const auto fail = [&](std::string_view problem) {
    throw OutputError(
        fmt::format("{}: {} {} at {} s: {}", format, what, index + 1, decimal_seconds(stamp), problem));
  };
  if (!latitude_deg || !longitude_deg) fail("no latitude and longitude");
  if (!std::isfinite(*latitude_deg) || !std::isfinite(*longitude_deg))
    fail("latitude or longitude not finite");
  return {*latitude_deg, *longitude_deg};
}

}  // namespace

MapPlace place_of(std::string_view format, std::span<const TrajectoryPoint> points, std::size_t index) {
  const TrajectoryPoint& point = points[index];
  return checked(format, "pose", index, point.stamp, point.latitude_deg, point.longitude_deg);
}

MapPlace place_of(std::string_view format, std::span<const FixPoint> fixes, std::size_t index) {
  const FixPoint& fix = fixes[index];
  return checked(format, "fix", index, fix.stamp, fix.latitude_deg, fix.longitude_deg);
}

std::string verdict(const FixPoint& fix) {
  return fix.reason.empty() || fix.reason == fix.status ? fix.status : fix.status + ": " + fix.reason;
}

std::optional<Stamp> date_of(Stamp stamp, TimeScale scale) {
  if (stamp.nanoseconds >= kLatestDate) return std::nullopt;  // before convert() could overflow
  const Stamp date = convert(stamp, scale, TimeScale::utc);
  if (date.nanoseconds < kEarliestDate || date.nanoseconds >= kLatestDate) return std::nullopt;
  return date;
}

MapDates::MapDates(std::span<const TrajectoryPoint> points, std::span<const FixPoint> fixes, TimeScale scale)
    : scale_(scale) {
  const auto is_date = [&](const auto& point) { return date_of(point.stamp, scale_).has_value(); };
  known_ =
      std::all_of(points.begin(), points.end(), is_date) && std::all_of(fixes.begin(), fixes.end(), is_date);
}

std::string MapDates::text(Stamp stamp) const {
  return iso8601_from_stamp(convert(stamp, scale_, TimeScale::utc));
}

}  // namespace waymark::formats
