// Marginal covariances against the inverse of the dense H; Gaussian priors against the edges they stand
// for.
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/types_se2/g2o_edges.hpp>

#include "support/dense.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/scalar_types.hpp"

namespace marginals_test {

using namespace waymark;
using namespace waymark_test;

namespace {

void minimise(Graph& graph) {
  REQUIRE(optimize(graph, *registry().make_algorithm("dogleg"), *registry().make_linear_solver("eigen"), {})
              .converged());
}

std::vector<VertexIndex> all_vertices(const Graph& graph) {
  std::vector<VertexIndex> all(graph.vertex_count());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Poses on a grid and landmarks among them, of which only directions are seen.
Graph bearings_alone(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  Graph graph;
  for (int i = 0; i < 30; ++i)
    graph.add_vertex<VertexSe2>(VertexId(i), {1.0 * (i % 6), 1.0 * (i / 6), 3 * unit(random)});
  for (int l = 0; l < 8; ++l) {
    const Eigen::Vector2d place(2.5 + 8 * unit(random), 2 + 8 * unit(random));
    const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId(100 + l), {place[0], place[1]});
    for (VertexIndex i = 0; i < 30; ++i) {
      const auto pose = graph.value(i);
      const Eigen::Vector2d seen =
          rotate(-pose[2], Eigen::Vector2d(place - Eigen::Vector2d(pose[0], pose[1])));
      graph.add_edge(EdgeBearingSe2Xy{std::atan2(seen[1], seen[0])}, {i, landmark},
                     Eigen::Matrix<double, 1, 1>(2500));
    }
  }
  return graph;
}

/// The whole inverse of the dense H in the order of the vertices, zero if a vertex is no
/// unknown.
Eigen::MatrixXd dense_covariance(const Graph& graph) {
  const DenseSystem system = assemble_dense(graph, find_gauge(graph).held);
  const Eigen::MatrixXd inverse = system.hessian.inverse();
  std::vector<Eigen::Index> row;
  for (std::size_t v = 0; v < graph.vertex_count(); ++v) {
    for (int i = 0; i < graph.vertex_type(static_cast<VertexIndex>(v)).tangent_size; ++i)
      row.push_back(system.start[v] < 0 ? -1 : system.start[v] + i);
  }
  const auto n = static_cast<Eigen::Index>(row.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index r = 0; r < n; ++r) {
    for (Eigen::Index c = 0; c < n; ++c) {
      const Eigen::Index i = row[static_cast<std::size_t>(r)];
      const Eigen::Index j = row[static_cast<std::size_t>(c)];
      if (i >= 0 && j >= 0) covariance(r, c) = inverse(i, j);
    }
  }
  return covariance;
}

/// Every block and every pair, whether adjacent or not.
void check_against_inverse(const Graph& graph, double tolerance = 1e-9) {
  const Eigen::MatrixXd expected = dense_covariance(graph);
  const std::vector<VertexIndex> all = all_vertices(graph);
  Marginals marginals(graph);
  const CovarianceBlocks blocks = marginals.blocks(all);
  const Eigen::MatrixXd joint = marginals.joint(all);
  REQUIRE(blocks.size() == all.size());
  CHECK(relative_difference(joint, expected) < tolerance);
  CHECK(joint == joint.transpose());
  Eigen::Index row = 0;
  for (std::size_t v = 0; v < all.size(); ++v) {
    INFO("vertex " << to_string(graph.id(all[v])));
    const int n = graph.vertex_type(all[v]).tangent_size;
    const Eigen::MatrixXd own = expected.block(row, row, n, n);
    CHECK((blocks[v] - own).norm() <= tolerance * own.norm());
    CHECK((joint.block(row, row, n, n) - blocks[v]).norm() <= tolerance * own.norm());
    CHECK(blocks[v] == blocks[v].transpose());
    CHECK(marginals.estimated(all[v]) == !blocks[v].isZero(0));
    row += n;
  }
}

/// Poses of 1 m on the x axis, all headings 0, with exact odometry. Nothing couples x to y and
/// heading.
Graph straight_line(int poses, double sigma_m, double sigma_rad) {
  Graph graph;
  for (int i = 0; i < poses; ++i) {
    graph.add_vertex<VertexSe2>(VertexId(i), {1.0 * i, 0, 0});
    if (i > 0) graph.add_edge(EdgeSe2{{1, 0, 0}}, {i - 1, i}, pose_information(sigma_m, sigma_rad));
  }
  return graph;
}

}  // namespace

TEST_CASE("marginals: a held gauge, loops, every vertex") {
  Graph graph = noisy_circle(40);
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: under minimum degree") {
  Graph graph = grid_walk(150, 8);
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: fixed vertices and vertices without edges have covariance zero") {
  Graph graph = noisy_circle(20);
  graph.set_fixed(3, true);
  graph.set_fixed(11, true);
  graph.add_vertex<VertexSe2>(VertexId{99}, {1, 2, 3});
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: a drive with fixes") {
  Drive drive = make_drive(registry(), 120);
  drive.add_fixes(registry(), "g2");
  minimise(drive.graph);
  check_against_inverse(drive.graph);
}

TEST_CASE("marginals: a dense calibration state and mixed sizes") {
  Graph graph;
  const VertexIndex scale = graph.add_vertex<VertexScale>(VertexId{1000}, {1});
  for (int i = 0; i < 30; ++i) {
    const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId(i), {1.0 * i, 0, 0});
    if (i > 0)
      graph.add_edge(EdgeScaledOdometry{1, 0.1}, {pose - 1, scale, pose}, pose_information(0.1, 0.02));
    if (i % 7 == 0) graph.add_edge(EdgePriorSe2{{0.9 * i, 0.1 * i, 0}}, {pose}, Eigen::Matrix3d::Identity());
  }
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: chains of any length, which are eliminated from both ends") {
  for (const int poses : {1, 2, 3, 63, 64, 65, 66, 129, 300}) {
    INFO(poses << " poses");
    Graph graph = straight_line(poses, 0.05, 0.01);
    graph.add_edge(EdgePriorSe2{{0, 0, 0}}, {poses / 3}, pose_information(0.3, 0.1));
    check_against_inverse(graph, 1e-8);
  }
}

