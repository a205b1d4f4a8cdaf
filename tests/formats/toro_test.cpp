// TORO's order of the six numbers, as information and as GTSAM's covariance, and refusals.

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/formats/text/text_file.hpp>

#include "formats/read_helpers.hpp"
#include "support/skip.hpp"

using namespace waymark;
using namespace waymark::formats;

namespace {

GraphDocument read_as(GraphFormat format, const std::string& text) {
  return read_graph_as(format, text, "a.graph", test_registry());
}

GraphDocument read_as_toro(const std::string& text) {
  return read_as(GraphFormat::toro, text);
}

/// The chi2 of a file's text, read in the format.
double chi2(GraphFormat format, const std::string& text) {
  return read_as(format, text).graph.chi2();
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
  CHECK(graph.value(*graph.find(VertexId{7}))[1] == 5);
}

TEST_CASE("covariance: the same six numbers are the inverse") {
  // GTSAM's readNoiseModel, NoiseFormatGRAPH: the matrix of v1 v2 v5, v2 v3 v6, v5 v6 v4 is a
  // covariance.
  const Eigen::Matrix3d covariance =
      (Eigen::Matrix3d() << 0.5, 0.1, 0.02, 0.1, 0.4, 0.03, 0.02, 0.03, 0.1).finished();
  const GraphDocument document =
      read_as(GraphFormat::covariance,
              "VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0\nODOMETRY 0 1 1 0 0 0.5 0.1 0.4 0.1 0.02 0.03\n");
  const Eigen::Matrix3d information = document.graph.batch(0).information(0);
  CHECK((information * covariance - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-14);
}

TEST_CASE("TORO and covariance: wrong lines are refused with their place") {
  const std::tuple<GraphFormat, const char*, const char*> cases[] = {
      {GraphFormat::toro, "", "a.graph: no vertices in it"},
      {GraphFormat::toro, "VERTEX2 0 0 0\n",
       "a.graph:1:14: VERTEX2: expected a number for 'heading', got the end of the line"},
      {GraphFormat::toro, "VERTEX2 0 0 0 0\nVERTEX 0 0 0 0\n",
       "a.graph:2:8: VERTEX: vertex 0 is defined a second time"},
      {GraphFormat::toro, "VERTEX2 0 0 0 0\nEDGE2 0 1 1 0 0 1 0 1 1 0 0\n",
       "a.graph:2:9: EDGE2: vertex 1 is not defined"},
      {GraphFormat::toro, "VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE2 0 1 1 0 0 1 5 1 1 0 0\n",
       "a.graph:3:28: EDGE2: the information matrix is indefinite"},
      {GraphFormat::toro, "VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE2 0 1 1 0 0 1 0 1 1 0\n",
       "EDGE2: expected a number for 'information[5]', got the end of the line"},
      {GraphFormat::toro, "VERTEX2 0 0 0 0\nEQUIV 0 1\n",
       "a.graph:2:1: unknown tag 'EQUIV'; a file of --input-format toro has VERTEX2 and EDGE2"},
      {GraphFormat::toro, "GRAPH 1\nVERTEX_SE2 0 0 0 0\n", "a.graph:1:1: unknown tag 'GRAPH'"},
      {GraphFormat::toro, "VERTEX2 0 0 0 0\nFIX 0\n", "a.graph:2:1: unknown tag 'FIX'"},
      {GraphFormat::toro, "VERTEX2 0 0 0 0\nODOMETRY 0 1 1 0 0 1 0 1 1 0 0\n", "unknown tag 'ODOMETRY'"},
      {GraphFormat::covariance, "VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE2 0 1 1 0 0 1 0 1 0 0 0\n",
       "a.graph:3:28: EDGE2: the covariance matrix is not positive definite"},
      {GraphFormat::covariance, "VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE2 0 1 1 0 0 1 2 1 1 0 0\n",
       "the covariance matrix is not positive definite"},
      {GraphFormat::covariance, "VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE2 0 1 1 0 0 1 0 x 1 0 0\n",
       "a.graph:3:21: EDGE2: expected a number for 'covariance[2]', got 'x'"},
      {GraphFormat::covariance, "VERTEX2 0 0 0 0\nLANDMARK 0 1 1 0 0 1 0\n", "unknown tag 'LANDMARK'"},
      // numbers behind the last one
      {GraphFormat::toro, "VERTEX2 0 0 0 0 7\n",
       "a.graph:1:17: VERTEX2: expected the end of the line, got '7'"},
      {GraphFormat::covariance, "VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE2 0 1 1 0 0 1 0 1 1 0 0 5\n",
       "a.graph:3:29: EDGE2: expected the end of the line, got '5'"},
      // a matrix that says nothing
      {GraphFormat::toro, "VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE2 0 1 1 0 0 0 0 0 0 0 0\n",
       "a.graph:3:28: EDGE2: the information matrix is zero; remove the edge"},
      {GraphFormat::covariance, "VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE2 0 1 1 0 0 0 0 0 0 0 0\n",
       "the covariance matrix is not positive definite, or its inverse not finite; give the variances"},
      // tags of the other formats
      {GraphFormat::toro, "VERTEX_SE2 0 0 0 0\n",
       "a.graph:1:1: unknown tag 'VERTEX_SE2'; a file of --input-format toro has VERTEX2 and EDGE2, and this "
       "tag is of .graph or g2o: leave --input-format out"},
      {GraphFormat::covariance, "VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n",
       "a.graph:3:1: unknown tag 'EDGE_SE2'; a file of --input-format covariance has VERTEX2 and EDGE2, and "
       "this tag is of .graph or g2o"}};
  for (const auto& [format, text, message] : cases) {
    INFO(text);
    CHECK_THROWS_WITH(read_as(format, text), Catch::Contains(message));
  }
}

TEST_CASE("TORO and covariance: files with edges only get their vertices, lenient reading counts") {
  for (const GraphFormat format : {GraphFormat::toro, GraphFormat::covariance}) {
    ReadReport report;
    const GraphDocument document = read_graph_as(
        format, "EDGE2 3 4 1 0 1.5 1 0 1 1 0 0\nEDGE2 4 5 2 0 0 1 0 1 1 0 0\nEDGE2 4 5 2 0 0 1 0 1 1 0\n",
        "a.graph", test_registry(), true, &report);
    CHECK(report.edges_only);
    CHECK(report.skipped == 1);
    CHECK(document.graph.vertex_count() == 3);
    CHECK(document.graph.chi2() < 1e-28);
    CHECK(document.graph.value(*document.graph.find(VertexId{5}))[0] == Approx(1 + 2 * std::cos(1.5)));
  }
}

TEST_CASE("fr079: chi2 is the same through every format, and another if TORO is taken for covariance") {
  const auto file = waymark_test::shared_data("graphs/fr079_toro.graph");
  if (!file) return;
  const std::string text = read_text_file(*file);
  const GraphDocument document = read_as_toro(text);
  REQUIRE(document.graph.vertex_count() == 989);
  REQUIRE(document.graph.edge_count() == 1217);
  const double expected = document.graph.chi2();
  CHECK(expected > 1);
  CHECK(chi2(GraphFormat::g2o, write_as(GraphFormat::g2o, document)) == expected);
  CHECK(chi2(GraphFormat::toro, write_as(GraphFormat::toro, document)) == expected);
  CHECK(chi2(GraphFormat::covariance, write_as(GraphFormat::covariance, document)) ==
        Approx(expected).epsilon(1e-9));
  CHECK(read(write(document)).graph.chi2() == expected);
  // Nothing in the file tells the two apart, and nothing fails: hence the format is said, never
  // guessed.
  CHECK(chi2(GraphFormat::covariance, text) < 1e-3 * expected);
}

TEST_CASE(
    "covariance: a matrix without a finite inverse is refused, and the least one that has an inverse is written") {
  const auto text = [](const char* variance) {
    const std::string v = variance;
    return "VERTEX2 0 0 0 0\nVERTEX2 1 0 0 0\nEDGE2 0 1 1 0 0 " + v + " 0 " + v + " " + v + " 0 0\n";
  };
  CHECK_THROWS_WITH(
      read_as(GraphFormat::covariance, text("1e-309")),
      "a.graph:3:43: EDGE2: the covariance matrix is not positive definite, or its inverse not finite; give "
      "the variances of this edge, or read the file with --input-format toro if the numbers are information");
  const GraphDocument document = read_as(GraphFormat::covariance, text("1e-308"));
  CHECK(document.graph.batch(0).information(0).diagonal().isApproxToConstant(1e308, 1e-12));
  CHECK(write_as(GraphFormat::g2o, document).find("inf") == std::string::npos);
}
