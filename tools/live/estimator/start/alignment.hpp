/// How a window begins: where the vehicle was while the first fixes came, and how it headed.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <waymark/core/drive/frame.hpp>
#include <waymark/core/drive/sample.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/estimation/noise.hpp>
#include <waymark/tools/drive/model/place.hpp>
#include <waymark/tools/live/estimator/reckoning.hpp>
#include <waymark/tools/live/estimator/settings.hpp>
#include <waymark/tools/live/estimator/window/window.hpp>

namespace waymark::live {

/// What a later run may begin with.
struct WarmStart {
  Stamp stamp;
  Frame frame;
  std::optional<Eigen::Vector3d> pose{};  ///< none: only the states are known
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  std::vector<KnownState> states{};
  drive::NoiseEstimate noise{};  ///< values alone; without parameters: nothing was learned
};

/// Tells whether the way that the fixes show is long beside their errors: else it has no direction.
[[nodiscard]] bool heading_is_known(const std::deque<Fix>& fixes, const Reckoning& reckoning,
                                    const LiveSettings& live);

/// Returns the nodes so far, laid along the fixes. It has no fixes itself.
[[nodiscard]] PlacedStretch laid_along(const std::deque<Fix>& fixes, const Reckoning& reckoning,
                                       const drive::FusionSettings& settings);

/// Returns the nodes so far, the first one at a pose. It has no fixes itself.
[[nodiscard]] PlacedStretch placed_at(const Eigen::Vector3d& pose, const Reckoning& reckoning);

/// Returns how far the vehicle was moved since a former run, by the first fix, m; empty if it still is where
/// the run ended. @param start with a pose
[[nodiscard]] std::optional<double> moved_since(const WarmStart& start, const Fix& fix,
                                                const LiveSettings& live);

/// Returns the prior of the first pose. @param start with a pose
[[nodiscard]] drive::FirstPose first_pose_of(const WarmStart& start);

}  // namespace waymark::live
