/// The state of a run as a file: pose, covariance, calibration. It is written aside and renamed, so it is
/// whole or the former one, whatever ends the process.
#pragma once

#include <string>

#include <waymark/tools/live/estimator/estimator.hpp>

namespace waymark::live {

/// @throws OutputError
void write_state_file(const std::string& path, const WarmStart& state);
/// @throws InputError for a file that cannot be read or is no state
[[nodiscard]] WarmStart read_state_file(const std::string& path);

}  // namespace waymark::live
