#include <waymark/tools/drive/sensors/place_columns.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>

namespace waymark::drive {
namespace {

constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

/// The columns of one place; kNoColumn: the sensor has no such column.
struct PlaceColumns {
  std::size_t x = kNoColumn;
  std::size_t y = kNoColumn;
  std::size_t height = kNoColumn;
};

std::vector<PlaceColumns> places_in(const std::vector<SensorColumn>& columns) {
  std::vector<PlaceColumns> places;
  const auto put = [&](std::size_t PlaceColumns::*coordinate, std::size_t column) {
    for (PlaceColumns& place : places)
      if (place.*coordinate == kNoColumn) return void(place.*coordinate = column);
    places.emplace_back().*coordinate = column;
  };
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].unit != "m") continue;
    if (columns[c].sense == "x") put(&PlaceColumns::x, c);
    if (columns[c].sense == "y") put(&PlaceColumns::y, c);
    if (columns[c].sense == "height") put(&PlaceColumns::height, c);
  }
  return places;
}

std::string unit_of(const LogRequest& request, std::size_t column) {
  if (column == kNoColumn) return "";
  const auto stated = request.columns.find(request.readings[column].name);
  return stated == request.columns.end() || stated->second.unit.empty() ? "m" : stated->second.unit;
}

enum class PlaceKind { frame, grid, geodetic, ecef };

PlaceKind kind_of(const LogRequest& request, const PlaceColumns& place) {
  const std::string x = unit_of(request, place.x);
  const std::string y = unit_of(request, place.y);
  if (x == "lon" && y == "lat") return PlaceKind::geodetic;
  if (x == "easting" && y == "northing") return PlaceKind::grid;
  if (x == "ecef_x" && y == "ecef_y") return PlaceKind::ecef;
  return PlaceKind::frame;
}

const std::string& name_of(const LogRequest& request, std::size_t column) {
  return request.readings[column].name;
}

void check_place(const LogRequest& request, const PlaceColumns& place) {
  if (place.x == kNoColumn || place.y == kNoColumn)
    throw UsageError("a place of this sensor has no x or no y (SensorColumn::sense)");
  const std::string x = unit_of(request, place.x);
  const std::string y = unit_of(request, place.y);
  const PlaceKind kind = kind_of(request, place);
  const auto is_length = [](const std::string& unit) { return unit == "m" || unit == "cm" || unit == "mm"; };
  if (kind == PlaceKind::frame && (!is_length(x) || !is_length(y)))
    throw InputError(
        fmt::format("columns {} ({}) and {} ({}) are no place; state lon and lat, easting and "
                    "northing, ecef_x and ecef_y, or m for both",
                    name_of(request, place.x), x, name_of(request, place.y), y));
  if (kind == PlaceKind::ecef && place.height == kNoColumn)
    throw InputError(fmt::format("column {}: ECEF needs three coordinates, and this sensor has no height",
                                 name_of(request, place.x)));
  if (place.height == kNoColumn) return;
  const bool ecef_height = unit_of(request, place.height) == "ecef_z";
  if (ecef_height != (kind == PlaceKind::ecef))
    throw InputError(
        fmt::format("column {}: ecef_x, ecef_y and ecef_z go together", name_of(request, place.height)));
}

void convert_place(PlaceKind kind, const Geodesy& geodesy, double& x, double& y, double* height) {
  if (kind == PlaceKind::grid) {
    x -= geodesy.frame().origin_easting_m;
    y -= geodesy.frame().origin_northing_m;
    return;
  }
  Eigen::Vector2d position;
  if (kind == PlaceKind::geodetic) {
    position = geodesy.to_grid({.latitude_deg = y, .longitude_deg = x}).position;
  } else {
    const PointWithHeight point = geodesy.from_ecef({x, y, *height});
    position = point.position;
    *height = point.height_m;
  }
  x = position.x();
  y = position.y();
}

}  // namespace

void check_place_columns(const LogRequest& request) {
  for (const PlaceColumns& place : places_in(request.readings)) check_place(request, place);
}

void place_in_frame(const LogRequest& request, const Geodesy* geodesy, SensorTable& table) {
  for (const PlaceColumns& place : places_in(request.readings)) {
    const PlaceKind kind = kind_of(request, place);
    if (kind == PlaceKind::frame) continue;
    if (geodesy == nullptr)
      throw InputError(fmt::format("column {}: the frame of the drive has no known place; state 'frame'",
                                   name_of(request, place.x)));
    for (std::size_t row = 0; row < table.size(); ++row) {
      double* values = table.values.data() + row * table.columns;
      double* height = place.height == kNoColumn ? nullptr : values + place.height;
      const bool given = !std::isnan(values[place.x]) && !std::isnan(values[place.y]) &&
                         (kind != PlaceKind::ecef || !std::isnan(*height));
      if (given) convert_place(kind, *geodesy, values[place.x], values[place.y], height);
    }
  }
}

std::optional<GeodeticPoint> first_geodetic_place(const LogRequest& request, const SensorTable& readings) {
  for (const PlaceColumns& place : places_in(request.readings)) {
    const PlaceKind kind = kind_of(request, place);
    if (kind != PlaceKind::geodetic && kind != PlaceKind::ecef) continue;
    for (std::size_t row = 0; row < readings.size(); ++row) {
      const double x = readings.at(row, place.x);
      const double y = readings.at(row, place.y);
      if (std::isnan(x) || std::isnan(y)) continue;
      if (kind == PlaceKind::geodetic) return GeodeticPoint{.latitude_deg = y, .longitude_deg = x};
      return geodetic_from_ecef({x, y, readings.at(row, place.height)});
    }
  }
  return std::nullopt;
}

}  // namespace waymark::drive
