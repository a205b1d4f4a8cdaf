/// Readings that are stamped when a packet of them arrives, or by a clock that is cut off.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>

namespace waymark::drive {

/// Stamps of a log that come in bursts.
struct Bursts {
  std::size_t size = 0;      ///< readings of a burst, in the median
  double period_s = 0;       ///< from burst to burst
  double length_s = 0;       ///< from the first reading of a burst to its last one
  bool are_cut_off = false;  ///< stamps of whole seconds or tenths of them: the readings follow their stamp
  std::vector<Stamp>
      spread{};  ///< of each row; empty if the readings of a burst do not differ as those of its period
};

/// Finds them: 20 bursts or more, nine of ten of the same number of readings (three or more, give or take a tenth or
/// one), in a regular period, of which a burst takes at most a quarter of the time that its readings would.
///
/// The readings tell whether they were measured when they are stamped. If they were, the first and the last one of a
/// burst differ by noise, and most changes lie between bursts. If they were measured all the time, changes add up
/// within a burst (1.5 times what neighbours differ by), and those between bursts are no larger than others (twice).
/// Those are spread evenly: over the time to the next stamp if the stamps are cut off, else over the time since the
/// burst before, up to the last stamp of the burst.
/// @param rows in the order of the log
[[nodiscard]] std::optional<Bursts> find_bursts(const SensorTable& rows);

/// Returns the warning for them. @param readings "readings of the odometry"
[[nodiscard]] std::string warning_of(const Bursts& bursts, const std::string& file,
                                     const std::string& readings);

}  // namespace waymark::drive
