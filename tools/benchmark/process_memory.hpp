/// Memory of this process as Linux counts it (/proc/self). Elsewhere, or where /proc forbids it, nothing.
#pragma once

#include <optional>

namespace waymark::benchmark {

/// Resident set now, in 1e6 bytes.
[[nodiscard]] std::optional<double> resident_megabytes();

/// Gives memory that nobody uses back to the system and lets the peak begin anew.
/// @return the resident set then; nothing where the peak cannot be begun anew.
[[nodiscard]] std::optional<double> restart_peak_memory();

/// Largest resident set since restart_peak_memory, in 1e6 bytes.
[[nodiscard]] std::optional<double> peak_megabytes();

}  // namespace waymark::benchmark
