/// Recordings of the OxTS inertial and GNSS unit in KITTI's raw data.
#pragma once

#include <waymark/core/drive/log_reader.hpp>

namespace waymark::formats {

/// Reader "kitti_oxts": streams odometry, gnss and truth of `oxts/data/0000000000.txt`, ..., 30 numbers a
/// record (KITTI's oxts/dataformat.txt). The log is the text of these files one after the other in the order
/// of their names: whoever opens the folder joins them.
///
/// **Time** is in the companion file `timestamps`: `oxts/timestamps.txt`, one line for each record, to the
/// nanosecond. Its zone is not documented; it is read as UTC of a host's clock and noted. All of KITTI's
/// streams share it, so that only the comparison with other logs is concerned.
///
/// **Odometry** is vf, along the vehicle and parallel to the ground, and wu, about the upward axis of the
/// level frame: what a vehicle does in the plane. (wz, about the vehicle's own axis, is smaller on a slope,
/// and mixes with pitch and roll.) The unit is no independent wheel odometry: it knows of the GNSS.
///
/// **gnss**: latitude, longitude, altitude, speed and course from vn, ve. pos_accuracy ("north/east in m" in
/// dataformat.txt, no more is said) is read as 1 sigma of each axis, which `request.accuracy` overrides;
/// vel_accuracy as 1 sigma of the velocity's axes. The positions are smoothed by the unit: errors of
/// neighbours are far from independent.
///
/// **truth**: position and yaw (0 = east, counter-clockwise).
///
/// navstat 0 to 2 (no solution, raw inertial data, initialising) counts as without a fix.
///
/// @throws InputError for a missing, other or garbled companion, for another number of time stamps than of
/// records (when the log ends), for a column map and the sensor stream.
class KittiOxtsReader final : public LogReader {
 public:
  [[nodiscard]] std::unique_ptr<LogDecoder> open(const std::string& path,
                                                 const LogRequest& request) const override;
  [[nodiscard]] Recognition recognise(std::string_view head) const override;
};

}  // namespace waymark::formats
