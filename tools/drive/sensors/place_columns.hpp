/// Places among the readings of a sensor: columns of sense x, y and height (SensorColumn).
#pragma once

#include <optional>

#include <waymark/core/drive/drive_context.hpp>
#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Checks that the coordinates of each place have units that go together: m (in the frame), lon and lat,
/// easting and northing (of the zone of the frame), or ecef_x, ecef_y and ecef_z. The n-th columns of
/// sense x, y and height are one place.
/// @param request with the columns of the sensor (`readings`) and how the log gives them (`columns`)
/// @throws InputError for units that do not, or ECEF without a height
void check_place_columns(const LogRequest& request);

/// Converts the places into the frame. NaN stays: no place in this row.
/// @param geodesy null for a frame without a known place; all units are then m
/// @throws InputError for an impossible place, or one that needs a known frame
void place_in_frame(const LogRequest& request, const Geodesy* geodesy, SensorTable& table);

/// Returns the first place among readings as they are in the log, if its columns are geodetic or ECEF.
[[nodiscard]] std::optional<GeodeticPoint> first_geodetic_place(const LogRequest& request,
                                                                const SensorTable& readings);

}  // namespace waymark::drive
