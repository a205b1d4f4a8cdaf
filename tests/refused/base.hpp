// What every file of this folder needs beside its mistake.
#pragma once

#include <array>

#include <waymark/core/registry/plugin.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

using namespace waymark;

/// Compiles all of an edge type that a plugin would.
template <typename E>
void use() {
  TypeRegistry registry;
  registry.add_edge<E>();
}
