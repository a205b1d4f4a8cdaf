/// Tries whether the sight of an edge type agrees with its error.
#pragma once

#include <waymark/core/registry/registry.hpp>

namespace waymark::detail {

/// Returns the largest error of edges of a type at points where their sight says that it is zero: for several
/// measurements, places of the pose, and points of the ray or circle. Fields are positive, as ranges are. It is 0 for
/// a type without a sight, and for one that joins more vertices than a pose and a point, because nothing is known
/// of the others. @throws UsageError if a vertex type that the edge joins is not registered
[[nodiscard]] double sight_error_of(const TypeRegistry& registry, const EdgeType& type);

}  // namespace waymark::detail
