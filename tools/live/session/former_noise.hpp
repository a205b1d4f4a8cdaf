/// The noise that a former run estimated, for a run that cannot wait for the end of the drive.
#pragma once

#include <string>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>

namespace waymark::live {

/// Takes the noise of the same modeling as options of the models, and the decision that fixes are not late;
/// stated options stay.
/// @param path summary.json of `run`, or its folder
/// @throws InputError for a file that has no noise of the modeling
void use_former_noise(const std::string& path, const TypeRegistry& registry, drive::FusionSettings& settings);

}  // namespace waymark::live
