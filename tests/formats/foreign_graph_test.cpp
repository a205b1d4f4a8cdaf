// A graph written for another program has the same chi2 by that program's own formula.
#include <cmath>
#include <map>
#include <random>
#include <sstream>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/g2o_edges.hpp>

#include "formats/read_helpers.hpp"
#include "support/paths.hpp"

using namespace waymark;
using namespace waymark::formats;

namespace {

std::string write_for(const char* profile, const GraphDocument& document) {
  const Recipient& recipient = *find_profile(profile);
  return collect_text([&](const TextSink& sink) {
    ForeignGraph(document, "test.graph", recipient, recipient.formats.front()).write(sink);
  });
}

Eigen::MatrixXd some_information(int n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return unit(random); });
  const Eigen::MatrixXd information = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
  return 0.5 * (information + information.transpose());
}

/// Poses anywhere, points, and the edges that g2o has other words for; nothing near its minimum.
GraphDocument mixed_document() {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  GraphDocument document;
  Graph& graph = document.graph;
  for (int i = 0; i < 10; ++i) {
    graph.add_vertex<VertexSe2>(VertexId(i - 1), {10 * unit(random), 10 * unit(random), 3 * unit(random)});
    graph.add_vertex<VertexXy>(VertexId(100 + i), {10 * unit(random), 10 * unit(random)});
  }
  graph.set_fixed(0, true);
  const auto vector = [&] { return Eigen::Vector2d(2 * unit(random), 2 * unit(random)); };
  const auto pose = [&] { return Eigen::Vector3d(2 * unit(random), 2 * unit(random), 3 * unit(random)); };
  for (int i = 0; i < 9; ++i) {
    const VertexIndex from = 2 * i;
    const VertexIndex to = from + 2;
    graph.add_edge(EdgeSe2{pose()}, {from, to}, some_information(3, random));
    graph.add_edge(EdgeGnssPosition{vector(), vector()}, {from, to}, some_information(2, random));
    graph.add_edge(EdgeGnssPosition{vector()}, {from, to}, some_information(2, random));
    graph.add_edge(EdgeSe2Offset{pose(), pose(), pose()}, {from, to}, some_information(3, random));
    graph.add_edge(EdgeSe2PointXyOffset{vector(), pose()}, {from, to + 1}, some_information(2, random));
    graph.add_edge(EdgeBearingSe2Xy{unit(random)}, {from, to + 1}, some_information(1, random));
    graph.add_edge(EdgePriorSe2Xy{vector()}, {to}, some_information(2, random));
    graph.add_edge(EdgePriorXy{vector()}, {to + 1}, some_information(2, random));
  }
  return document;
}

/// A pose or a motion as a matrix, as g2o's caches multiply them.
Eigen::Isometry2d motion(double x, double y, double heading) {
  Eigen::Isometry2d result = Eigen::Isometry2d::Identity();
  result.translate(Eigen::Vector2d(x, y)).rotate(heading);
  return result;
}

/// chi2 of a file as Ceres' example evaluates it: e = (R_a^T (p_b - p_a) - p_ab, wrapped yaw),
/// weighed by the lower Cholesky factor of the information (pose_graph_2d.cc and
/// pose_graph_2d_error_term.h).
double chi2_of_example(const std::string& text) {
  std::map<int, Eigen::Vector3d> poses;
  std::istringstream in(text);
  double sum = 0;
  for (std::string tag; in >> tag;) {
    int a = 0;
    in >> a;
    if (tag == "VERTEX_SE2") {
      in >> poses[a][0] >> poses[a][1] >> poses[a][2];
      continue;
    }
    if (tag == "FIX") continue;  // the example would stop here; for the comparison with a plain file only
    REQUIRE(tag == "EDGE_SE2");
    int b = 0;
    Eigen::Vector3d z;
    Eigen::Matrix3d m;
    in >> b >> z[0] >> z[1] >> z[2];
    in >> m(0, 0) >> m(0, 1) >> m(0, 2) >> m(1, 1) >> m(1, 2) >> m(2, 2);
    m.triangularView<Eigen::StrictlyLower>() = m.transpose();
    const Eigen::Matrix3d root = m.llt().matrixL();
    Eigen::Vector3d e;
    e.head<2>() = Eigen::Rotation2Dd(poses.at(a)[2]).toRotationMatrix().transpose() *
                      (poses.at(b) - poses.at(a)).head<2>() -
                  z.head<2>();
    e[2] = std::remainder(poses.at(b)[2] - poses.at(a)[2] - z[2], 2 * M_PI);
    sum += (root * e).squaredNorm();
  }
  return sum;
}

}  // namespace

TEST_CASE("g2o: lever arms as offsets have the same chi2, and offsets come back as they were") {
  const GraphDocument document = mixed_document();
  const GraphDocument back = read(write_as(GraphFormat::g2o, document));
  CHECK(back.graph.chi2() == Approx(document.graph.chi2()).epsilon(1e-13));
  CHECK(back.graph.edge_count() == document.graph.edge_count());
  const std::string again = write_as(GraphFormat::g2o, back);
  CHECK(write_as(GraphFormat::g2o, read(again)) == again);
}

