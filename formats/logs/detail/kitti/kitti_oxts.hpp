/// Recordings of the OxTS inertial and GNSS unit in the raw data of KITTI.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "kitti_oxts": reads the streams odometry, gnss and truth from `oxts/data/0000000000.txt`,
/// ...; a record has 30 numbers (KITTI's oxts/dataformat.txt). The log is the text of these files,
/// joined in the order of their names. The caller that opens the folder joins them.
///
/// **Time** is in the companion file `timestamps`: `oxts/timestamps.txt`, one line per record,
/// to the nanosecond. Its time zone is not documented; it is read as UTC of the host clock, and
/// a note says so. All streams of KITTI share it, so the zone matters only for a comparison
/// with other logs.
///
/// **Odometry** is vf (along the vehicle, parallel to the ground) and wu (about the upward axis
/// of the level frame): the motion in the plane. wz, about the vehicle's own axis, would be
/// smaller on a slope and mix with pitch and roll. The unit uses GNSS, so this is no independent
/// wheel odometry.
///
/// **gnss** is latitude, longitude, altitude, and speed and course from vn and ve. pos_accuracy is
/// read as 1 sigma of each axis, and `request.accuracy` overrides this; dataformat.txt only says
/// "north/east in m". vel_accuracy is read as 1 sigma of the axes of the velocity. The unit smooths
/// the positions, so the errors of neighbours are far from independent.
///
/// **truth** is position and yaw (0 = east, counter-clockwise).
///
/// navstat 0 to 2 (no solution, raw inertial data, initialising) counts as no fix.
///
/// @throws InputError for a missing, wrong or garbled companion, for different numbers of time
/// stamps and records (at the end of the log), for a column map, and for the sensor stream.
class KittiOxtsReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
