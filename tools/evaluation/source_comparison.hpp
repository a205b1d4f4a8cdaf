/// The sources of a drive side by side: what each says, and what the result would be without it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <waymark/tools/evaluation/numbers/metrics.hpp>
#include <waymark/tools/text/table.hpp>

namespace waymark::evaluation {

/// One source. Undefined numbers are NaN: those of fixes for a relative source, those against truth
/// without truth, those without the source if the drive cannot do without it.
struct SourceReport {
  std::string name;
  std::string kind;                            ///< "odometry", "gnss", or the name of a sensor model
  std::size_t readings = 0;                    ///< samples, fixes, rows
  std::size_t accepted = 0;                    ///< fixes in the graph
  double availability = kUndefined;            ///< share of the time with readings, 0 to 1
  double raw_rmse_m = kUndefined;              ///< its fixes against truth, at the body point
  double residual_rms_m = kUndefined;          ///< its accepted fixes minus the fused antenna
  double without_rmse_m = kUndefined;          ///< fused without it, against truth at all epochs
  double without_residual_rms_m = kUndefined;  ///< its fixes minus the antenna that the others fuse
  double without_sigma_m = kUndefined;         ///< stated for a position without it, median of both axes' rms
  /// Share of the information about a position that only this source has: 1 - tr(P W^-1) / 2, the mean over
  /// all fixes. P is the covariance with all sources, W that without this one. 0: nothing is lost.
  double share = kUndefined;
};

/// All sources of a drive, and the result with all of them.
struct SourceComparison {
  std::vector<SourceReport> sources;  ///< empty: the drive has one of each kind
  double rmse_m = kUndefined;         ///< fused, against truth at all epochs
  double sigma_m = kUndefined;        ///< stated for a position, median of both axes' rms
};

/// Returns a table with a row for each source, and one for all of them.
/// @param label of the result, before the names; may be empty
[[nodiscard]] text::Table source_table(const SourceComparison& comparison, const std::string& label = "");

}  // namespace waymark::evaluation
