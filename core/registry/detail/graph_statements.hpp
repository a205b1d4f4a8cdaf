/// The words of .graph files that types may not take.
#pragma once

#include <string_view>

namespace waymark::detail {

/// Statements that only .graph files have (formats/README.md, Statements); g2o files have FIX too.
inline constexpr std::string_view kGraphStatements[] = {
    "GRAPH", "FRAME", "TIME",  "PROVENANCE", "LEVER", "SOURCE",    "STATES",
    "EDGES", "TYPE",  "STAMP", "LOSS",       "GNSS",  "COVARIANCE"};

}  // namespace waymark::detail
