/// Fixes of one log that share their stamps and differ: seconds without their decimals, or two receivers.
#pragma once

#include <span>
#include <string>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// One rule for all readers. It acts if a fifth of the stamps, at least 20, have several positions.
/// Cut-off stamps: the later positions of a stamp lie on the way to the next stamp. They are spread evenly
/// over that time, and a note counts them. Otherwise several receivers write into the log.
/// @param fixes of one log, in its order; sorted if they were spread
/// @param file for messages
/// @throws InputError for two receivers; it names the remedy
void settle_shared_stamps(std::span<GeodeticFix> fixes, const std::string& file, PrepareReport& report);

/// Returns a warning if two receivers seem to write into a log in turn: the intervals of the stamps
/// alternate, or the positions go to and fro from fix to fix (the second differences have correlations
/// below -0.7 and above 0.7 with the next and the one behind it; independent errors have -2/3 and 1/6).
/// Empty otherwise, and below 40 fixes.
/// @param fixes of one log, sorted by stamp
[[nodiscard]] std::string warning_of_turns(std::span<const GeodeticFix> fixes, const std::string& file);

}  // namespace waymark::drive
