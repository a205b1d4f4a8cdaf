/// What an offset between two clocks usually is.
#pragma once

#include <string>

namespace waymark::drive {

struct ClockOffset;

/// Returns what an offset between clocks usually is: "18 leap seconds (GPS time against UTC)", "2 h of a time
/// zone", "a GPS week", "1024 GPS weeks (a rollover of the week number)", "the GPS epoch against the Unix
/// epoch", and two of these together. Empty: nothing that is known.
/// @param tolerance_s how far off it may be
[[nodiscard]] std::string name_of_offset(double seconds, double tolerance_s);

/// Returns ", " and the name of an estimated offset, for messages. Empty: it has none.
[[nodiscard]] std::string offset_in_words(const ClockOffset& offset);

}  // namespace waymark::drive
