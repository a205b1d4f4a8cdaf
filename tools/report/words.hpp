/// The words of reports: names of edges for people, and a glossary.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace waymark::report {

/// Returns the name of an edge type for people: "odometry, calibrated" for
/// EDGE_SE2_ODOMETRY_CALIBRATED. A type that is not built in keeps the words of its tag:
/// "loop closure" for EDGE_LOOP_CLOSURE.
[[nodiscard]] std::string edge_name(const std::string& tag);

/// Returns the words of the trade with their meanings. A page explains each at its first use.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> glossary();

}  // namespace waymark::report
