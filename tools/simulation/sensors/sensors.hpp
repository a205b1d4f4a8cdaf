/// Simulates the readings of the sensors along the way.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/coordinates/projection.hpp>
#include <waymark/tools/simulation/random.hpp>
#include <waymark/tools/simulation/road.hpp>
#include <waymark/tools/simulation/sensors/lasting_errors.hpp>
#include <waymark/tools/simulation/simulation.hpp>
#include <waymark/tools/simulation/streams.hpp>

namespace waymark::simulation {

/// Returns the readings of an odometry and its drawn calibration.
/// @param start stamp of tick 0
[[nodiscard]] SimulatedOdometry sense_odometry(const std::vector<DrivenState>& states, Stamp start,
                                               const OdometryRecipe& recipe, const SourceStreams& streams);

/// The vehicle in the frame, at an instant of a receiver or of the reference.
struct PlacedState {
  Stamp stamp;
  std::size_t tick = 0;                            ///< of the stamp
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< of the body point, frame
  double speed_mps = 0;
  double yaw_rate_radps = 0;
  bool canyon = false;
};

/// Returns the fixes of a receiver and its drawn bias.
/// @param epochs the vehicle at every epoch of the receiver, in order
/// @param common errors at every tick, of which receivers take their common_share
[[nodiscard]] SimulatedGnss sense_gnss(std::span<const PlacedState> epochs,
                                       const drive::Projection& projection, const GnssRecipe& recipe,
                                       const LastingErrors& common, const SourceStreams& streams);

/// Fills the truth. @param states at the stamps of the truth, in order
void sense_truth(std::span<const PlacedState> states, const drive::Projection& projection,
                 SimulatedDrive& drive);

/// Returns true for every epoch without a reading. There are exactly `missing` of them, in outages
/// with a mean length of `mean_length` epochs.
[[nodiscard]] std::vector<bool> draw_outages(std::size_t epochs, int missing, double mean_length,
                                             RandomStream random);

/// Returns the sum of the bursts at every epoch, true east and north. @param canyon whether a burst
/// may begin, epoch by epoch at the rate of the recipe
[[nodiscard]] std::vector<Eigen::Vector2d> draw_bursts(const std::vector<bool>& canyon,
                                                       const GnssRecipe& recipe, RandomStream random);

}  // namespace waymark::simulation