TEST_CASE("marginals: every GNSS modeling") {
  for (const char* modeling : {"g1", "g2", "g3"}) {
    INFO(modeling);
    Drive drive = make_drive(registry(), 210);
    drive.add_fixes(registry(), modeling);
    minimise(drive.graph);
    check_against_inverse(drive.graph, 1e-7);  // stiff identity edges of g2: condition 1e12
  }
}

TEST_CASE("marginals: landmarks, loops and a prior over vertices that are far apart") {
  Graph graph = noisy_circle(60);
  for (int k = 0; k < 6; ++k) {
    const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId(1000 + k), {1.0 * k, 2});
    for (int i = 7 * k; i < 7 * k + 15; ++i) {
      const auto pose = graph.value(i);
      const Pose2<double> body(pose[0], pose[1], pose[2]);
      const Eigen::Vector2d offset = Eigen::Vector2d(1.0 * k, 2) - body.position;
      const Eigen::Vector2d seen = rotate(-body.heading, offset);
      graph.add_edge(EdgeSe2Xy{seen}, {i, landmark}, Eigen::Matrix2d::Identity() * 4);
    }
  }
  const std::array<VertexIndex, 3> apart = {3, 31, 61};
  std::vector<double> fields;
  for (const VertexIndex v : apart) {
    const auto value = graph.value(v);
    fields.insert(fields.end(), value.begin(), value.end());
  }
  fields.resize(16, 0.0);
  Eigen::MatrixXd information = Eigen::MatrixXd::Constant(8, 8, 0.2);
  information.diagonal().array() += 3;
  graph.add_edge(*registry().find_edge("EDGE_GAUSSIAN_PRIOR"), apart, fields, information);
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: a random walk has the covariance of a random walk") {
  // Along the line cov(x_i, x_j) = s0^2 + min(i, j) s^2, for headings cov(a_i, a_j) = q0^2 + min(i,
  // j) q^2. Across it y_j = y_0 + sum (a_i + w_i) over i < j.
  const int n = 90;
  const double s = 0.05;
  const double q = 0.01;
  const double s0 = 0.3;
  const double q0 = 0.1;
  Graph graph = straight_line(n, s, q);
  graph.add_edge(EdgePriorSe2{{0, 0, 0}}, {0}, pose_information(s0, q0));
  const Eigen::MatrixXd joint = Marginals(graph).joint(all_vertices(graph));
  const auto heading = [&](int i, int j) { return q0 * q0 + std::min(i, j) * q * q; };
  for (int i = 0; i < n; i += 11) {
    for (int j = 0; j < n; j += 7) {
      double across = s0 * s0 + std::min(i, j) * s * s;
      for (int k = 0; k < i; ++k) {
        for (int l = 0; l < j; ++l) across += heading(k, l);
      }
      CHECK(joint(3 * i, 3 * j) == Approx(s0 * s0 + std::min(i, j) * s * s).epsilon(1e-9));
      CHECK(joint(3 * i + 1, 3 * j + 1) == Approx(across).epsilon(1e-8));
      CHECK(joint(3 * i + 2, 3 * j + 2) == Approx(heading(i, j)).epsilon(1e-9));
      // Exactly, also if a link or a front couples them by stored zeros.
      CHECK(joint(3 * i, 3 * j + 1) == 0);
      CHECK(joint(3 * i, 3 * j + 2) == 0);
    }
  }
}

