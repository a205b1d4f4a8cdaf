/// The window of a drive's description: which sources it has, and what its plugins know of them.
#pragma once

#include <memory>
#include <optional>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/drive_description.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>
#include <waymark/tools/live/estimator/window.hpp>

namespace waymark::live {

/// Returns a window without nodes. @param settings from decided() @param registry must outlive it
[[nodiscard]] std::unique_ptr<Window> make_window(const drive::DriveDescription& description,
                                                  const drive::FusionSettings& settings, const Frame& frame,
                                                  std::optional<drive::FirstPose> first_pose,
                                                  const TypeRegistry& registry);

}  // namespace waymark::live
