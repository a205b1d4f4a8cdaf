/// How far the bias of a gyro walks, by the probability of the drive so far.
///
/// Stops tell it where there are some (gyro_shown.hpp). The fixes tell it as well: a bias that walks faster than is
/// assumed turns the way from them again and again. The search for the noise is done for some walks; each counts with
/// its probability, under a prior by which two of three gyros are within a factor of e of the usual one.
#pragma once

#include <functional>
#include <span>
#include <string>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/model/fuse.hpp>

namespace waymark::live {

/// Widens the walk of an odometry's bias to what is expected of it, and takes the noise that fits best with it.
/// Nothing changes if the model has no bias that walks.
/// @param modeled from Fusion::estimated() @param odometry name of the source that gives the nodes
/// @param between as for drive::estimate_noise()
void take_bias_walk(std::span<const drive::PreparedSensor> sensors, const std::string& odometry,
                    const TypeRegistry& registry, const std::function<void()>& between,
                    drive::ModeledDrive& modeled);

}  // namespace waymark::live
