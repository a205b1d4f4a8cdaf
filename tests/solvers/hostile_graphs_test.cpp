// Graphs that no measurement makes, but a file can hold: a right answer, or a refusal that names the edge or
// the vertex. Chi2 and gradient are computed here a second time, without the library.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/core/base/angle.hpp>
#include <waymark/core/base/error.hpp>
#include <waymark/solvers/optimize.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/g2o_edges.hpp>

namespace hostile_graphs_test {

using namespace waymark;
using std::numbers::pi;

namespace {

using Pose = std::array<double, 3>;

struct Link {
  int from = 0;
  int to = 0;
  Pose measured{};
  double sigma_m = 0.05;
  double sigma_rad = 0.01;
  double information_m() const { return 1 / (sigma_m * sigma_m); }
  double information_rad() const { return 1 / (sigma_rad * sigma_rad); }
};

struct Problem {
  std::vector<Pose> poses;
  std::vector<Link> links;
  std::vector<int> fixed{0};
};

Graph graph_of(const Problem& problem) {
  Graph graph;
  int id = 0;
  for (const Pose& pose : problem.poses) graph.add_vertex<VertexSe2>(VertexId(id++), pose);
  for (const int v : problem.fixed) graph.set_fixed(v, true);
  for (const Link& link : problem.links)
    graph.add_edge(
        EdgeSe2{Eigen::Vector3d(link.measured.data())}, {link.from, link.to},
        Eigen::Matrix3d(Eigen::Vector3d(link.information_m(), link.information_m(), link.information_rad())
                            .asDiagonal()));
  return graph;
}

/// Chi2, and the sum of g_k^2 / H_kk over all free unknowns: twice what a minimum along single unknowns still gains.
struct Judged {
  double chi2 = 0;
  double scaled_gradient = 0;
};

Judged judge(const Problem& problem, const Graph& graph) {
  std::vector<std::array<long double, 3>> gradient(problem.poses.size(), {0, 0, 0});
  std::vector<std::array<long double, 3>> curvature(problem.poses.size(), {0, 0, 0});
  long double chi2 = 0;
  for (const Link& link : problem.links) {
    const auto a = graph.value(link.from);
    const auto b = graph.value(link.to);
    const Pose& z = link.measured;
    const long double x = b[0] - a[0];
    const long double y = b[1] - a[1];
    // R_a^T (p_b - p_a), its derivative by the heading of a, and the difference in the axes of the measurement
    const long double forward = std::cos(a[2]) * x + std::sin(a[2]) * y;
    const long double sideward = -std::sin(a[2]) * x + std::cos(a[2]) * y;
    const long double c = std::cos(z[2]);
    const long double s = std::sin(z[2]);
    const long double e0 = c * (forward - z[0]) + s * (sideward - z[1]);
    const long double e1 = -s * (forward - z[0]) + c * (sideward - z[1]);
    const long double e2 = wrap_angle(wrap_angle(b[2] - a[2]) - z[2]);
    const long double wm = link.information_m();
    const long double wr = link.information_rad();
    chi2 += wm * (e0 * e0 + e1 * e1) + wr * e2 * e2;
    const long double ca = std::cos(a[2] + z[2]);
    const long double sa = std::sin(a[2] + z[2]);
    const std::array<long double, 3> of_b = {wm * (ca * e0 - sa * e1), wm * (sa * e0 + ca * e1), wr * e2};
    const long double d0 = c * sideward - s * forward;
    const long double d1 = -s * sideward - c * forward;
    const std::array<long double, 3> of_a = {-of_b[0], -of_b[1], wm * (d0 * e0 + d1 * e1) - of_b[2]};
    for (std::size_t k = 0; k < 3; ++k) {
      gradient[static_cast<std::size_t>(link.from)][k] += of_a[k];
      gradient[static_cast<std::size_t>(link.to)][k] += of_b[k];
      const long double turned = k == 2 ? wr : wm;
      curvature[static_cast<std::size_t>(link.to)][k] += turned;
      curvature[static_cast<std::size_t>(link.from)][k] +=
          k == 2 ? turned + wm * (d0 * d0 + d1 * d1) : turned;
    }
  }
  Judged judged{static_cast<double>(chi2), 0};
  for (std::size_t v = 0; v < problem.poses.size(); ++v) {
    if (graph.fixed(static_cast<VertexIndex>(v))) continue;
    for (std::size_t k = 0; k < 3; ++k)
      if (curvature[v][k] > 0)
        judged.scaled_gradient += static_cast<double>(gradient[v][k] * gradient[v][k] / curvature[v][k]);
  }
  return judged;
}

/// Optimises; the result must be a minimum by the independent gradient, with the chi2 that the library tells.
Judged check_minimum(const Problem& problem, Graph& graph) {
  const MultiStartSummary result = optimize(graph);
  INFO(result.summary.message);
  CHECK(result.converged());
  const Judged judged = judge(problem, graph);
  CHECK(judged.chi2 == Approx(result.summary.final_chi2).epsilon(1e-6).margin(1e-9));
  CHECK(judged.scaled_gradient <= 1e-6 * (1 + judged.chi2));
  return judged;
}

Pose relative(const Pose& a, const Pose& b) {
  const double x = b[0] - a[0];
  const double y = b[1] - a[1];
  return {std::cos(a[2]) * x + std::sin(a[2]) * y, -std::sin(a[2]) * x + std::cos(a[2]) * y,
          wrap_angle(b[2] - a[2])};
}

Pose composed(const Pose& a, const Pose& z) {
  return {a[0] + std::cos(a[2]) * z[0] - std::sin(a[2]) * z[1],
          a[1] + std::sin(a[2]) * z[0] + std::cos(a[2]) * z[1], wrap_angle(a[2] + z[2])};
}

/// A noisy loop of n steps of 1 m, with a poor initial guess. @param x, y of its centre
Problem loop(int n, double x, double y, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> unit;
  const double radius = n / (2 * pi);
  std::vector<Pose> truth;
  for (int i = 0; i < n; ++i)
    truth.push_back({x + radius * std::cos(2 * pi * i / n), y + radius * std::sin(2 * pi * i / n),
                     wrap_angle(2 * pi * i / n + pi / 2)});
  Problem problem;
  for (int i = 0; i < n; ++i) {
    const Pose& a = truth[static_cast<std::size_t>(i)];
    const Pose z = relative(a, truth[static_cast<std::size_t>((i + 1) % n)]);
    Link link{i, (i + 1) % n, {}};
    link.measured = {z[0] + link.sigma_m * unit(random), z[1] + link.sigma_m * unit(random),
                     z[2] + link.sigma_rad * unit(random)};
    problem.links.push_back(link);
    problem.poses.push_back(
        {a[0] + 0.3 * unit(random), a[1] + 0.3 * unit(random), wrap_angle(a[2] + 0.05 * unit(random))});
  }
  problem.poses.front() = truth.front();
  return problem;
}

void check_near(std::span<const double> value, const Pose& expected, double margin) {
  CHECK(value[0] == Approx(expected[0]).margin(margin));
  CHECK(value[1] == Approx(expected[1]).margin(margin));
  CHECK(wrap_angle(value[2] - expected[2]) == Approx(0).margin(margin));
}

}  // namespace

TEST_CASE("hostile graphs: a graph far from the origin has the minimum that it has there") {
  const Problem near = loop(100, 0, 0);
  Graph at_origin = graph_of(near);
  const double chi2 = check_minimum(near, at_origin).chi2;
  for (const double offset : {1e6, 1e7, 1e8, 1e9}) {
    INFO(offset);
    const Problem far = loop(100, offset, -offset);
    Graph graph = graph_of(far);
    // One part in 2^53 of 1e9 m is 1e-7 m, a 400,000th of the sigma.
    CHECK(check_minimum(far, graph).chi2 == Approx(chi2).epsilon(1e-5));
    const auto last = static_cast<VertexIndex>(99);
    check_near(
        graph.value(last),
        {at_origin.value(last)[0] + offset, at_origin.value(last)[1] - offset, at_origin.value(last)[2]},
        1e-4);
  }
}

TEST_CASE("hostile graphs: sigmas of 1e-6 and 1e6 in one tree: every pose is where its edge puts it") {
  for (const double loose : {1.0, 1e4, 1e6}) {
    for (const int loose_turn : {0, 1}) {
      INFO(loose << ", turns of " << loose);
      Problem problem{{{3, -2, 0.5}}, {}};
      std::vector<Pose> expected = problem.poses;
      for (int i = 1; i < 60; ++i) {
        const double sigma = i % 2 == 0 ? 1e-6 : loose;
        problem.links.push_back({i - 1, i, {1, 0.1 * (i % 3), 0.3}, sigma, loose_turn == 1 ? sigma : 1e-3});
        expected.push_back(composed(expected.back(), problem.links.back().measured));
        problem.poses.push_back({0, 0, 0});
      }
      Graph graph = graph_of(problem);
      check_minimum(problem, graph);
      // A decrement of 1e-6 allows a thousandth of the loose sigma.
      for (std::size_t k = 0; k < expected.size(); ++k)
        check_near(graph.value(static_cast<VertexIndex>(k)), expected[k], 1e-5);
    }
  }
}

TEST_CASE("hostile graphs: sigmas of 1e-6 and 1e6 in one loop: a minimum, or a vertex is named") {
  Problem problem = loop(100, 0, 0);
  for (Link& link : problem.links) link.sigma_m = link.sigma_rad = link.from % 2 == 0 ? 1e-6 : 1e6;
  Graph graph = graph_of(problem);
  const MultiStartSummary result = optimize(graph);
  INFO(result.summary.message);
  const Judged judged = judge(problem, graph);
  if (result.converged()) {
    CHECK(judged.scaled_gradient <= 1e-6 * (1 + judged.chi2));
  } else {
    CHECK_THAT(result.summary.message,
               Catch::Contains("not positive definite; the weakest unknown belongs to VERTEX_SE2"));
  }
  CHECK(std::isfinite(judged.chi2));
}

TEST_CASE("hostile graphs: a minimum that is not the only one is said, with a vertex that moves freely") {
  // Nothing tells the heading of 2, and 4 turns about it: both have information on every unknown. The
  // smallest number on the diagonal is that of 3.
  Graph graph;
  std::array<VertexIndex, 5> v{};
  for (int i = 0; i < 5; ++i)
    v[static_cast<std::size_t>(i)] = graph.add_vertex<VertexSe2>(VertexId{i}, {0, 0, 0});
  graph.set_fixed(v[0], true);
  graph.add_edge(EdgeSe2{}, {v[0], v[1]}, Eigen::Matrix3d::Identity());
  graph.add_edge(EdgeSe2{}, {v[1], v[2]}, Eigen::Vector3d(1, 1, 0).asDiagonal());
  graph.add_edge(EdgeSe2{}, {v[2], v[4]}, 100 * Eigen::Matrix3d::Identity());
  graph.add_edge(EdgeSe2{}, {v[0], v[3]}, 0.1 * Eigen::Matrix3d::Identity());
  graph.set_value(v[4], std::array{0.1, 0.0, 0.0});
  const MultiStartSummary result = optimize(graph);
  INFO(result.summary.message);
  CHECK(result.converged());
  REQUIRE_FALSE(result.summary.notes.empty());
  const std::string& note = result.summary.notes.back();
  CHECK_THAT(note, Catch::StartsWith("the minimum is not the only one"));
  CHECK_THAT(note, Catch::Contains("VERTEX_SE2 2 ") || Catch::Contains("VERTEX_SE2 4 "));
}

TEST_CASE("hostile graphs: a scale that no edge tells is said, with every algorithm") {
  // Directions from poses to landmarks, and nothing else: every similar figure has the same chi2.
  for (const char* algorithm : {"dogleg", "levenberg_marquardt", "gauss_newton"}) {
    for (unsigned seed = 0; seed < 5; ++seed) {
      std::mt19937 random(seed);
      std::normal_distribution<double> normal(0, 1);
      Graph graph;
      for (int i = 0; i < 20; ++i)
        graph.add_vertex<VertexSe2>(VertexId(i), {1.0 * (i % 5), 1.0 * (i / 5), normal(random)});
      for (int l = 0; l < 8; ++l) {
        const Eigen::Vector2d place(2 + 8 * normal(random), 2 + 8 * normal(random));
        const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId(100 + l), {place[0], place[1]});
        for (VertexIndex i = 0; i < 20; ++i) {
          const auto pose = graph.value(i);
          const double direction = std::atan2(place[1] - pose[1], place[0] - pose[0]) - pose[2];
          graph.add_edge(EdgeBearingSe2Xy{wrap_angle(direction + 0.01 * normal(random))}, {i, landmark},
                         Eigen::Matrix<double, 1, 1>(1e4));
        }
      }
      const MultiStartSummary result = optimize(graph, Optimization{.algorithm = algorithm});
      INFO(algorithm << ", seed " << seed << ": " << result.summary.message);
      std::string said = result.summary.message;
      for (const std::string& note : result.summary.notes) said += "\n" + note;
      CHECK_THAT(said, Catch::Contains("the scale of ") && Catch::Contains("vertices is not determined"));
      if (result.converged()) CHECK_THAT(said, Catch::Contains("the minimum is not the only one"));
    }
  }
}