TEST_CASE("marginals: what no edge couples has covariance zero exactly") {
  Graph graph = straight_line(100, 0.05, 0.01);
  graph.add_edge(EdgePriorSe2{{50, 0, 0}}, {50}, pose_information(0.3, 0.1));
  SECTION("chain") {}
  SECTION("dense fronts") {
    for (int i = 0; i + 30 < 100; i += 3)
      graph.add_edge(EdgeSe2{{30, 0, 0}}, {i, i + 30}, pose_information(0.2, 0.05));
  }
  const CovarianceBlocks blocks = marginal_covariances(graph, all_vertices(graph));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Eigen::MatrixXd block = blocks[i];
    for (const double zero : {block(0, 1), block(0, 2), block(1, 0), block(2, 0)}) {
      CHECK(zero == 0);
      CHECK_FALSE(std::signbit(zero));
    }
    CHECK(block(1, 2) != 0);
  }
}

TEST_CASE("marginals: components apart and nodes beyond a fixed one have covariance zero with each other") {
  Graph graph = noisy_circle(30);
  for (int i = 0; i < 80; ++i) {  // a second component, not anchored: its first vertex is held
    graph.add_vertex<VertexSe2>(VertexId(100 + i), {0.5 * i, 3, 0.1});
    if (i > 0) graph.add_edge(EdgeSe2{{0.5, 0, 0.01}}, {29 + i, 30 + i}, pose_information(0.05, 0.01));
  }
  minimise(graph);
  check_against_inverse(graph);
  Marginals marginals(graph);
  CHECK(marginals.gauge().messages.size() == 2);
  CHECK(marginals.joint(std::array{7, 60}).topRightCorner(3, 3) == Eigen::Matrix3d::Zero());
  CHECK(marginals.joint(std::array{0, 30}) == Eigen::MatrixXd::Zero(6, 6));  // both are held

  graph.set_fixed(60, true);  // a cut: 30..59 | 60 | 61..109
  check_against_inverse(graph);
  const Eigen::MatrixXd cut = Marginals(graph).joint(std::array{59, 61});
  CHECK(cut.topRightCorner(3, 3) == Eigen::Matrix3d::Zero());
  CHECK_FALSE(cut.topLeftCorner(3, 3).isZero(0));
}

TEST_CASE("marginals: chosen vertices have the bits they have among all, in any order, also twice") {
  Graph graph = grid_walk(150, 8);
  minimise(graph);
  const CovarianceBlocks all = marginal_covariances(graph, all_vertices(graph));
  for (const std::vector<VertexIndex>& chosen :
       {std::vector<VertexIndex>{}, {0}, {149}, {1}, {77, 12, 77, 149, 3, 77}}) {
    const CovarianceBlocks some = marginal_covariances(graph, chosen);
    REQUIRE(some.size() == chosen.size());
    for (std::size_t i = 0; i < chosen.size(); ++i)
      CHECK(some[i] == all[static_cast<std::size_t>(chosen[i])]);
  }
  const Eigen::MatrixXd twice = Marginals(graph).joint(std::array{5, 90, 5});
  CHECK(twice.block(0, 3, 3, 3) == twice.block(6, 3, 3, 3));
}

TEST_CASE("marginals: a graph without unknowns") {
  Graph graph;
  graph.add_vertex<VertexSe2>(VertexId{0}, {1, 2, 3});
  check_against_inverse(graph);
}

TEST_CASE("marginals: robust weights count") {
  Graph graph = noisy_circle(20);
  const LossType* huber = registry().find_loss("huber");
  graph.batch(0).set_loss(Loss{huber->name, huber->evaluate, 1.5});
  minimise(graph);
  check_against_inverse(graph);
}

