/// The poses of a fused document where its fixes were measured.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/types_se2/stamped_pose.hpp>

namespace waymark::drive {

/// The poses at the fixes, in their order. @throws InputError where a fix's vertex is no pose, or has no
/// stamp or another than the fix.
[[nodiscard]] std::vector<StampedPose> poses_at_fixes(const formats::GraphDocument& document);

/// The covariances of their positions, m^2, frame axes, in the order of the fixes; empty where the document
/// has none of a pose.
[[nodiscard]] std::vector<std::optional<Eigen::Matrix2d>> position_covariances_at_fixes(
    const formats::GraphDocument& document);

/// The poses when the fixes were really measured: at their stamps minus the estimated time offset, along the
/// constant twist between the nodes beside. Empty where the graph estimates none.
[[nodiscard]] std::vector<Eigen::Vector3d> poses_when_measured(const formats::GraphDocument& document);

}  // namespace waymark::drive