TEST_CASE("hostile graphs: a star of 100,000 edges, its hub fixed or free") {
  for (const int held : {0, 1}) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> angle(-pi, pi);
    std::uniform_real_distribution<double> distance(1, 100);
    Problem problem{{{0, 0, 0}}, {}, {held}};
    for (int i = 1; i <= 100'000; ++i) {
      const double a = angle(random);
      const double d = distance(random);
      problem.links.push_back({0, i, {d * std::cos(a), d * std::sin(a), 0}, 0.1, 0.1});
      problem.poses.push_back({d * std::cos(a) + 1, d * std::sin(a), 0.3});
    }
    Graph graph = graph_of(problem);
    CHECK(check_minimum(problem, graph).chi2 < 1e-6);
    const auto hub = graph.value(0);
    for (const int leaf : {1, 777, 100'000})
      check_near(
          graph.value(leaf),
          composed({hub[0], hub[1], hub[2]}, problem.links[static_cast<std::size_t>(leaf - 1)].measured),
          1e-4);
  }
}

TEST_CASE("hostile graphs: every pose is joined to every other one") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> unit;
  std::uniform_real_distribution<double> place(0, 50);
  std::vector<Pose> truth;
  Problem problem;
  for (int i = 0; i < 100; ++i) {
    truth.push_back({place(random), place(random), wrap_angle(place(random))});
    problem.poses.push_back({truth.back()[0] + unit(random), truth.back()[1] + unit(random),
                             wrap_angle(truth.back()[2] + 0.1 * unit(random))});
    for (int j = 0; j < i; ++j) {
      const Pose z = relative(truth[static_cast<std::size_t>(j)], truth.back());
      problem.links.push_back(
          {j,
           i,
           {z[0] + 0.1 * unit(random), z[1] + 0.1 * unit(random), z[2] + 0.02 * unit(random)},
           0.1,
           0.02});
    }
  }
  problem.poses.front() = truth.front();
  Graph graph = graph_of(problem);
  const double chi2 = check_minimum(problem, graph).chi2;
  // chi2 with 3 (4950 - 99) degrees of freedom: mean 14553, standard deviation 171
  CHECK(chi2 == Approx(14553).margin(5 * 171));
}

