#include <waymark/tools/drive/trials/trial_drive.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/tools/drive/model/build.hpp>

namespace waymark::drive {

TrialDrive::TrialDrive(CoarseDrive coarse, const FusionSettings& settings, const TypeRegistry& registry,
                       const std::function<void()>& between)
    : coarse_(std::move(coarse)), settings_(settings), registry_(registry), between_(between) {
  (void)cost_with([](PlacedDrive&) {});
  keep_poses(graph_, coarse_);
}

double TrialDrive::cost_with(const std::function<void(PlacedDrive&)>& change) {
  PlacedDrive changed = coarse_.drive;
  change(changed);
  Graph graph = build_graph(changed, coarse_.sensors, settings_, registry_).graph;
  if (graph_.vertex_count() > 0) graph.set_values(graph_.values());
  graph_ = std::move(graph);
  BlockCholesky cholesky;
  const auto algorithm = registry_.make_algorithm("dogleg");
  const Summary summary = optimize(graph_, *algorithm, cholesky, {});
  if (between_) between_();
  return summary.converged() ? 0.5 * summary.final_chi2 : std::numeric_limits<double>::quiet_NaN();
}

Eigen::Vector2d TrialDrive::velocity_at(std::size_t fix) const {
  const Timeline& timeline = coarse_.drive.timeline;
  const std::size_t node = timeline.fix_node[fix];
  const double speed_mps = timeline.intervals[std::min(node, timeline.intervals.size() - 1)].speed_mps;
  const double heading_rad = coarse_.drive.start.poses[node][2];
  return speed_mps * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
}

Eigen::Vector2d TrialDrive::left_of_fix(std::size_t fix) const {
  const Fix& of = coarse_.drive.fixes[fix];
  const auto pose = graph_.value(static_cast<VertexIndex>(coarse_.drive.timeline.fix_node[fix]));
  const Eigen::Vector2d antenna = Eigen::Rotation2Dd(pose[2]) * of.antenna_seen_m();
  const double late_s = coarse_.drive.time_offsets_s[static_cast<std::size_t>(of.source)];
  return of.position - Eigen::Vector2d(pose[0], pose[1]) - antenna + late_s * velocity_at(fix);
}

LeftOfFixes TrialDrive::left_of(int source) const {
  LeftOfFixes left;
  const std::vector<Fix>& fixes = coarse_.drive.fixes;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    if (fixes[i].source != source || fixes[i].status != FixStatus::accepted) continue;
    left.stamps.push_back(fixes[i].stamp);
    left.off_m.push_back(left_of_fix(i));
  }
  return left;
}

double TrialDrive::spread(double cost) const {
  return std::max(1.0, std::sqrt(cost / static_cast<double>(coarse_.drive.fixes.size())));
}

std::optional<LeastCost> TrialDrive::least_near(double middle, double apart,
                                                const std::function<double(double)>& cost_at) const {
  const double before = cost_at(middle - apart);
  const double here = cost_at(middle);
  const double after = cost_at(middle + apart);
  const double curvature = (before - 2 * here + after) / (apart * apart);
  if (!(curvature > 0)) return std::nullopt;
  return LeastCost{middle + (before - after) / (2 * apart * curvature), spread(here) / std::sqrt(curvature)};
}

}  // namespace waymark::drive
