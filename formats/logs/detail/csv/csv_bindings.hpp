/// The columns of a table, sorted by their use; private to the CSV reader.
#pragma once

#include <waymark/formats/logs/detail/csv/csv_columns.hpp>

namespace waymark::formats {

/// The columns of the stream, looked up once; null if the table has no such column.
struct Bindings {
  explicit Bindings(const CsvColumns& columns)
      : time(columns.find("time")),
        date(columns.find("date")),
        speed(columns.find("speed")),
        yaw_rate(columns.find("yaw_rate")),
        latitude(columns.find("latitude")),
        longitude(columns.find("longitude")),
        latitude_hemisphere(columns.find("latitude_hemisphere")),
        longitude_hemisphere(columns.find("longitude_hemisphere")),
        easting(columns.find("easting")),
        northing(columns.find("northing")),
        ecef_x(columns.find("ecef_x")),
        ecef_y(columns.find("ecef_y")),
        ecef_z(columns.find("ecef_z")),
        time_fraction(columns.find("time_fraction")),
        height(columns.find("height")),
        heading(columns.find("heading")),
        course(columns.find("course")),
        course_accuracy(columns.find("course_accuracy")),
        speed_accuracy(columns.find("speed_accuracy")),
        gnss_time(columns.find("gnss_time")),
        valid(columns.find("valid")),
        quality(columns.find("quality")),
        hdop(columns.find("hdop")),
        satellites(columns.find("satellites")),
        correction_age(columns.find("correction_age")) {}

  const BoundColumn *time, *date, *speed, *yaw_rate, *latitude, *longitude;
  const BoundColumn *latitude_hemisphere, *longitude_hemisphere, *easting, *northing;
  const BoundColumn *ecef_x, *ecef_y, *ecef_z, *time_fraction;
  const BoundColumn *height, *heading;
  const BoundColumn *course, *course_accuracy, *speed_accuracy, *gnss_time, *valid;
  const BoundColumn *quality, *hdop, *satellites, *correction_age;
};

}  // namespace waymark::formats
