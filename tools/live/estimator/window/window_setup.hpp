/// The window of a drive's description: which sources it has, and what its plugins know of them.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <waymark/core/drive/modeling.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>
#include <waymark/tools/live/estimator/window/window.hpp>

namespace waymark::live {

/// How the fusion of a drive is set up.
struct FusionSetup {
  drive::FusionSettings settings;  ///< from decided()
  /// how late the fixes of each receiver are beside their stated delay, about which a delay is linearised, s;
  /// empty: 0
  std::vector<double> delays_s{};
  /// what each receiver had claimed in the drive that the noise is from. The noise holds for these claims: kinds of
  /// solutions that were among them keep their medians. Empty: the noise is from no drive
  std::map<int, ClaimedAccuracies> claimed{};
};

/// Returns a window without nodes. @param registry must outlive it
[[nodiscard]] std::unique_ptr<Window> make_window(const drive::DriveDescription& description,
                                                  const FusionSetup& setup, const Frame& frame,
                                                  std::optional<drive::FirstPose> first_pose,
                                                  const TypeRegistry& registry);

}  // namespace waymark::live
