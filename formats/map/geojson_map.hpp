/// Reads roads and buildings from GeoJSON (RFC 7946), to be drawn beneath a trajectory. It is made
/// for extracts of OpenStreetMap (`osmium export`, `ogr2ogr`, Overpass), whose tags are properties.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace waymark::formats {

enum class WayKind { road, building };

/// A line of a road, or a ring about a building.
struct MapWay {
  WayKind kind = WayKind::road;
  std::vector<Eigen::Vector2d> points{};  ///< longitude, latitude, degrees, WGS84
};

/// Reads a FeatureCollection, a Feature or a geometry, way by way: the text aside, memory holds one feature.
/// Lines are roads and rings are buildings, unless the properties say that they are something else
/// (landuse, waterway, railway, boundary, ...); these and points are left out. "building": "no" is
/// taken at its word.
/// @param name of the file, for errors
/// @param take gets each way in the order of the file
/// @return the number of ways
/// @throws InputError "roads.geojson:3:17: ...": no JSON, nested more than 100 deep, coordinates that
/// are no longitude and latitude, or neither a road nor a building in the file
std::size_t read_geojson_map(std::string_view text, const std::string& name,
                             const std::function<void(MapWay&&)>& take);

}  // namespace waymark::formats
