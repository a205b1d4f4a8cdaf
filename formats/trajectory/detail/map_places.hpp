/// What the writers of map formats share: checked places, dates.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <waymark/formats/trajectory/map_formats.hpp>

namespace waymark::formats {

/// WGS84, degrees, finite.
struct MapPlace {
  double latitude_deg = 0;
  double longitude_deg = 0;
};

/// The place of a pose or fix. @param format  for the message
/// @throws OutputError "KML: pose 3 at 12.000000000 s: no latitude and longitude"
[[nodiscard]] MapPlace place_of(std::string_view format, std::span<const TrajectoryPoint> points,
                                std::size_t index);
[[nodiscard]] MapPlace place_of(std::string_view format, std::span<const FixPoint> fixes, std::size_t index);

/// "rejected: displacement"; the status alone where the reason adds nothing.
[[nodiscard]] std::string verdict(const FixPoint& fix);

/// The stamp as a date: POSIX nanoseconds; empty where it is none (see map_formats.hpp).
[[nodiscard]] std::optional<Stamp> date_of(Stamp stamp, TimeScale scale);

/// Dates of the stamps of a file: all or none.
class MapDates {
 public:
  MapDates(std::span<const TrajectoryPoint> points, std::span<const FixPoint> fixes, TimeScale scale);
  [[nodiscard]] bool known() const { return known_; }
  /// "2006-06-01T08:16:07.04Z"; only where dates are known.
  [[nodiscard]] std::string text(Stamp stamp) const;

 private:
  TimeScale scale_;
  bool known_ = true;
};

}  // namespace waymark::formats
