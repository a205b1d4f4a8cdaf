/// The key workload of the convergence tables: a simulated drive of 105,000 poses as g2o files.
/// Its generator is not part of this repository; the environment variable WAYMARK_KEY_WORKLOAD
/// names the folder.
#pragma once

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>

#include <waymark/formats/graph/graph_document.hpp>

namespace waymark_test {

/// the nodes of G2 and G3 have ids from here
inline constexpr waymark::VertexId kFirstGnssNode = 1000000;

/// Returns the workload under "G1", "G2" or "G3", dead-reckoned, in UTM coordinates. If it is
/// missing, prints a line and returns nothing.
[[nodiscard]] inline std::optional<waymark::Graph> key_workload(const std::string& modeling,
                                                                const waymark::TypeRegistry& registry) {
  const char* folder = std::getenv("WAYMARK_KEY_WORKLOAD");
  const std::string name = "drive_" + modeling + "_utm_h0.g2o";
  std::ifstream file(std::string(folder != nullptr ? folder : ".") + "/" + name, std::ios::binary);
  if (!file) {
    std::cout << "SKIPPED: WAYMARK_KEY_WORKLOAD names no folder with " << name << '\n';
    return std::nullopt;
  }
  std::ostringstream text;
  text << file.rdbuf();
  return waymark::formats::read_graph(text.str(), name, registry).graph;
}

}  // namespace waymark_test
