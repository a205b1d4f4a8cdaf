/// A clock that steps back: rows of a log that are stamped in a time that the log has already told of.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// A step of the stamps back into a time that has readings.
struct StepBack {
  std::size_t row = 0;                 ///< the first one behind the step, in the order of the log
  double back_s = 0;                   ///< how far its stamp lies before that of the row above it
  std::vector<std::size_t> in_past{};  ///< rows behind it that lie between readings of that time
  double length_s = 0;                 ///< of the time of those rows
};

/// Returns the usual interval between stamps that rise; 0 if there is none. @param stamps in the order of the log
[[nodiscard]] double usual_interval_s(std::span<const Stamp> stamps);

/// Finds them: a stamp falls by more than five usual intervals, and 20 rows behind it or more lie between readings
/// that stand above it and are at most four usual intervals apart. So parts of a log in another order are none, nor
/// are rows that only come late. Rows that are there already, of the same stamps and numbers, are none either. Where
/// more than ten are found it is a habit of the logger, such as threads that write their buffers in turn, and none is
/// returned.
/// @param rows in the order of the log
[[nodiscard]] std::vector<StepBack> find_steps_back(const SensorTable& rows);

/// Returns the warning for one of them, whose rows are left out. @param rows of the log
[[nodiscard]] std::string warning_of(const StepBack& step, const std::string& file, std::size_t rows);

}  // namespace waymark::drive
