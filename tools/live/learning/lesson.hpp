/// What a drive so far tells about itself: its noise, and what is wrong with its sources. It is found as for a
/// whole drive: the same preparation, checks and search.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/estimation/noise.hpp>
#include <waymark/tools/live/estimator/window/window_setup.hpp>
#include <waymark/tools/live/learning/drive_so_far.hpp>

namespace waymark::live {

struct Lesson {
  double length_s = 0;         ///< of the drive that it is about
  FusionSetup setup;           ///< with the noise and the decisions on delays
  drive::NoiseEstimate noise;  ///< without parameters: it is stated
  /// what is added to the covariance of a pose because the noise is not known well (noise_spread.hpp)
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  std::vector<std::string> warnings;
  std::set<std::string> left_out;  ///< names of sources that the others contradict
  std::string failure;             ///< why the drive so far tells nothing; empty: it does
};

/// What a lesson depends on beside the drive.
struct LessonTask {
  drive::DriveDescription description;  ///< from described_so_far()
  drive::FusionSettings stated;         ///< settings of the drive, without what was learned
  std::set<std::string> suspects;       ///< sources that were left out of an earlier part of the drive
  /// nobody has stated how far the bias of the first odometry's gyro walks: bias_walk.hpp
  bool walk_is_open = true;
};

/// A search that goes astray is ended after some times the steps that others take, and done again for the last half of
/// the drive, and for half of that.
/// @param between called between the steps of the search; what it throws ends it
[[nodiscard]] Lesson learn(DriveSoFar so_far, const LessonTask& task, const TypeRegistry& registry,
                           const std::function<void()>& between);

/// Returns "white_sigma 1.2 m, heading_variance_per_s 3.1e-07 rad^2/s": the parameters that the drive shows.
[[nodiscard]] std::string in_words(const drive::NoiseEstimate& noise);

}  // namespace waymark::live