TEST_CASE("hostile graphs: edges that stand fifty times move nothing and count fifty times") {
  const Problem once = loop(50, 0, 0);
  Problem repeated = once;
  for (int k = 1; k < 50; ++k)
    repeated.links.insert(repeated.links.end(), once.links.begin(), once.links.end());
  Graph a = graph_of(once);
  Graph b = graph_of(repeated);
  const double chi2 = check_minimum(once, a).chi2;
  CHECK(check_minimum(repeated, b).chi2 == Approx(50 * chi2).epsilon(1e-5));
  for (VertexIndex v = 0; v < 50; ++v)
    check_near(b.value(v), {a.value(v)[0], a.value(v)[1], a.value(v)[2]}, 1e-3);
}

TEST_CASE("hostile graphs: a hundred parts have the sum of their minima, whether they are fixed or not") {
  double sum = 0;
  Problem all{{}, {}, {}};
  for (int part = 0; part < 100; ++part) {
    const Problem one = loop(10, 1000.0 * part, 0, static_cast<unsigned>(part + 1));
    Graph alone = graph_of(one);
    sum += check_minimum(one, alone).chi2;
    for (Link link : one.links) {
      link.from += 10 * part;
      link.to += 10 * part;
      all.links.push_back(link);
    }
    all.poses.insert(all.poses.end(), one.poses.begin(), one.poses.end());
  }
  for (const bool fixed : {true, false}) {
    all.fixed.clear();
    for (int part = 0; fixed && part < 100; ++part) all.fixed.push_back(10 * part);
    Graph graph = graph_of(all);
    CHECK(check_minimum(all, graph).chi2 == Approx(sum).epsilon(1e-4));
  }
}

