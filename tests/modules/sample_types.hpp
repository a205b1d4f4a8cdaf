/// What the sample plugins register; one object file of it is a part of all of them.
#pragma once

#include <waymark/core/registry/registry.hpp>

namespace waymark_test::modules {

/// EDGE_SAMPLE, a sound edge.
void add_sound_edge(waymark::TypeRegistry& registry);
/// An edge with the tag of another.
void add_taken_edge(waymark::TypeRegistry& registry);
/// EDGE_SAMPLE with a wrong sign in its Jacobian.
void add_edge_with_wrong_jacobian(waymark::TypeRegistry& registry);
/// EDGE_SAMPLE, which says kRelative and is not.
void add_falsely_relative_edge(waymark::TypeRegistry& registry);
/// 'refusing', a linear solver that calls every matrix indefinite.
void add_refusing_solver(waymark::TypeRegistry& registry);

/// 'located', a sensor that needs the place of the frame and the logs of the other sources.
void add_located_sensor(waymark::TypeRegistry& registry);

}  // namespace waymark_test::modules
