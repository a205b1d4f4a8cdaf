/// Finds out how the stamps of a table are read.
#pragma once

#include <waymark/tools/inspection/inspection.hpp>

namespace waymark::inspection {

/// Judges by the name of the time column and by its numbers.
/// @param time null if the table has none
/// @param date null if it has no column of dates
[[nodiscard]] LogClock clock_of_column(const ColumnSummary* time, const ColumnSummary* date, Stamp now);

/// Converts an instant to another scale. Stamps near the ends of int64, which only damaged logs
/// have, stay in range.
[[nodiscard]] Stamp on_scale(Stamp stamp, TimeScale from, TimeScale to);

/// The seconds of the GPS week and the number of the week for a dated instant.
struct WeekSecond {
  int week = 0;
  double second = 0;
};
[[nodiscard]] WeekSecond week_second(Stamp stamp, const LogClock& clock);

}  // namespace waymark::inspection
