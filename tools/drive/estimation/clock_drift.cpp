#include <waymark/tools/drive/estimation/clock_drift.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <waymark/core/linear/block_cholesky.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/tools/drive/estimation/coarse.hpp>
#include <waymark/tools/drive/model/build.hpp>

namespace waymark::drive {
namespace {

constexpr double kLargest = 3e-4;

/// A coarse drive whose fixes are moved along the way, as a drift would have moved them.
class DriftedDrive {
 public:
  DriftedDrive(CoarseDrive coarse, const FusionSettings& settings, const TypeRegistry& registry,
               const std::function<void()>& between)
      : coarse_(std::move(coarse)), settings_(settings), registry_(registry), between_(between) {
    (void)cost_at(0);
    keep_poses(graph_, coarse_);
    const std::vector<Fix>& fixes = coarse_.drive.fixes;
    for (std::size_t i = 0; i < fixes.size(); ++i)
      moved_m_.push_back(seconds_between(fixes.front().stamp, fixes[i].stamp) * velocity_at(i));
  }

  /// Returns the least half chi2 over the states; NaN if it was not reached.
  [[nodiscard]] double cost_at(double rate) {
    PlacedDrive moved = coarse_.drive;
    for (std::size_t i = 0; i < moved_m_.size(); ++i) moved.fixes[i].position += rate * moved_m_[i];
    Graph graph = build_graph(moved, coarse_.sensors, settings_, registry_).graph;
    if (!moved_m_.empty()) graph.set_values(graph_.values());
    graph_ = std::move(graph);
    BlockCholesky cholesky;
    const auto algorithm = registry_.make_algorithm("dogleg");
    const Summary summary = optimize(graph_, *algorithm, cholesky, {});
    if (between_) between_();
    return summary.converged() ? 0.5 * summary.final_chi2 : std::numeric_limits<double>::quiet_NaN();
  }

  [[nodiscard]] std::size_t fixes() const { return moved_m_.size(); }
  /// Returns by how much a drift of 1 moves the fixes, at their accuracy: the largest.
  [[nodiscard]] double largest_in_accuracies() const {
    double largest = 0;
    for (std::size_t i = 0; i < moved_m_.size(); ++i)
      largest = std::max(largest, moved_m_[i].norm() / coarse_.drive.fixes[i].accuracy_m());
    return largest;
  }

 private:
  [[nodiscard]] Eigen::Vector2d velocity_at(std::size_t fix) const {
    const Timeline& timeline = coarse_.drive.timeline;
    const std::size_t node = timeline.fix_node[fix];
    const double speed_mps = timeline.intervals[std::min(node, timeline.intervals.size() - 1)].speed_mps;
    const double heading_rad = coarse_.drive.start.poses[node][2];
    return speed_mps * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
  }

  CoarseDrive coarse_;
  const FusionSettings& settings_;
  const TypeRegistry& registry_;
  const std::function<void()>& between_;
  Graph graph_;
  std::vector<Eigen::Vector2d> moved_m_;  ///< of each fix, by a drift of 1
};

}  // namespace

std::optional<ClockDrift> find_clock_drift(const PlacedDrive& placed, std::span<const PreparedSensor> sensors,
                                           const FusionSettings& settings, const TypeRegistry& registry,
                                           const std::function<void()>& between) {
  constexpr double kFixPeriod_s = 4;
  constexpr double kNodePeriod_s = 1;
  constexpr double kStep = 2e-5;
  constexpr double kLeast = 5e-6;
  constexpr double kSigmas = 3;
  constexpr double kMasked = 3;  // accuracies: so far off, noise was found instead
  constexpr double kMaskedSigmas = 1.5;
  constexpr double kMatters = 0.1;  // of the accuracy of a fix
  if (placed.fixes.empty()) return std::nullopt;
  DriftedDrive drive(sample_of(coarsen(placed, sensors, kFixPeriod_s, kNodePeriod_s)), settings, registry,
                     between);
  if (kLargest * drive.largest_in_accuracies() < kMatters) return std::nullopt;
  const double before = drive.cost_at(-kStep);
  const double here = drive.cost_at(0);
  const double after = drive.cost_at(kStep);
  const double curvature = (before - 2 * here + after) / (kStep * kStep);
  if (!(curvature > 0)) return std::nullopt;
  // What no state explains makes the cost steeper than it is known.
  const double spread = std::max(1.0, std::sqrt(here / static_cast<double>(drive.fixes())));
  ClockDrift drift{(before - after) / (2 * kStep * curvature), spread / std::sqrt(curvature)};
  const double rate = std::abs(drift.rate);
  const double moved = rate * drive.largest_in_accuracies();
  const double sigmas = moved > kMasked ? kMaskedSigmas : kSigmas;
  drift.is_probable = moved >= kMatters && rate >= kLeast && rate <= kLargest && rate >= sigmas * drift.sigma;
  return drift;
}

PreparedDrive without_drift(PreparedDrive drive, const ClockDrift& drift) {
  if (drive.fixes.empty()) return drive;
  const Stamp agreed = drive.fixes.front().stamp;
  OdometrySample last = drive.odometry.back();
  for (OdometrySample& sample : drive.odometry)
    sample.stamp = sample.stamp.later(drift.rate * seconds_between(agreed, sample.stamp));
  if (drive.odometry.back().stamp < last.stamp) drive.odometry.push_back(std::move(last));
  return drive;
}

}  // namespace waymark::drive
