/// Numbers in JSON files.
#pragma once

#include <cmath>

#include <nlohmann/json.hpp>

namespace waymark::text {

/// Returns null for a number that is not finite, because JSON has no NaN and no infinity.
[[nodiscard]] inline nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace waymark::text
