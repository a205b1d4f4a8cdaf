#include <waymark/tools/evaluation/withheld.hpp>

#include <fmt/format.h>

#include <waymark/core/error.hpp>
#include <waymark/types_se2/se2.hpp>

namespace waymark {
namespace {

bool ends_run(std::span<const Fix> fixes, std::size_t i) {
  return fixes[i].status == FixStatus::withheld &&
         (i + 1 == fixes.size() || fixes[i + 1].status != FixStatus::withheld);
}

}  // namespace

std::size_t withheld_runs(std::span<const Fix> fixes) {
  std::size_t runs = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) runs += ends_run(fixes, i) ? 1 : 0;
  return runs;
}

WithheldMetrics withheld_metrics(const Prediction& prediction, std::span<const Fix> fixes,
                                 const Eigen::Vector2d& antenna_m) {
  const auto& [label, poses, covariances] = prediction;
  if (poses.size() != fixes.size() || (!covariances.empty() && covariances.size() != fixes.size()))
    throw UsageError(fmt::format("withheld fixes: '{}' has {} poses and {} covariances for {} fixes", label,
                                 poses.size(), covariances.size(), fixes.size()));
  std::vector<Eigen::Vector2d> all;
  std::vector<Eigen::Vector2d> last;
  std::vector<double> nu;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].status != FixStatus::withheld || !poses[i]) continue;
    const Eigen::Vector3d& pose = *poses[i];
    const Eigen::Vector2d offset = pose.head<2>() + rotate(pose[2], antenna_m) - fixes[i].position;
    all.push_back(offset);
    if (ends_run(fixes, i)) last.push_back(offset);
    if (covariances.empty() || !covariances[i]) continue;
    nu.push_back(normalised_innovation_squared(
        offset, residual_covariance(ResidualKind::prediction, fixes[i].covariance, &*covariances[i])));
  }
  return {.label = label,
          .at_fixes = position_metrics(all),
          .at_ends = position_metrics(last),
          .innovation = innovation_statistics(ResidualKind::prediction, nu)};
}

}  // namespace waymark