TEST_CASE("hostile graphs: half turns at every pose, and the seam of the angle on all of them") {
  for (const double noise : {0.0, 0.1}) {
    Problem problem;
    for (int i = 0; i < 40; ++i) {
      problem.poses.push_back({static_cast<double>(i), noise * (i % 2), i % 2 == 1 ? pi - noise : noise});
      if (i > 0) problem.links.push_back({i - 1, i, {i % 2 == 1 ? 1.0 : -1.0, 0, pi}, 0.1, 0.1});
    }
    problem.poses.front() = {0, 0, 0};
    problem.links.push_back({0, 39, {39, 0, pi}, 0.1, 0.1});
    Graph graph = graph_of(problem);
    CHECK(check_minimum(problem, graph).chi2 < 1e-6);
    check_near(graph.value(39), {39, 0, pi}, 1e-3);
  }
}

TEST_CASE("hostile graphs: from an initial guess with all poses at one point the same minimum is found") {
  const Problem good = loop(100, 0, 0);
  Problem lumped = good;
  for (Pose& pose : lumped.poses) pose = good.poses.front();
  Graph a = graph_of(good);
  Graph b = graph_of(lumped);
  CHECK(check_minimum(lumped, b).chi2 == Approx(check_minimum(good, a).chi2).epsilon(1e-5));
}

