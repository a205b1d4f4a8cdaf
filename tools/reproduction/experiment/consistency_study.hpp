/// Tests the consistency of covariances, pooled over many simulated drives.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/reproduction/tables/reproduction_report.hpp>

namespace waymark::reproduction {

/// A drive that is to be simulated.
struct Draw {
  std::string preset;
  std::uint64_t seed = 0;
};

/// The first seed of the study. The others follow it; none is left out.
inline constexpr std::uint64_t kFirstStudySeed = 1000;
/// Returns the presets in turn. Every drive has its own errors and its own road.
/// @param presets names, at least one
[[nodiscard]] std::vector<Draw> consistency_draws(std::span<const std::string> presets, int count);

/// Returns the default model, and white noise with the gate of the paper (ours_g1).
[[nodiscard]] std::vector<Setting> consistency_settings();

/// A mean over independent drives.
struct PooledMean {
  double mean = evaluation::kUndefined;
  /// deviation / sqrt(drives); undefined for fewer than two
  double standard_error = evaluation::kUndefined;
};
[[nodiscard]] PooledMean pooled_mean(const std::vector<double>& of_drives);

/// Returns pooled figures by preset and over all, and a line for each drive. @param drives with
/// their `group`
[[nodiscard]] ReproductionReport consistency_report(const std::vector<DriveResult>& drives,
                                                    const std::string& introduction);

}  // namespace waymark::reproduction
