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

}  // namespace waymark::drive
