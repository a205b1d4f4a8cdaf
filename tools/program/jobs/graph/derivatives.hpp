/// The derivatives of every registered edge type, tried out without a graph.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::program {

/// What was found, ready to be told.
struct DerivativeReport {
  std::string text;                   ///< a line per type
  nlohmann::ordered_json json;        ///< the same
  std::vector<std::string> problems;  ///< a sentence per type with a wrong Jacobian
};

/// Compares each type's Jacobians with differences of its error (core/graph/edge_type_check.hpp).
[[nodiscard]] DerivativeReport check_derivatives(const TypeRegistry& registry,
                                                 const text::TextLook& look = {});

}  // namespace waymark::program
