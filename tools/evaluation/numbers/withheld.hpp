/// Errors at withheld fixes: of the fused poses, and of other predictions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/evaluation/numbers/innovation.hpp>
#include <waymark/tools/evaluation/numbers/metrics.hpp>

namespace waymark::evaluation {

/// One prediction of the withheld fixes: poses (x, y [m, frame], heading [rad]) of the body.
struct Prediction {
  std::string label;  ///< "dead reckoning", "causal"
  /// one per fix; only those at withheld fixes are used
  std::vector<std::optional<Eigen::Vector3d>> poses;
  /// Covariances of the positions, m^2, frame axes; one per fix, or empty if there are none.
  std::vector<std::optional<Eigen::Matrix2d>> position_covariances;
};

/// Predicted antenna - withheld fix. It contains the noise of the fixes.
struct WithheldMetrics {
  std::string label;
  PositionMetrics at_fixes;  ///< at every withheld fix
  PositionMetrics at_ends;   ///< at the last withheld fix of each outage
  /// With S = R + P, at the fixes whose prediction has a covariance. count is 0 if none has one.
  InnovationStatistics innovation;
};

/// Returns the last withheld fix of each outage. An outage is a run of withheld fixes over several
/// epochs, so withholding every n-th epoch makes none. @param fixes in order of time
[[nodiscard]] std::vector<std::size_t> outage_ends(std::span<const Fix> fixes);

/// @param fixes in order of time
/// @throws UsageError if the prediction does not belong to these fixes
[[nodiscard]] WithheldMetrics withheld_metrics(const Prediction& prediction, std::span<const Fix> fixes);

}  // namespace waymark::evaluation
