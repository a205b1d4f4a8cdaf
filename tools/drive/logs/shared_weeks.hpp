/// The weeks of logs whose times are those of the GPS week.
#pragma once

#include <span>

#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// A log and how it was read.
struct ReadLog {
  DriveLogs::Log* log = nullptr;
  const LogConfig* config = nullptr;
};

/// Puts the logs of one source on one count of weeks. A reader counts from the week of the first row, so a
/// log that begins after the end of a week seems to be almost a week before one that begins in front of it:
/// where it begins more than half a week before another one, and ends before that begins, a week is added to
/// its times, and a note tells. Only logs that state the same week, or none, are compared, and dates are left
/// alone.
void share_weeks(std::span<const ReadLog> logs);

}  // namespace waymark::drive
