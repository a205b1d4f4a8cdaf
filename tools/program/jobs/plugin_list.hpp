/// The content of plugins, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include <waymark/core/registry/registry.hpp>

namespace waymark::program {

/// Returns every plugin with name, version, place, and the names of its registered types.
[[nodiscard]] nlohmann::ordered_json plugins_json(const TypeRegistry& registry);

}  // namespace waymark::program
