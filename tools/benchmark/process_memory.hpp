/// The memory of this process as Linux counts it (/proc/self). On other systems, or if /proc is not
/// readable, there is no result.
#pragma once

#include <optional>

namespace waymark::benchmark {

/// Returns the resident set now, in 1e6 bytes.
[[nodiscard]] std::optional<double> resident_megabytes();

/// Returns unused memory to the system and restarts the peak.
/// @return the resident set after that; nothing if the peak cannot be restarted
[[nodiscard]] std::optional<double> restart_peak_memory();

/// Returns the largest resident set since restart_peak_memory, in 1e6 bytes.
[[nodiscard]] std::optional<double> peak_megabytes();

}  // namespace waymark::benchmark
