/// The one problem of the allocation tests that no other test has.
#pragma once

#include <waymark/core/graph/graph.hpp>
#include <waymark/core/registry/registry.hpp>

namespace waymark_test {

/// Returns a drive with a dense calibration state. It has its own file, because otherwise g++ 12
/// mistakes its edges of three vertices for edges of two (a false -Warray-bounds).
[[nodiscard]] waymark::Graph calibrated_problem(const waymark::TypeRegistry& registry);

}  // namespace waymark_test
