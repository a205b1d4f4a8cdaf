/// A log in memory: columns of numbers, in place of a file. A host that has arrays (the Python package)
/// puts them into a DriveDescription, and everything behind the readers is as for files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <waymark/core/drive/log_reader.hpp>
#include <waymark/core/drive/stamp.hpp>

namespace waymark::drive {

/// Columns by quantity, all as long as `stamps`. Units are those of the quantity (formats/logs/README.md):
/// m, m/s, rad and rad/s; degrees for latitude and longitude. NaN is a missing number.
/// - odometry: speed, yaw_rate; or the channels of odometry in parts
/// - gnss: latitude, longitude; sigma, or one of the accuracies of a table; height, speed,
///   speed_accuracy, course, course_accuracy (clockwise from north)
/// - truth: latitude, longitude; height, heading (counter-clockwise from east)
/// - sensor: the columns of the sensor
struct MemoryLog {
  std::vector<Stamp> stamps;  ///< as a log has them: the request's time.week and time.offset are added
  std::map<std::string, std::vector<double>> columns;
};

/// Returns the samples of a log in memory, as a reader would.
/// @param name of the log, for messages
/// @throws InputError "gnss: there is no column 'latitude'; it has: lat, lon" and the like, and if nothing
/// is usable
[[nodiscard]] LogData read_memory_log(const MemoryLog& log, const std::string& name,
                                      const LogRequest& request);

/// Returns the fingerprint of a log in memory, "fnv1a64:" and 16 digits: of names, stamps and numbers.
[[nodiscard]] std::string fingerprint(const MemoryLog& log);

}  // namespace waymark::drive
