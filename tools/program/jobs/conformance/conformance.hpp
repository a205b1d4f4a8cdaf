/// The report of the conformance kit (trials.hpp).
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <waymark/core/registry/registry.hpp>
#include <waymark/tools/text/text_look.hpp>

namespace waymark::program {

struct ConformanceReport {
  std::string text;  ///< a row for each type, then the problems
  nlohmann::ordered_json json;
  bool passed = true;
};

/// Tries the types of plugins that are not built in. @param everything those of Waymark and its built-in
/// plugins too
[[nodiscard]] ConformanceReport check_conformance(const TypeRegistry& registry, bool everything,
                                                  const text::TextLook& look);

}  // namespace waymark::program
