/// What the sensors of a simulated vehicle read along its way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/logs/projection.hpp>
#include <waymark/tools/simulation/road.hpp>
#include <waymark/tools/simulation/simulation.hpp>

namespace waymark::simulation {

/// Fills odometry and the calibration drawn for it. The k-th sample lies one tick after k / rate: streams of
/// 25 Hz and 1 Hz do not coincide.
/// @param start  stamp of tick 0
void sense_odometry(const std::vector<DrivenState>& states, Stamp start, SimulatedDrive& drive);

/// The vehicle in the frame, where a receiver or the reference looks at it.
struct PlacedState {
  Stamp stamp;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  ///< frame
  double speed_mps = 0;
  bool canyon = false;
};

/// Fills the fixes and the bias drawn for them. @param epochs  the vehicle at every whole second, in order
void sense_gnss(std::span<const PlacedState> epochs, const drive::Projection& projection,
                SimulatedDrive& drive);

/// Fills the truth. @param states at the stamps of the truth, in order
void sense_truth(std::span<const PlacedState> states, const drive::Projection& projection,
                 SimulatedDrive& drive);

/// True where the epoch has no fix: exactly `missing` of them, in outages of `mean_length` epochs in the
/// mean.
[[nodiscard]] std::vector<bool> draw_outages(std::size_t epochs, int missing, double mean_length,
                                             std::uint64_t seed);

/// The bursts' sum at every epoch, true east and north. @param canyon where they may begin, epoch by epoch, 1
/// Hz
[[nodiscard]] std::vector<Eigen::Vector2d> draw_bursts(const std::vector<bool>& canyon,
                                                       const GnssRecipe& recipe, std::uint64_t seed);

}  // namespace waymark::simulation
