#include <waymark/tools/drive/clocks/offset_names.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include <waymark/formats/logs/detail/common/gps_time.hpp>
#include <waymark/tools/drive/clocks/clock_sync.hpp>

namespace waymark::drive {
namespace {

constexpr double kWeek_s = formats::kGpsWeekNanoseconds / 1e9;
constexpr double kRollover_s = 1024 * kWeek_s;
constexpr double kGpsEpoch_s = formats::kGpsEpochPosix / 1e9;
constexpr double kHalfHour_s = 1800;
constexpr double kMostZone_s = 14 * 3600;

/// An offset that has a name.
struct Known {
  double seconds;
  std::string name;
  bool is_rollover = false;
};

/// Returns the large offsets nearest to one, and none at all: leap seconds may be beside each.
std::vector<Known> large_offsets(double seconds) {
  std::vector<Known> known = {{0, ""}};
  const double sign = seconds < 0 ? -1 : 1;
  known.push_back({sign * kGpsEpoch_s, "the GPS epoch against the Unix epoch"});
  const double weeks = std::round(seconds / kWeek_s);
  const double rollovers = std::round(seconds / kRollover_s);
  if (rollovers != 0)
    known.push_back({rollovers * kRollover_s,
                     fmt::format("{} GPS weeks (a rollover of the week number)", 1024 * std::abs(rollovers)),
                     true});
  if (weeks != 0 && std::abs(weeks) < 4000)
    known.push_back({weeks * kWeek_s, std::abs(weeks) == 1 ? std::string("a GPS week")
                                                           : fmt::format("{} GPS weeks", std::abs(weeks))});
  const double zone = std::round(seconds / kHalfHour_s) * kHalfHour_s;
  if (zone != 0 && std::abs(zone) <= kMostZone_s)
    known.push_back({zone, fmt::format("{:g} h of a time zone", std::abs(zone) / 3600)});
  return known;
}

/// Empty: it is no number of leap seconds. GPS time has been ahead of UTC by 13 s from 1999, 18 s from 2017. Within
/// the 1024 weeks before these days 4 or 5 were added.
std::optional<std::string> leap_name(double seconds, bool beside_rollover, double tolerance_s) {
  const double count = std::round(std::abs(seconds));
  if (std::abs(std::abs(seconds) - count) > tolerance_s) return std::nullopt;
  if (count == 0) return "";
  if (beside_rollover && (count == 4 || count == 5)) return fmt::format("{} leap seconds", count);
  if (count < 13 || count > 18) return std::nullopt;
  return fmt::format("{} leap seconds (GPS time against UTC)", count);
}

}  // namespace

std::string name_of_offset(double seconds, double tolerance_s) {
  for (const Known& known : large_offsets(seconds)) {
    const std::optional<std::string> leap =
        leap_name(seconds - known.seconds, known.is_rollover, tolerance_s);
    if (!leap) {
      if (known.seconds != 0 && std::abs(seconds - known.seconds) <= tolerance_s) return known.name;
      continue;
    }
    if (known.name.empty() && leap->empty()) continue;
    return known.name + (known.name.empty() || leap->empty() ? "" : " and ") + *leap;
  }
  return {};
}

std::string offset_in_words(const ClockOffset& offset) {
  const std::string name = name_of_offset(offset.late_s, std::clamp(3 * offset.sigma_s, 0.5, 5.0));
  return name.empty() ? "" : ", " + name;
}

}  // namespace waymark::drive
