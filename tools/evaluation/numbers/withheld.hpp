/// Errors at withheld fixes: of the fused poses, and of other ways to get there.
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

/// One way to predict the withheld fixes: poses (x, y [m, frame], heading [rad]) of the body.
struct Prediction {
  std::string label;                                  ///< "dead reckoning", "causal"
  std::vector<std::optional<Eigen::Vector3d>> poses;  ///< one per fix; only those at withheld ones count
  /// Of their positions, m^2, frame axes; one per fix, or empty for none at all.
  std::vector<std::optional<Eigen::Matrix2d>> position_covariances;
};

/// Predicted antenna - withheld fix; the noise of the fixes is in it.
struct WithheldMetrics {
  std::string label;
  PositionMetrics at_fixes;  ///< at every withheld fix
  PositionMetrics at_ends;   ///< at the last withheld fix of each outage
  /// With S = R + P, at the fixes whose prediction has a covariance; count 0 where none has.
  InnovationStatistics innovation;
};

/// The last withheld fix of each outage. An outage is a run of withheld fixes over more than one epoch: every
/// n-th epoch withheld makes none. @param fixes in order of time
[[nodiscard]] std::vector<std::size_t> outage_ends(std::span<const Fix> fixes);

/// @param fixes      in order of time
/// @param antenna_m  GNSS antenna in the body frame
/// @throws UsageError where the prediction is not of these fixes.
[[nodiscard]] WithheldMetrics withheld_metrics(const Prediction& prediction, std::span<const Fix> fixes,
                                               const Eigen::Vector2d& antenna_m);

}  // namespace waymark::evaluation
