// The edge types that have Jacobians by hand: the same as those of dual numbers.
#include <random>

#include <catch2/catch.hpp>

#include <waymark/core/graph/checks/edge_type_check.hpp>
#include <waymark/plugins/gnss_velocity/gnss_velocity.hpp>
#include <waymark/plugins/heading/heading.hpp>
#include <waymark/plugins/odometry/calibration.hpp>
#include <waymark/plugins/odometry/edge_odometry.hpp>
#include <waymark/plugins/twist/edge_twist.hpp>
#include <waymark/types_se2/edge_gnss.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/g2o_edges.hpp>

#include "support/registry.hpp"

using namespace waymark;

namespace {

/// The edge type E without its Jacobians by hand, so that dual numbers differentiate its error.
template <Edge E>
struct ByDualNumbers : E {
  void linearize() const = delete;  // hides that of E
};

double magnitude(const Eigen::MatrixXd& m) {
  return 1 + m.cwiseAbs().maxCoeff();
}

/// An edge of the type, the same for the same scenario and number.
template <Edge E>
Graph drawn_edge(const TypeRegistry& registry, const EdgeScenario& scenario, unsigned number) {
  std::mt19937_64 random(number);
  return single_edge(registry, make_edge_type<E>(), scenario, random);
}

}  // namespace

TEMPLATE_TEST_CASE("every edge type with Jacobians by hand: they are those of dual numbers", "",  //
                   EdgeSe2, EdgeSe2Log, EdgePriorSe2, EdgeSe2Xy, EdgePriorSe2Xy, EdgePriorXy,
                   EdgeBearingSe2Xy, EdgeSe2PointXyOffset, EdgeGnssPosition,
                   plugins::gnss_velocity::EdgeGnssCourse, plugins::heading::EdgeHeading,
                   plugins::heading::EdgeHeadingOffset, plugins::odometry::EdgeSe2Odometry,
                   plugins::odometry::EdgeSe2Standstill, plugins::odometry::EdgeSe2OdometryCalibrated,
                   plugins::odometry::EdgeSe2OdometryYawCalibrated,
                   plugins::odometry::EdgeSe2OdometryYawScaled, plugins::twist::EdgeSe2Twist) {
  const TypeRegistry registry = waymark_test::full_registry();
  for (const EdgeScenario& scenario : edge_scenarios()) {
    INFO(TestType::kTag << ", " << scenario.name);
    for (unsigned number = 0; number < 50; ++number) {
      const Graph graph = drawn_edge<TestType>(registry, scenario, number);
      const Graph reference = drawn_edge<ByDualNumbers<TestType>>(registry, scenario, number);
      REQUIRE(graph.values() == reference.values());
      Eigen::VectorXd given_error;
      Eigen::VectorXd dual_error;
      std::vector<Eigen::MatrixXd> given;
      std::vector<Eigen::MatrixXd> dual;
      graph.batch(0).linearize_edge(0, graph.view(), given_error, given);
      reference.batch(0).linearize_edge(0, reference.view(), dual_error, dual);
      REQUIRE(given.size() == dual.size());
      CHECK((given_error - dual_error).norm() <=
            1e-12 * magnitude(graph.batch(0).information(0)) * magnitude(dual_error));
      for (std::size_t k = 0; k < given.size(); ++k) {
        CHECK((given[k] - dual[k]).cwiseAbs().maxCoeff() <= 1e-12 * magnitude(dual[k]));
      }
    }
  }
}
