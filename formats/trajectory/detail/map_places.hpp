/// Checked places and dates, for all writers of map formats.
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

/// Returns the place of a pose or fix. @param format for the message
/// @throws OutputError "KML: pose 3 at 12.000000000 s: no latitude and longitude"
[[nodiscard]] MapPlace place_of(std::string_view format, std::span<const TrajectoryPoint> points,
                                std::size_t index);
[[nodiscard]] MapPlace place_of(std::string_view format, std::span<const FixPoint> fixes, std::size_t index);

/// Returns "rejected: displacement", or only the status if the reason adds nothing.
[[nodiscard]] std::string verdict(const FixPoint& fix);

/// The dates of the stamps of a file. Either all stamps are dates or none is.
class MapDates {
 public:
  MapDates(std::span<const TrajectoryPoint> points, std::span<const FixPoint> fixes, TimeScale scale);
  [[nodiscard]] bool known() const { return known_; }
  /// Returns "2006-06-01T08:16:07.04Z". Call it only if dates are known.
  [[nodiscard]] std::string text(Stamp stamp) const;

 private:
  TimeScale scale_;
  bool known_ = true;
};

}  // namespace waymark::formats
