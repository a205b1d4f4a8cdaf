/// What the allocation tests optimise.
#pragma once

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/registry/registry.hpp>

namespace waymark_test {

/// A drive with a dense calibration state; in a file of its own, where g++ 12 does not mistake its edges of
/// three vertices for those of two (a false -Warray-bounds).
[[nodiscard]] waymark::Graph calibrated_problem(const waymark::TypeRegistry& registry);

}  // namespace waymark_test
