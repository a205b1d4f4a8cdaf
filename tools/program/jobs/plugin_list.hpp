/// What plugins bring, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include <waymark/core/registry/registry.hpp>

namespace waymark::program {

/// Every plugin with name, version, place, and the names of what it registered.
[[nodiscard]] nlohmann::ordered_json plugins_json(const TypeRegistry& registry);

}  // namespace waymark::program
