/// A coarse drive that is fused again and again with one thing changed: what makes its fixes most probable?
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/estimation/coarse.hpp>

namespace waymark::drive {

/// Where a cost is least, by the parabola through three costs.
struct LeastCost {
  double at = 0;
  double sigma = 0;  ///< from the curvature, with TrialDrive::spread()
};

/// What poses leave of the fixes of a receiver that are in the graph, in the order of time.
struct LeftOfFixes {
  std::vector<Stamp> stamps;
  std::vector<Eigen::Vector2d> off_m;  ///< fix minus antenna, in the frame
};

/// Refers to what it is made of, which must outlive it.
class TrialDrive {
 public:
  /// Fuses the drive as it is. @param settings with the noise
  /// @param between called after each fusion; what it throws ends the trial. Empty: nothing is called
  TrialDrive(CoarseDrive coarse, const FusionSettings& settings, const TypeRegistry& registry,
             const std::function<void()>& between);

  /// Returns the least half chi2 over the states of a changed drive; NaN if it was not reached. It begins at the states
  /// of the fusion before.
  [[nodiscard]] double cost_with(const std::function<void(PlacedDrive&)>& change);

  /// Returns the drive; its initial guess is the minimum of the drive as it is.
  [[nodiscard]] const PlacedDrive& drive() const { return coarse_.drive; }
  /// Returns the velocity of the vehicle at a fix, m/s, in the frame.
  [[nodiscard]] Eigen::Vector2d velocity_at(std::size_t fix) const;
  /// Returns what the poses of the last fusion leave of a fix: its position less that of the antenna when it was
  /// measured, m, in the frame.
  [[nodiscard]] Eigen::Vector2d left_of_fix(std::size_t fix) const;
  /// Returns that for the fixes of a receiver. @param source Fix::source
  [[nodiscard]] LeftOfFixes left_of(int source) const;
  /// Returns how many times its own noise each fix costs: what no state explains makes a cost steeper than it is known.
  [[nodiscard]] double spread(double cost) const;
  /// Returns the least of a cost near a place; empty where it is not curved upwards.
  /// @param cost_at by cost_with() @param apart from the middle one of the three costs to each of the others
  [[nodiscard]] std::optional<LeastCost> least_near(double middle, double apart,
                                                    const std::function<double(double)>& cost_at) const;

 private:
  CoarseDrive coarse_;
  const FusionSettings& settings_;
  const TypeRegistry& registry_;
  const std::function<void()> between_;
  Graph graph_;
};

}  // namespace waymark::drive
