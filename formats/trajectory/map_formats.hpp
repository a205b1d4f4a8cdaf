/// A fused drive for maps, as text: GeoJSON, KML and GPX. All are WGS84.
///
/// A place that is not finite, or that a point lacks, is an OutputError that names the point: nothing is
/// written. Text may be anything; what the format cannot hold (bytes that are no UTF-8, control characters)
/// is replaced. Lines over the antimeridian are not cut.
///
/// KML and GPX know times in UTC only. Stamps are converted from their scale; where one of the file lies
/// before 1980-01-13, as seconds of a week or of a simulation do, or after 2249, no time of the file is a
/// date, and it has none. Places of these two have nine decimals, 0.1 mm.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/formats/trajectory/trajectory.hpp>

namespace waymark::formats {

/// A fix on a map.
struct FixPoint {
  Stamp stamp;
  double latitude_deg = 0;  ///< WGS84
  double longitude_deg = 0;
  std::string status;
  std::string reason;
  int source = 0;  ///< index of the receiver
};

/// A GeoJSON FeatureCollection (RFC 7946: longitude first): the fused trajectory as one LineString (left out
/// below two points), every fix as a Point with properties "stamp_ns", "status", "reason"; rejected and
/// withheld ones carry a "marker-color" (simplestyle), so that they show on common viewers. Numbers have the
/// shortest digits that read back to the same double.
/// @param name  of the trajectory; goes into its properties.
[[nodiscard]] std::string trajectory_geojson(std::span<const TrajectoryPoint> points,
                                             std::span<const FixPoint> fixes, std::string_view name);

/// KML 2.2 (OGC 07-147r2; Google Earth reads nothing newer, and readers of 2.3 take it) with gx:Track:
/// - the fused trajectory as LineString with every pose and, hidden at first, as gx:Track with a pose a
/// second
///   for the time slider (left out without dates);
/// - the fixes of each receiver as a LineString;
/// - a folder for each status with its fixes as points: reason and time in the description, the time as
///   TimeStamp too. Each status has a colour and a shape.
[[nodiscard]] std::string trajectory_kml(std::span<const TrajectoryPoint> points,
                                         std::span<const FixPoint> fixes, std::string_view name,
                                         TimeScale scale);

/// GPX 1.1: the fused trajectory as one track of one segment, every pose with its time to the nanosecond; the
/// fixes as waypoints with `type` the status and `desc` "rejected: displacement".
[[nodiscard]] std::string trajectory_gpx(std::span<const TrajectoryPoint> points,
                                         std::span<const FixPoint> fixes, std::string_view name,
                                         TimeScale scale);

}  // namespace waymark::formats
