// Options of the modeling `correlated`: the tails of the white part.
#include <cmath>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/drive/modeling.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

#include "support/registry.hpp"

namespace gnss_correlated_test {

using namespace waymark;
using Catch::Contains;

namespace {

/// The edge of one fix with a claimed sigma of 2 m.
struct BuiltFix {
  Eigen::MatrixXd information;
  const Loss* loss = nullptr;
};

Graph graph_with(const Options& options, const std::optional<Loss>& loss = std::nullopt) {
  const TypeRegistry registry = waymark_test::full_registry();
  Graph graph;
  const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{1}, {0, 0, 0});
  graph.set_stamp(pose, Stamp::from_seconds(1));
  Fix fix;
  fix.stamp = Stamp::from_seconds(1);
  fix.vertex = VertexId{1};
  fix.covariance = 4 * Eigen::Matrix2d::Identity();
  const std::vector<Fix> fixes{fix};
  const std::vector<FixMoment> moments(1);
  registry.make_gnss_modeling("correlated", options)->extend({fixes, moments, {0, 0}, loss}, graph);
  return graph;
}

BuiltFix fix_of(const Graph& graph) {
  for (std::size_t b = 0; b < graph.batch_count(); ++b) {
    if (graph.edge_type(b).tag == "EDGE_GNSS_POSITION_CORRELATED")
      return {graph.batch(b).information(0), graph.batch(b).loss(0)};
  }
  throw std::runtime_error("no fix");
}

}  // namespace

TEST_CASE("correlated: tails are Student's t, or normal") {
  const Options sigma = {{"white_sigma", "2"}};
  Options normal = sigma;
  normal["tails"] = "normal";
  const Graph students = graph_with(sigma);
  const Graph plain = graph_with(normal);
  const BuiltFix student = fix_of(students);
  const BuiltFix gauss = fix_of(plain);
  // The claimed accuracy is the median: the white sigma is 2 m.
  CHECK(gauss.information.isApprox(Eigen::Matrix2d::Identity() / 4));
  CHECK(gauss.loss == nullptr);
  // -2 log of the density of Student's t with four degrees of freedom in the plane: 6 log(1 + q /
  // 4).
  REQUIRE(student.loss != nullptr);
  for (const double metres : {0.0, 0.5, 2.0, 10.0, 100.0}) {
    const double q = metres * metres / 4;
    const double squared = student.information(0, 0) * metres * metres;
    CHECK(student.loss->at(squared).rho == Approx(6 * std::log1p(q / 4)));
  }
  CHECK_THROWS_WITH(graph_with({{"tails", "cauchy"}}),
                    Contains("tails") && Contains("student") && Contains("normal"));
}

TEST_CASE("correlated: a loss that is asked for replaces that of the tails") {
  const LossType huber = builtin_losses().front();
  for (const char* tails : {"student", "normal"}) {
    const Graph graph = graph_with({{"tails", tails}}, Loss{huber.name, huber.evaluate, 1.5});
    REQUIRE(fix_of(graph).loss != nullptr);
    CHECK(*fix_of(graph).loss == Loss{huber.name, huber.evaluate, 1.5});
  }
}

}  // namespace gnss_correlated_test
