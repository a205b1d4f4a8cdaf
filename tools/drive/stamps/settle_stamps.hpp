/// What a log shows of its own stamps, before it is sorted.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/logs/prepare.hpp>

namespace waymark::drive {

/// Leaves out what is stamped in the past (steps_back.hpp) and spreads bursts (bursts.hpp). Each is told by a warning.
/// @param samples those from `first` on are of one log, in its order @param file for messages
void settle_stamps(std::vector<OdometrySample>& samples, std::size_t first, const std::string& file,
                   PrepareReport& report);

/// The same for a log of channels. Each channel has a past of its own: threads of a logger may write one after the
/// other. A step of their clock is told once, and rows that hold nothing else are left out. Bursts are those
/// of rows that hold the same channels.
/// @param readings NaN: not in this row
void settle_stamps(SensorTable& readings, const std::string& file, PrepareReport& report);

/// Spreads fixes of one log that come in bursts, and tells it.
void settle_bursts(std::span<GeodeticFix> fixes, const std::string& file, PrepareReport& report);

}  // namespace waymark::drive
