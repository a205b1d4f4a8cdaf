/// How late the fixes are against the odometry, before the graph is built.
///
/// A fix hangs on the node nearest to when it was measured, and its edge is exact at one assumed
/// offset only (EdgeGnssPositionLate). So the offset is found first, on a coarse drive.
#pragma once

#include <optional>

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/tools/drive/model/place.hpp>

namespace waymark::drive {

/// Finds PlacedDrive::time_offset_s. The coarse drive is fused with the offset of before, and again
/// with the offset that this gives, until it no longer moves. Nothing changes if the settings
/// estimate no time offset. Sensors are left out.
/// @param settings from decided()
/// @throws UsageError for an unknown modeling or option; errors of the plugins
void assume_time_offset(PlacedDrive& placed, const FusionSettings& settings, const TypeRegistry& registry);

/// Returns the vertex of the time offset, if the graph estimates one.
[[nodiscard]] std::optional<VertexIndex> time_offset_vertex(const Graph& graph);

}  // namespace waymark::drive
