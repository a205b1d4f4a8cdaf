// The three GNSS modelings share one minimum under the decoupled error; the paper's literal error
// differs by the factor (theta/2) / sin(theta/2).
#include <array>
#include <cmath>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/types_se2/edge_se2.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

namespace modelings_test {

using namespace waymark;
using namespace waymark_test;
using Catch::Contains;

namespace {

constexpr int kPoses = 1500;
const Eigen::Vector2d kAntenna(1.2, -0.4);

/// The optimum of a modeling: chi2 with the poses of the drive.
struct Optimum {
  double chi2 = 0;
  std::vector<double> poses;
};

Optimum solve(Drive drive, std::string_view modeling, const Options& options = {}) {
  drive.add_fixes(registry(), modeling, options);
  OptimizerOptions tight;
  tight.decrement_tolerance = 1e-15;
  const Summary summary = optimize(drive.graph, *registry().make_algorithm("dogleg"),
                                   *registry().make_linear_solver("eigen"), tight);
  INFO(modeling << ": " << summary.message);
  REQUIRE((summary.converged() || summary.records.back().newton_decrement < 1e-12 * summary.final_chi2));
  const auto& values = drive.graph.values();
  return {summary.final_chi2, std::vector<double>(values.begin(), values.begin() + 3 * kPoses)};
}

void check_same(const Optimum& a, const Optimum& b, double pose_margin) {
  CHECK(a.chi2 == Approx(b.chi2).epsilon(1e-9));
  for (std::size_t i = 0; i < a.poses.size(); ++i)
    REQUIRE(a.poses[i] == Approx(b.poses[i]).margin(pose_margin));
}

}  // namespace

TEST_CASE("modelings: G3 is G1, with and without an antenna's lever arm") {
  for (const Eigen::Vector2d& antenna : {Eigen::Vector2d(0, 0), kAntenna}) {
    const Drive drive = make_drive(registry(), kPoses, antenna);
    check_same(solve(drive, "g3"), solve(drive, "g1"), 1e-9);
  }
}

TEST_CASE("modelings: G2 is G1 under the covariance of the fix plus that of the identity edge") {
  const Drive drive = make_drive(registry(), kPoses);
  for (const double identity : {100.0, 1e4, 1e6}) {
    INFO("W = " << identity);
    Drive effective = drive;
    for (Fix& fix : effective.fixes) fix.covariance += Eigen::Matrix2d::Identity() / identity;
    check_same(solve(drive, "g2", {{"identity_information", std::to_string(identity)}}),
               solve(effective, "g1"), 1e-6);
  }
}

TEST_CASE("modelings: with a lever arm the heading of G2's nodes gives way by 1/W, too") {
  // The node's heading turns the arm a: its slack of 1/W rad^2 adds |a|^2 / W across the arm, so
  // the equality above holds to the order of |a|^2 / (W sigma^2) only.
  const Drive drive = make_drive(registry(), kPoses, kAntenna);
  Drive effective = drive;
  for (Fix& fix : effective.fixes) fix.covariance += 1e-6 * Eigen::Matrix2d::Identity();
  const Optimum g2 = solve(drive, "g2");
  const Optimum g1 = solve(effective, "g1");
  CHECK(g2.chi2 <= g1.chi2);
  CHECK(g2.chi2 == Approx(g1.chi2).epsilon(2 * kAntenna.squaredNorm() * 1e-6));
}

TEST_CASE("modelings: the fixes pull the drive towards the truth") {
  const Drive drive = make_drive(registry(), kPoses);
  const Optimum optimum = solve(drive, "g1");
  // 2 numbers per fix against as good as 3 for the start: chi2 is near 2 (fixes) by statistics,
  // sigma 2 sqrt(n).
  const double fixes = static_cast<double>(drive.fixes.size());
  CHECK(optimum.chi2 < 2 * fixes + 5 * 2 * std::sqrt(fixes));
}

TEST_CASE("modelings: the vertices they add are fixed where the paper says so") {
  const auto count = [](std::string_view modeling) {
    Drive drive = make_drive(registry(), 100);
    drive.add_fixes(registry(), modeling);
    int fixed = 0;
    for (VertexIndex v = 0; v < static_cast<VertexIndex>(drive.graph.vertex_count()); ++v) {
      fixed += drive.graph.fixed(v) ? 1 : 0;
    }
    return std::pair(static_cast<int>(drive.graph.vertex_count()) - 100, fixed);
  };
  CHECK(count("g1") == std::pair(1, 1));  // the origin
  CHECK(count("g2") == std::pair(5, 1));  // the origin and a free node per fix
  CHECK(count("g3") == std::pair(4, 4));  // a fixed node per fix
}

TEST_CASE("literal error: the offset grows by half the heading over its sine and turns by minus half of it") {
  // Log of (d, theta): V^-1(theta) d = (theta/2) / sin(theta/2) R(-theta/2) d.
  const Eigen::Vector2d d(0.8, -1.7);
  for (const double theta : {-3.1, -2.0, -0.5, 0.01, 0.5, 1.5, 3.0, 3.14159}) {
    INFO(theta);
    const EdgeSe2Log literal{{10, 20, 0}};
    const Eigen::Vector3d e = literal.error(Pose2<double>(), Pose2<double>(10 + d[0], 20 + d[1], theta));
    const double scale = 0.5 * theta / std::sin(0.5 * theta);
    const Eigen::Vector2d expected = scale * rotate(-0.5 * theta, d);
    CHECK((e.head<2>() - expected).norm() < 1e-12);
    const EdgeGnssPosition decoupled{{10, 20}, {0, 0}};
    const Eigen::Vector2d plain =
        decoupled.error(Pose2<double>(), Pose2<double>(10 + d[0], 20 + d[1], theta));
    CHECK((plain - d).norm() < 1e-14);
  }
}

TEST_CASE("literal error: offered by all three, larger than the decoupled one, refused with a lever arm") {
  const Drive drive = make_drive(registry(), 500);
  for (const char* modeling : {"g1", "g2", "g3"}) {
    INFO(modeling);
    Drive literal = drive;
    literal.add_fixes(registry(), modeling, {{"error", "literal"}});
    Drive decoupled = drive;
    decoupled.add_fixes(registry(), modeling);
    // G2's nodes start on their fixes: there both are zero.
    if (std::string_view(modeling) != "g2") CHECK(literal.graph.chi2() != decoupled.graph.chi2());
    Drive lever = make_drive(registry(), 100, kAntenna);
    CHECK_THROWS_WITH(lever.add_fixes(registry(), modeling, {{"error", "literal"}}),
                      Contains(modeling) && Contains("lever arm") && Contains("decoupled"));
  }
}

TEST_CASE("modelings: wrong options and fixes without a pose are explained") {
  CHECK_THROWS_WITH(registry().make_gnss_modeling("g9"),
                    Contains("unknown") && Contains("g1") && Contains("g3"));
  CHECK_THROWS_WITH(registry().make_gnss_modeling("g1", {{"identity_information", "5"}}),
                    Contains("g1: unknown option 'identity_information'"));
  CHECK_THROWS_WITH(registry().make_gnss_modeling("g2", {{"identity_information", "0"}}),
                    Contains("must lie in"));
  CHECK_THROWS_WITH(registry().make_gnss_modeling("g3", {{"error", "wrong"}}),
                    Contains("'decoupled' or 'literal'") && Contains("got 'wrong'"));
  Drive drive = make_drive(registry(), 100);
  drive.fixes[1].vertex = VertexId{4711};
  CHECK_THROWS_WITH(drive.add_fixes(registry(), "g1"), Contains("belongs to no pose of the graph"));
}

TEST_CASE("odometry model: a standing vehicle's measurement is the identity whatever the gyro says") {
  Graph graph;
  const std::array<VertexIndex, 2> poses = {graph.add_vertex<VertexSe2>(VertexId{0}, {1, 2, 3}),
                                            graph.add_vertex<VertexSe2>(VertexId{1}, {1, 2, 3})};
  const Interval standing{0.02, 0.006, 0.04, false};
  registry()
      .make_odometry_model("constant_twist")
      ->extend({{std::array{Stamp{0}, Stamp{40'000'000}}, poses, std::array{standing}}}, graph);
  REQUIRE(graph.batch_count() == 1);
  CHECK(graph.edge_type(0).tag == "EDGE_SE2_STANDSTILL");
  CHECK(graph.chi2() == 0);
  CHECK(graph.batch(0).information(0).diagonal().minCoeff() >= 1e5);
}

TEST_CASE("odometry model: a vehicle that turns on the spot does not stand") {
  Graph graph;
  const std::array<VertexIndex, 2> poses = {graph.add_vertex<VertexSe2>(VertexId{0}, {1, 2, 3}),
                                            graph.add_vertex<VertexSe2>(VertexId{1}, {1, 2, 3.01})};
  const Interval turning{0, 0.25, 0.04, false};
  registry()
      .make_odometry_model("constant_twist")
      ->extend({{std::array{Stamp{0}, Stamp{40'000'000}}, poses, std::array{turning}}}, graph);
  CHECK(graph.edge_type(0).tag == "EDGE_SE2_ODOMETRY");
  CHECK(graph.chi2() == Approx(0).margin(1e-12));  // 0.25 rad/s for 0.04 s
}

}  // namespace modelings_test
