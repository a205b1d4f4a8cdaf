/// Writes a fused drive for maps, as text: GeoJSON (with a style for QGIS), KML and
/// GPX. All use WGS84.
///
/// A place that is missing or not finite is an OutputError that names the point, and nothing is
/// written. Text may hold anything; characters that the format forbids (bytes that are no UTF-8,
/// control characters) are replaced. Lines across the antimeridian are not cut.
///
/// KML and GPX have times in UTC only, so stamps are converted from their scale. Seconds of a week
/// or of a simulation are no dates. If one stamp of the file is before 1980-01-13 or after 2249,
/// the whole file has no times. Places in these two formats have nine decimals (0.1 mm).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/trajectory/trajectory.hpp>

namespace waymark::formats {

/// Returns a stamp as a date in POSIX nanoseconds. Empty if it is no date, as above.
[[nodiscard]] std::optional<Stamp> date_of(Stamp stamp, TimeScale scale);

/// A fix on a map.
struct FixPoint {
  Stamp stamp;
  double latitude_deg = 0;  ///< WGS84
  double longitude_deg = 0;
  std::string status;
  std::string reason;
  int source = 0;  ///< index of the receiver
};

/// Returns a GeoJSON FeatureCollection (RFC 7946: longitude first). The fused trajectory is one
/// LineString; it is left out if it has fewer than two points. Every fix is a Point with properties
/// "stamp_ns", "status" and "reason". Rejected and withheld fixes have a "marker-color"
/// (simplestyle), so that common viewers show them. Numbers have the shortest digits that read back
/// to the same double.
/// @param name name of the trajectory, one of its properties
[[nodiscard]] std::string trajectory_geojson(std::span<const TrajectoryPoint> points,
                                             std::span<const FixPoint> fixes, std::string_view name);

/// Returns the style of that GeoJSON for QGIS (QML of QGIS 3.22): the trajectory as a line, and the
/// fixes of each status as a rule with a colour and a shape. QGIS loads it by itself if it lies
/// beside the GeoJSON under the same name with the ending .qml.
[[nodiscard]] std::string trajectory_qml();

/// Returns KML 2.2 (OGC 07-147r2) with gx:Track. Google Earth reads nothing newer, and readers of
/// 2.3 accept it. It contains
/// - the fused trajectory as LineString with every pose, and as gx:Track with one pose per second
///   for the time slider (hidden at first, and left out without dates);
/// - the fixes of each receiver as a LineString;
/// - a folder for each status with its fixes as points. The description has reason and time; the
///   time is also a TimeStamp. Each status has a colour and a shape.
[[nodiscard]] std::string trajectory_kml(std::span<const TrajectoryPoint> points,
                                         std::span<const FixPoint> fixes, std::string_view name,
                                         TimeScale scale);

/// Returns GPX 1.1. The fused trajectory is one track with one segment, and every pose has its time
/// to the nanosecond. The fixes are waypoints: `type` is the status and `desc` is, for example,
/// "rejected: displacement".
[[nodiscard]] std::string trajectory_gpx(std::span<const TrajectoryPoint> points,
                                         std::span<const FixPoint> fixes, std::string_view name,
                                         TimeScale scale);

}  // namespace waymark::formats
