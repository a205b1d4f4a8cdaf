/// The road and how it is driven: exact states of the vehicle on the clock of the simulation.
#pragma once

#include <cstdint>
#include <vector>

#include <waymark/tools/simulation/recipe.hpp>

namespace waymark::simulation {

/// The clock of the simulation in ticks per second. Odometry and truth are sampled at ticks.
inline constexpr int kTicksPerSecond = 100;

/// The vehicle at one tick, on the ground: a plane without projection.
struct DrivenState {
  double way_m = 0;  ///< distance since the start
  double speed_mps = 0;
  /// curvature of the road times speed: the vehicle turns only while it moves
  double yaw_rate_radps = 0;
  double heading_rad = 0;  ///< counter-clockwise from grid east, not wrapped
  bool canyon = false;
};

/// Drives `ticks` steps from rest. The speed follows the cruise speed of the leg, the lateral
/// acceleration in bends, and the brake curve sqrt(v^2 + 2 b d) of everything ahead. A bend with
/// angle A and smallest radius R has the curvature sin^2(pi u) / R over the length 2 A R.
/// @param cruise_factor multiplies all cruise speeds
[[nodiscard]] std::vector<DrivenState> drive_roads(const SimulationRecipe& recipe, std::uint64_t seed,
                                                   std::int64_t ticks, double cruise_factor);

/// Drives with the factor that gives recipe.distance_m within 0.2 %, or as near as can be found.
/// The factor is 1 if the recipe has no distance.
[[nodiscard]] std::vector<DrivenState> drive_distance(const SimulationRecipe& recipe, std::uint64_t seed,
                                                      std::int64_t ticks);

}  // namespace waymark::simulation
