/// Numbers in JSON files.
#pragma once

#include <cmath>

#include <nlohmann/json.hpp>

namespace waymark::text {

/// JSON knows no NaN and no infinity: null stands where a number is not defined.
[[nodiscard]] inline nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace waymark::text
