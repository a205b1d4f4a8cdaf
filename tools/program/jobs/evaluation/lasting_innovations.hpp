/// Innovations of withheld fixes whose errors last. Pose and error of a fix are not independent then: what
/// is wrong with the fixes around it is wrong with both, and only the joint covariance says how much of
/// it cancels.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <waymark/core/drive/modeling.hpp>
#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/tools/evaluation/numbers/innovation.hpp>

namespace waymark::program {

struct LastingInnovations {
  evaluation::InnovationStatistics statistics;
  double expected_rmse_m = 0;  ///< root mean of the traces of the covariances
};

/// Returns the statistics of r^T S^-1 r at withheld fixes: r is the fix minus the antenna and the error that
/// the modeling expects of it, S = J C J^T + Q with the joint marginal covariance C of the pose and the
/// states of that error, and its rest Q. The uncertainty of an estimated time offset is neglected. At most a
/// hundred fixes are taken, evenly: each takes a solve for every coordinate.
/// @param document at its minimum @param modelings that built its graph, one for each absolute source
/// @returns empty if no modeling expects errors that last, or if no fix is withheld
/// @throws InputError as Marginals
[[nodiscard]] std::optional<LastingInnovations> lasting_innovations(
    const formats::GraphDocument& document,
    const std::vector<std::shared_ptr<const GnssModeling>>& modelings);

}  // namespace waymark::program
