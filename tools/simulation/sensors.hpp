/// Simulates the readings of the sensors along the way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/logs/projection.hpp>
#include <waymark/tools/simulation/road.hpp>
#include <waymark/tools/simulation/simulation.hpp>

namespace waymark::simulation {

/// Fills the odometry and its drawn calibration. The k-th sample is one tick after k / rate, so
/// streams of 25 Hz and 1 Hz do not coincide.
/// @param start stamp of tick 0
void sense_odometry(const std::vector<DrivenState>& states, Stamp start, SimulatedDrive& drive);

/// The vehicle in the frame, at an instant of a receiver or of the reference.
struct PlacedState {
  Stamp stamp;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< frame
  double speed_mps = 0;
  bool canyon = false;
};

/// Fills the fixes and their drawn bias. @param epochs the vehicle at every whole second, in order
void sense_gnss(std::span<const PlacedState> epochs, const drive::Projection& projection,
                SimulatedDrive& drive);

/// Fills the truth. @param states at the stamps of the truth, in order
void sense_truth(std::span<const PlacedState> states, const drive::Projection& projection,
                 SimulatedDrive& drive);

/// Returns true for every epoch without a fix. There are exactly `missing` of them, in outages with
/// a mean length of `mean_length` epochs.
[[nodiscard]] std::vector<bool> draw_outages(std::size_t epochs, int missing, double mean_length,
                                             std::uint64_t seed);

/// Returns the sum of the bursts at every epoch, true east and north. @param canyon whether a burst
/// may begin, epoch by epoch, 1 Hz
[[nodiscard]] std::vector<Eigen::Vector2d> draw_bursts(const std::vector<bool>& canyon,
                                                       const GnssRecipe& recipe, std::uint64_t seed);

}  // namespace waymark::simulation
