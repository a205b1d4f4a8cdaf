/// Places of a log where its stamps do not go on: a gap, or a clock that was set.
#pragma once

#include <span>
#include <vector>

#include <waymark/core/drive/stamp.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>

namespace waymark::drive {

/// Finds them: 0.3 s or more, and more than five usual intervals. Where there are more than ten it is a habit of the
/// logger, and none is returned.
/// @param stamps in the order of the log
[[nodiscard]] std::vector<StampStep> find_stamp_steps(std::span<const Stamp> stamps);

}  // namespace waymark::drive