TEST_CASE("g2o: offset edges are formed as its caches form them, Z^-1 (X O)^-1 (Y P), and (X O)^-1 l") {
  // EdgeSE2Offset::computeError; for points the meaning of its initialEstimate and its name.
  const Graph graph = read(
                          "PARAMS_SE2OFFSET 3 1.2 -0.3 0.4\nPARAMS_SE2OFFSET 5 -0.5 0.1 2\n"
                          "VERTEX_SE2 0 1 2 0.5\nVERTEX_SE2 1 3 1 -1.1\nVERTEX_XY 2 4 5\n"
                          "EDGE_SE2_OFFSET 0 1 3 5 0.7 0.2 0.1 4 1 0.5 9 0.25 16\n"
                          "EDGE_SE2_POINTXY_OFFSET 1 2 3 0.7 0.2 4 1 9\n")
                          .graph;
  const Eigen::Isometry2d from = motion(1, 2, 0.5) * motion(1.2, -0.3, 0.4);
  const Eigen::Isometry2d to = motion(3, 1, -1.1) * motion(-0.5, 0.1, 2);
  const Eigen::Isometry2d delta = motion(0.7, 0.2, 0.1).inverse() * from.inverse() * to;
  const Eigen::Vector3d error(delta.translation()[0], delta.translation()[1],
                              std::atan2(delta.linear()(1, 0), delta.linear()(0, 0)));
  const Eigen::Matrix3d omega = (Eigen::Matrix3d() << 4, 1, 0.5, 1, 9, 0.25, 0.5, 0.25, 16).finished();
  CHECK(graph.batch(0).chi2(graph.view()) == Approx(error.dot(omega * error)).epsilon(1e-13));
  const Eigen::Isometry2d sensor = motion(3, 1, -1.1) * motion(1.2, -0.3, 0.4);
  const Eigen::Vector2d seen = sensor.inverse() * Eigen::Vector2d(4, 5) - Eigen::Vector2d(0.7, 0.2);
  CHECK(graph.batch(1).chi2(graph.view()) ==
        Approx(seen.dot(omega.topLeftCorner<2, 2>() * seen)).epsilon(1e-13));
}

TEST_CASE("g2o itself: no edge is left whose error it forms without the offset") {
  const GraphDocument document = mixed_document();
  const std::string text = write_for("g2o", document);
  CHECK(text.find("EDGE_SE2_POINTXY_OFFSET") == std::string::npos);
  CHECK(read(text).graph.chi2() == Approx(document.graph.chi2()).epsilon(1e-13));
}

TEST_CASE("foreign graph: Ceres' example has the same chi2 by its own formula") {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  GraphDocument document;
  Graph& graph = document.graph;
  for (int i = 0; i < 6; ++i)
    graph.add_vertex<VertexSe2>(VertexId(i), {unit(random), unit(random), 3 * unit(random)});
  graph.set_fixed(0, true);
  for (int i = 0; i < 5; ++i) {
    // Isotropic positions at any heading, others at quarter turns: these matrices stay diagonal
    // when they are turned.
    const double heading = i % 2 == 0 ? unit(random) : 0.5 * M_PI * i;
    const double other = i % 2 == 0 ? 4 : 25;
    graph.add_edge(EdgeSe2{{unit(random), unit(random), heading}}, {i, i + 1},
                   Eigen::Vector3d(4, other, 100).asDiagonal().toDenseMatrix());
  }
  graph.add_edge(EdgeGnssPosition{{0.3, 0.1}}, {0, 5}, Eigen::Vector2d(4, 9).asDiagonal().toDenseMatrix());
  CHECK(chi2_of_example(write_for("ceres", document)) == Approx(graph.chi2()).epsilon(1e-12));
  // The same numbers unturned, as a g2o file has them, are another problem there.
  CHECK(chi2_of_example(write_as(GraphFormat::g2o, document)) != Approx(graph.chi2()).epsilon(1e-3));
}

TEST_CASE("foreign graph: a profile takes the formats that its reader knows, no other") {
  GraphDocument document;
  document.graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
  const auto make = [&](const char* profile, GraphFormat format) {
    return ForeignGraph(document, "a", *find_profile(profile), format).changes().size();
  };
  CHECK(make("gtsam", GraphFormat::covariance) == 0);
  CHECK_THROWS_AS(make("ceres", GraphFormat::toro), UsageError);
  CHECK(find_profile("isam") == nullptr);
}

TEST_CASE("foreign graph: every format's name is read back") {
  for (const std::string_view name : kGraphFormats) {
    CHECK(to_string(graph_format_from_string(name).value()) == name);
  }
  CHECK_FALSE(graph_format_from_string("gtsam"));
}
