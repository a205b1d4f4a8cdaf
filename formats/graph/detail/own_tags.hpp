/// Words at the beginning of a line that no type is registered for.
#pragma once

#include <string_view>

namespace waymark::formats {

/// Statements of a .graph file.
inline constexpr std::string_view kOwnTags[] = {"GRAPH",  "FRAME",  "TIME",      "PROVENANCE", "LEVER",
                                                "SOURCE", "STATES", "EDGES",     "TYPE",       "STAMP",
                                                "LOSS",   "GNSS",   "COVARIANCE"};
/// Vertices and edges of TORO and GTSAM.
inline constexpr std::string_view kToroTags[] = {"VERTEX2", "EDGE2", "VERTEX", "EDGE", "ODOMETRY"};

}  // namespace waymark::formats
