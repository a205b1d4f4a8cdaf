/// How the stamps of a table are to be read.
#pragma once

#include <waymark/tools/inspection/inspection.hpp>

namespace waymark::inspection {

/// Judged by the name of the time column and its numbers.
/// @param time  null where the table has none
[[nodiscard]] LogClock clock_of_column(const ColumnSummary* time, Stamp now);

/// The instant on another scale; stamps near the ends of int64, which only damaged logs have, stay within it.
[[nodiscard]] Stamp on_scale(Stamp stamp, TimeScale from, TimeScale to);

/// Seconds of the GPS week and the week's number of a dated instant.
struct WeekSecond {
  int week = 0;
  double second = 0;
};
[[nodiscard]] WeekSecond week_second(Stamp stamp, const LogClock& clock);

}  // namespace waymark::inspection