TEST_CASE("hostile graphs: contradictions are settled in the middle, with their whole chi2") {
  // Forward and backward by 1 m with one sigma: the middle, and 1 / sigma^2 for each.
  Problem places{{{0, 0, 0}, {0.3, 0, 0}}, {{0, 1, {1, 0, 0}, 0.01, 0.01}, {0, 1, {-1, 0, 0}, 0.01, 0.01}}};
  Graph graph = graph_of(places);
  CHECK(check_minimum(places, graph).chi2 == Approx(2e4).epsilon(1e-9));
  check_near(graph.value(1), {0, 0, 0}, 1e-9);
  // Ahead and half a turn: pi / 2 from both.
  Problem turns{{{0, 0, 0}, {1, 0, 0.1}}, {{0, 1, {1, 0, 0}, 1, 1}, {0, 1, {1, 0, pi}, 1, 1}}};
  Graph turned = graph_of(turns);
  CHECK(check_minimum(turns, turned).chi2 == Approx(pi * pi / 2).epsilon(1e-6));
  CHECK(std::abs(turned.value(1)[2]) == Approx(pi / 2).epsilon(1e-6));
}

TEST_CASE("hostile graphs: the smallest numbers there are give the pose that the edge says") {
  const double least = std::numeric_limits<double>::denorm_min();
  Problem tiny{{{0, 0, 0}, {5, 5, 1}}, {{0, 1, {least, -least, least}, 1, 1}}};
  Graph graph = graph_of(tiny);
  check_minimum(tiny, graph);
  check_near(graph.value(1), {0, 0, 0}, 1e-9);
  for (const double sigma : {1e-150, 1e150}) {
    INFO(sigma);
    const Problem extreme{{{0, 0, 0}, {5, 5, 1}}, {{0, 1, {1, 2, 0.5}, sigma, sigma}}};
    Graph weighed = graph_of(extreme);
    CHECK(optimize(weighed).converged());
    check_near(weighed.value(1), {1, 2, 0.5}, 1e-9);
  }
}

TEST_CASE("hostile graphs: a sum beyond all numbers names the edge with the largest information") {
  const Problem problem{
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
      {{0, 1, {1, 0, 0}, 1, 1}, {1, 2, {1, 0, 0}, 1e-154, 1e-154}, {1, 2, {1, 1, 0}, 0.9e-154, 0.9e-154}}};
  Graph graph = graph_of(problem);
  const MultiStartSummary result = optimize(graph);
  CHECK_FALSE(result.converged());
  CHECK_THAT(result.summary.message,
             Catch::Contains(
                 "EDGE_SE2 number 3 (vertices 1 and 2): its information is the largest, and the sum over the "
                 "edges is not finite"));
}

}  // namespace hostile_graphs_test
