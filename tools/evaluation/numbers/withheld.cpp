#include <waymark/tools/evaluation/numbers/withheld.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <waymark/core/base/error.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark::evaluation {

std::vector<std::size_t> outage_ends(std::span<const Fix> fixes) {
  std::vector<std::size_t> ends;
  std::size_t begin = 0;  // of the present run
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].status != FixStatus::withheld) {
      begin = i + 1;
      continue;
    }
    const bool last = i + 1 == fixes.size() || fixes[i + 1].status != FixStatus::withheld;
    if (last && fixes[begin].stamp < fixes[i].stamp) ends.push_back(i);
  }
  return ends;
}

WithheldMetrics withheld_metrics(const Prediction& prediction, std::span<const Fix> fixes) {
  const auto& [label, poses, covariances] = prediction;
  if (poses.size() != fixes.size() || (!covariances.empty() && covariances.size() != fixes.size()))
    throw UsageError(fmt::format("withheld fixes: '{}' has {} poses and {} covariances for {} fixes", label,
                                 poses.size(), covariances.size(), fixes.size()));
  const std::vector<std::size_t> ends = outage_ends(fixes);
  std::vector<Eigen::Vector2d> all;
  std::vector<Eigen::Vector2d> last;
  std::vector<double> nu;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].status != FixStatus::withheld || !poses[i]) continue;
    const Eigen::Vector3d& pose = *poses[i];
    const Eigen::Vector2d offset = pose.head<2>() + rotate(pose[2], fixes[i].antenna_seen_m()) - fixes[i].position;
    all.push_back(offset);
    if (std::binary_search(ends.begin(), ends.end(), i)) last.push_back(offset);
    if (covariances.empty() || !covariances[i]) continue;
    nu.push_back(normalised_innovation_squared(
        offset, residual_covariance(ResidualKind::prediction, fixes[i].covariance, &*covariances[i])));
  }
  return {.label = label,
          .at_fixes = position_metrics(all),
          .at_ends = position_metrics(last),
          .innovation = innovation_statistics(ResidualKind::prediction, nu)};
}

}  // namespace waymark::evaluation
