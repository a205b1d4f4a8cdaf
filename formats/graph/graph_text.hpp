/// The text of a graph file, which may come from a pipe that never ends.
#pragma once

#include <string>

#include <waymark/core/registry/registry.hpp>

namespace waymark::formats {

/// Reads a whole graph file as read_text_file() does. Every MiB of a pipe or device must have a line with a tag
/// of the registry or of a format, so that memory is bounded by what may be a graph.
/// @throws InputError
[[nodiscard]] std::string read_graph_text(const std::string& path, const TypeRegistry& registry);

}  // namespace waymark::formats
