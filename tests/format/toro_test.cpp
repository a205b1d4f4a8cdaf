// TORO's order of the information matrix, and what is refused.
#include <fstream>
#include <iostream>
#include <sstream>

#include <catch2/catch.hpp>

#include <waymark/core/error.hpp>
#include <waymark/formats/toro.hpp>

#include "format/read_helpers.hpp"
#include "support/paths.hpp"

using namespace waymark;

namespace {

GraphDocument read_as_toro(const std::string& text) {
  return read_toro(text, "a.graph", test_registry());
}

}  // namespace

TEST_CASE("TORO: the six numbers are I_ff I_fs I_ss I_rr I_fr I_sr, and vertices may stand last") {
  const GraphDocument document =
      read_as_toro("# comment\nEDGE2 0 7 1 2 0.5 10 1 20 30 2 3\nVERTEX2 0 0 0 0\r\n\nVERTEX2 7 4 5 6\n");
  const Graph& graph = document.graph;
  REQUIRE(graph.edge_count() == 1);
  CHECK(graph.edge_type(0).tag == "EDGE_SE2");
  const Eigen::MatrixXd expected = (Eigen::Matrix3d() << 10, 1, 2, 1, 20, 3, 2, 3, 30).finished();
  CHECK(graph.batch(0).information(0) == expected);
  std::vector<double> fields;
  graph.batch(0).fields(0, fields);
  CHECK(fields == std::vector<double>{1, 2, 0.5});
  CHECK(graph.value(*graph.find(7))[1] == 5);
}

TEST_CASE("TORO: wrong lines are refused with their place") {
  const std::pair<const char*, const char*> cases[] = {
      {"", "a.graph: no vertices in it"},
      {"VERTEX2 0 0 0\n", "a.graph:1:14: VERTEX2: expected a number for 'pose[2]', got the end of the line"},
      {"VERTEX2 0 0 0 0\nVERTEX2 0 0 0 0\n", "a.graph:2:9: VERTEX2: vertex 0 is defined a second time"},
      {"VERTEX2 0 0 0 0\nEDGE2 0 1 1 0 0 1 0 1 1 0 0\n", "a.graph:2:9: EDGE2: vertex 1 is not defined"},
      {"VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE2 0 1 1 0 0 1 5 1 1 0 0\n",
       "the information matrix is indefinite"},
      {"VERTEX2 0 0 0 0\nEQUIV 0 1\n",
       "a.graph:2:1: unknown tag 'EQUIV'; a TORO file has VERTEX2 and EDGE2"}};
  for (const auto& [text, message] : cases) {
    INFO(text);
    CHECK_THROWS_WITH(read_as_toro(text), Catch::Contains(message));
  }
}

TEST_CASE("TORO: fr079 is read whole") {
  std::ifstream file(waymark_test::shared_data_dir() / "graphs" / "fr079_toro.graph");
  if (!file) {
    std::cout << "SKIPPED: fr079_toro.graph is not in the shared data\n";
    return;
  }
  std::ostringstream text;
  text << file.rdbuf();
  const GraphDocument document = read_as_toro(text.str());
  CHECK(document.graph.vertex_count() == 989);
  CHECK(document.graph.edge_count() == 1217);
}
