/// Receivers that err alike: the same satellites, the same reflections, the same corrections. Taken for independent, they
/// would confirm each other's errors.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

/// Finds receivers that may share their lasting errors with an earlier one: what the poses leave of their fixes has no
/// negative correlation with that of the other one. Errors of their own leave residuals on both sides of the poses. It is a
/// proposal, and the evidence decides.
/// @param placed with the time offsets of its fixes @param stated by the user @param settings with the noise
/// @param between called between its fusions; what it throws ends the search. Empty: nothing is called
/// @return for each of them (SourceSettings::common) the first one of its group; empty if the modelings share no errors
[[nodiscard]] std::map<std::string, std::string> find_common_errors(
    const PlacedDrive& placed, std::span<const PreparedSensor> sensors, const FusionSettings& stated,
    const FusionSettings& settings, const TypeRegistry& registry, const std::function<void()>& between = {});

/// Returns the warning about receivers that are taken for a group.
[[nodiscard]] std::string warning_of(const std::map<std::string, std::string>& common);

}  // namespace waymark::drive
