/// Positions from the pseudoranges of single epochs, robustly: a start for drives without fixes.
#pragma once

#include <optional>

#include <waymark/core/drive/place_from_ranges.hpp>
#include <waymark/plugins/gnss_raw/detail/epochs.hpp>

namespace waymark::plugins::gnss_raw {

/// Solves an epoch with at least five pseudoranges (place_from_ranges). Differences of the systems are
/// left out of account.
/// @param turned whether the satellites are in the axes of the moment of reception already
/// @returns nothing if there is no solution near the surface of the Earth
[[nodiscard]] std::optional<PlaceFromRanges> single_point(const Epoch& epoch, const Eigen::Vector3d& guess,
                                                          bool turned);

}  // namespace waymark::plugins::gnss_raw
