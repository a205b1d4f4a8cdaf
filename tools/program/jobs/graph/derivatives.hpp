/// Tests the derivatives of every registered edge type without a graph.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <waymark/core/graph/checks/edge_type_check.hpp>
#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::program {

/// The result as text and JSON.
struct DerivativeReport {
  std::string text;                   ///< one line per type
  nlohmann::ordered_json json;        ///< the same
  std::vector<std::string> problems;  ///< one sentence per type with a wrong Jacobian
};

/// Compares the Jacobians of each type with differences of its error
/// (core/graph/checks/edge_type_check.hpp).
[[nodiscard]] DerivativeReport check_derivatives(const TypeRegistry& registry,
                                                 const text::TextLook& look = {});

/// Returns a sentence about a type that is not sound.
[[nodiscard]] std::string problem_of(const EdgeTypeCheck& check, const std::string& tag,
                                     const std::string& origin);

}  // namespace waymark::program
