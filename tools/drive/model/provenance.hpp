/// The provenance of a drive's document: inputs, settings, assumptions and warnings.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <waymark/tools/drive/model/fuse.hpp>

namespace waymark::drive {

/// Key of a drive whose modeling gives fixes other errors than independent ones of the covariance they claim.
inline constexpr std::string_view kFixErrors = "fix_errors";

/// Returns key and text in the order of writing: drive, environment, input (name and fingerprint of
/// each file), modeling, modeling_option, loss, noise, calibration, fix_errors, sensor, plugin, gate, start,
/// assumed, warning.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> provenance_of(const PreparedDrive& drive,
                                                                             const ModeledDrive& modeled,
                                                                             const TypeRegistry& registry);

/// Returns "12 corrupt records were left out"; empty if there were none.
[[nodiscard]] std::string corrupt_warning(const PrepareReport& report);

}  // namespace waymark::drive
