/// The poses of a fused document at its fixes.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <waymark/formats/graph/graph_document.hpp>
#include <waymark/types_se2/stamped_pose.hpp>

namespace waymark::drive {

/// Returns the poses at the fixes, in their order. @throws InputError if the vertex of a fix is no
/// pose, or has another stamp or none
[[nodiscard]] std::vector<StampedPose> poses_at_fixes(const formats::GraphDocument& document);

/// Returns the vertices at which a document is evaluated: those of its fixes, in their order. Without
/// fixes, the poses with stamps that are 0.2 s or more apart.
[[nodiscard]] std::vector<VertexIndex> evaluated_vertices(const formats::GraphDocument& document);

/// Returns the poses at these vertices. Errors are those of poses_at_fixes
[[nodiscard]] std::vector<StampedPose> evaluated_poses(const formats::GraphDocument& document);

/// Returns the covariances of their positions, m^2, frame axes, in the order of evaluated_vertices().
/// Empty where the document has none.
[[nodiscard]] std::vector<std::optional<Eigen::Matrix2d>> evaluated_covariances(
    const formats::GraphDocument& document);

/// Returns the standard deviations of their headings, rad. Empty where the document has no
/// covariance.
[[nodiscard]] std::vector<std::optional<double>> evaluated_heading_sigmas(
    const formats::GraphDocument& document);

/// Returns the height at each of these vertices, m above the ellipsoid: that of the last height state
/// (VertexType::height) up to its stamp, which holds until the next one. Empty if the graph has none. Of
/// several sources with heights, those of the first one.
[[nodiscard]] std::vector<double> evaluated_heights(const formats::GraphDocument& document);

/// Returns the poses at the true times of the fixes: their stamps minus the estimated time offset,
/// along the constant twist between the adjacent nodes. Empty if the graph estimates no offset.
[[nodiscard]] std::vector<Eigen::Vector3d> poses_when_measured(const formats::GraphDocument& document);

/// Returns poses_when_measured; if no offset is estimated, the poses at the stamps of the fixes.
[[nodiscard]] std::vector<Eigen::Vector3d> poses_of_fixes(const formats::GraphDocument& document);

}  // namespace waymark::drive
