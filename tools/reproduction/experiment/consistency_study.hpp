/// How honest covariances are, pooled over many simulated drives.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <waymark/tools/reproduction/experiment/drive_result.hpp>
#include <waymark/tools/reproduction/tables/reproduction_report.hpp>

namespace waymark::reproduction {

/// A drive to be simulated.
struct Draw {
  std::string preset;
  std::uint64_t seed = 0;
};

/// The first seed of the study; the others follow it, none is left out.
inline constexpr std::uint64_t kFirstStudySeed = 1000;
/// highway, urban, rural, mixed in turn: every drive has errors, and a road, of its own.
[[nodiscard]] std::vector<Draw> consistency_draws(int count);

/// The default model, and white noise with the paper's gate (ours_g1).
[[nodiscard]] std::vector<Setting> consistency_settings();

/// A mean over independent drives.
struct PooledMean {
  double mean = evaluation::kUndefined;
  double standard_error = evaluation::kUndefined;  ///< deviation / sqrt(drives); undefined below two
};
[[nodiscard]] PooledMean pooled_mean(const std::vector<double>& of_drives);

/// Pooled figures by preset and over all, and a line for each drive. @param drives with their `group`
[[nodiscard]] ReproductionReport consistency_report(const std::vector<DriveResult>& drives,
                                                    const std::string& introduction);

}  // namespace waymark::reproduction
