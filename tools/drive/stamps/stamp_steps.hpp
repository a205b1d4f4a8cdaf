/// Places of a log where its stamps do not go on: a gap, or a clock that was set.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <waymark/core/drive/stamp.hpp>

namespace waymark::drive {

/// The stamps of a log rise or fall by more than they usually do.
struct StampStep {
  std::size_t row = 0;  ///< the first one behind it, in the order of the log
  Stamp before;         ///< of the row above it
  double by_s = 0;      ///< the stamp of the row less what it would be after a usual interval
};

/// Finds them: 0.3 s or more, and more than five usual intervals. Where there are more than ten it is a habit of the
/// logger, and none is returned.
/// @param stamps in the order of the log
[[nodiscard]] std::vector<StampStep> find_stamp_steps(std::span<const Stamp> stamps);

}  // namespace waymark::drive