TEST_CASE("marginals: the curvature of a robust loss counts") {
  // At any values it is the covariance of the Laplace approximation: H = half the second
  // derivative of chi2.
  Graph graph;
  const VertexIndex v = graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
  graph.add_edge(EdgePriorSe2{{0, 0, 0}}, {v}, pose_information(0.5, 0.1));
  const LossType* cauchy = registry().find_loss("cauchy");
  graph.batch(0).set_loss(Loss{cauchy->name, cauchy->evaluate, 2});
  const double x = 0.3;
  const double h = 1e-3;
  const auto chi2_at = [&](double at) {
    graph.set_value(v, std::array{at, 0.0, 0.0});
    return graph.chi2();
  };
  const double second = (chi2_at(x - h) - 2 * chi2_at(x) + chi2_at(x + h)) / (h * h);
  graph.set_value(v, std::array{x, 0.0, 0.0});
  const Eigen::MatrixXd covariance = marginal_covariances(graph, std::array{v})[0];
  CHECK(covariance(0, 0) == Approx(2 / second).epsilon(1e-5));
  // Across e there is the weight alone, 1 / (1 + s / scale^2).
  CHECK(covariance(1, 1) == Approx(0.25 * (1 + 0.36 / 4)).epsilon(1e-12));
}

TEST_CASE("marginals: one prior gives its own covariance") {
  // With measured heading a, e_t = R(a)^T (p - z): the covariance in frame axes is R S R^T.
  Graph graph;
  const VertexIndex v = graph.add_vertex<VertexSe2>(VertexId{0}, {1, 2, 0.6});
  graph.add_edge(EdgePriorSe2{{1, 2, 0.6}}, {v}, Eigen::Vector3d(1 / 0.04, 1 / 0.25, 100).asDiagonal());
  Eigen::Matrix3d rotation;
  rotation << std::cos(0.6), -std::sin(0.6), 0, std::sin(0.6), std::cos(0.6), 0, 0, 0, 1;
  const Eigen::Matrix3d expected =
      rotation * Eigen::Matrix3d(Eigen::Vector3d(0.04, 0.25, 0.01).asDiagonal()) * rotation.transpose();
  CHECK(relative_difference(marginal_covariances(graph, std::array{v})[0], expected) < 1e-14);
}

TEST_CASE("marginals: what is not determined is an error") {
  Graph graph;
  const VertexIndex v = graph.add_vertex<VertexScale>(VertexId{0}, {1});
  graph.add_edge(EdgeSigmoid{}, {v}, Eigen::Matrix<double, 1, 1>::Zero());
  CHECK_THROWS_AS(marginal_covariances(graph, std::array{v}), InputError);
}

TEST_CASE("marginals: the scale that bearings leave open is an error, whichever way its pivot is rounded") {
  // Bearings alone determine all but the place, the heading and the scale; the gauge holds the first two.
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Graph graph = bearings_alone(seed);
    INFO("seed " << seed);
    CHECK_THROWS_WITH(Marginals(graph),
                      Catch::Contains("the scale of ") && Catch::Contains(" vertices is not determined"));
  }
}

TEST_CASE("marginals: a faint prior or a long chain is weak, and no error") {
  // The only prior gives its own covariance, however sure the edges are (sigmas of 1 cm and 1 mrad beside 10 km).
  Graph graph = grid_walk(300, 20);
  constexpr VertexIndex kKnown = 150;
  const auto value = graph.value(kKnown);
  graph.add_edge(EdgePriorSe2{{value[0], value[1], value[2]}}, {kKnown}, 1e-8 * Eigen::Matrix3d::Identity());
  const std::array<VertexIndex, 1> known{kKnown};
  CHECK(marginal_covariances(graph, known)[0](0, 0) == Approx(1e8).epsilon(0.1));

  // A turn of s at each link moves the last pose by all links beyond it: s^2 (1 + 4 + ... + (k - 1)^2) across the
  // chain, beside k p^2 of its own.
  constexpr int kPoses = 20'000;
  const Graph chain = straight_line(kPoses, 0.1, 0.03);
  const std::array<VertexIndex, 1> last{kPoses - 1};
  const double steps = kPoses - 1;
  const double squares = (steps - 1) * steps * (2 * steps - 1) / 6;
  CHECK(marginal_covariances(chain, last)[0](1, 1) == Approx(steps * 0.01 + 9e-4 * squares).epsilon(0.05));
}

