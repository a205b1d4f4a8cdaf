/// The report of the conformance kit (trials.hpp).
#pragma once

#include <span>
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

/// Tries what the modules in some files register. @param files names of files; empty: tries everything
[[nodiscard]] ConformanceReport check_conformance(const TypeRegistry& registry,
                                                  std::span<const std::string> files,
                                                  const text::TextLook& look);

}  // namespace waymark::program