TEST_CASE("Gaussian prior: equals the pose prior with its information turned into frame axes") {
  const double a = 0.6;
  Graph by_pose = noisy_circle(20);
  Graph by_gaussian = by_pose;
  Eigen::Matrix3d omega;
  omega << 30, 5, 2, 5, 20, -3, 2, -3, 60;
  Eigen::Matrix3d rotation;
  rotation << std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1;
  by_pose.add_edge(EdgePriorSe2{{4, 5, a}}, {7}, omega);
  by_gaussian.add_edge(*registry().find_edge("EDGE_GAUSSIAN_PRIOR"), std::array<VertexIndex, 1>{7},
                       std::array<double, 6>{4, 5, a, 0, 0, 0}, rotation * omega * rotation.transpose());
  CHECK(by_gaussian.chi2() == Approx(by_pose.chi2()).epsilon(1e-12));
  minimise(by_pose);
  minimise(by_gaussian);
  CHECK(by_gaussian.chi2() == Approx(by_pose.chi2()).epsilon(1e-9));
  for (std::size_t i = 0; i < by_pose.values().size(); ++i)
    CHECK(by_gaussian.values()[i] == Approx(by_pose.values()[i]).margin(1e-6));
  CHECK(relative_difference(marginal_covariances(by_gaussian, std::array<VertexIndex, 1>{15})[0],
                            marginal_covariances(by_pose, std::array<VertexIndex, 1>{15})[0]) < 1e-6);
}

TEST_CASE("Gaussian prior: left by marginalisation, it gives the rest of the graph the same step") {
  // Eliminate pose 0 of a chain 0-1-2-3 with a prior on 0: S = H_bb - H_ba H_aa^-1 H_ab on pose 1,
  // and offset d = -S^-1 (g_b - H_ba H_aa^-1 g_a).
  Graph whole;
  for (int i = 0; i < 4; ++i) whole.add_vertex<VertexSe2>(VertexId(i), {1.1 * i, 0.1 * i * i, 0.2 * i});
  whole.add_edge(EdgePriorSe2{{0.3, 0.1, 0.05}}, {0}, pose_information(0.3, 0.1));
  Graph rest;
  for (int i = 1; i < 4; ++i) {
    const auto value = whole.value(i);
    rest.add_vertex<VertexSe2>(VertexId(i), {value[0], value[1], value[2]});
    whole.add_edge(EdgeSe2Log{{1, 0.1, 0.15}}, {i - 1, i}, pose_information(0.05, 0.02));
    if (i > 1) rest.add_edge(EdgeSe2Log{{1, 0.1, 0.15}}, {i - 2, i - 1}, pose_information(0.05, 0.02));
  }
  Graph head;  // the marginalised part: the prior and the edge 0-1
  for (int i = 0; i < 2; ++i) {
    const auto value = whole.value(i);
    head.add_vertex<VertexSe2>(VertexId(i), {value[0], value[1], value[2]});
  }
  head.add_edge(EdgePriorSe2{{0.3, 0.1, 0.05}}, {0}, pose_information(0.3, 0.1));
  head.add_edge(EdgeSe2Log{{1, 0.1, 0.15}}, {0, 1}, pose_information(0.05, 0.02));
  const DenseSystem h = assemble_dense(head, std::vector<char>(2, 0));
  const Eigen::Matrix3d gain =
      h.hessian.bottomLeftCorner<3, 3>() * h.hessian.topLeftCorner<3, 3>().inverse().eval();
  Eigen::Matrix3d schur = h.hessian.bottomRightCorner<3, 3>() - gain * h.hessian.topRightCorner<3, 3>();
  schur = Eigen::Matrix3d(0.5 * (schur + schur.transpose()));
  const Eigen::Vector3d d = -schur.ldlt().solve(h.gradient.tail<3>() - gain * h.gradient.head<3>());
  const auto reference = whole.value(1);
  const std::array<double, 6> fields = {reference[0], reference[1], reference[2], d[0], d[1], d[2]};
  rest.add_edge(*registry().find_edge("EDGE_GAUSSIAN_PRIOR"), std::array<VertexIndex, 1>{0}, fields, schur);

  const DenseSystem all = assemble_dense(whole, std::vector<char>(4, 0));
  const DenseSystem kept = assemble_dense(rest, std::vector<char>(3, 0));
  const Eigen::VectorXd step = -all.hessian.ldlt().solve(all.gradient);
  const Eigen::VectorXd kept_step = -kept.hessian.ldlt().solve(kept.gradient);
  CHECK(relative_difference(kept_step, step.tail<9>()) < 1e-9);
}

}  // namespace marginals_test
