// The anchors of a graph: at rank 0 a vertex is held with a note, at rank 1 and 2 as many coordinates as
// motions are left, rank 3 is left alone. What only the present values leave open is refused.
#include <algorithm>
#include <array>
#include <chrono>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/system/held_marks.hpp>
#include <waymark/types_se2/g2o_edges.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

namespace gauge_test {

using namespace waymark;
using Catch::Contains;

namespace {

/// A chain of poses 1 m apart with a bend, ids from first_id, at an offset.
std::vector<VertexIndex> add_chain(Graph& graph, int first_id, int poses, Eigen::Vector2d offset = {0, 0}) {
  std::vector<VertexIndex> chain;
  for (int i = 0; i < poses; ++i) {
    const double turn = 0.1 * i;
    chain.push_back(
        graph.add_vertex<VertexSe2>(VertexId(first_id + i), {offset[0] + i, offset[1] + 0.2 * i, turn}));
    if (i == 0) continue;
    const auto from = graph.value(chain[static_cast<std::size_t>(i) - 1]);
    const auto to = graph.value(chain.back());
    const auto z = between(Pose2<double>(from[0], from[1], from[2]), Pose2<double>(to[0], to[1], to[2]));
    graph.add_edge(EdgeSe2{z.vector()}, {chain[static_cast<std::size_t>(i) - 1], chain.back()},
                   waymark_test::pose_information(0.01, 0.001));
  }
  return chain;
}

VertexIndex add_fixed_origin(Graph& graph, int id) {
  const VertexIndex origin = graph.add_vertex<VertexSe2>(VertexId{id}, {0, 0, 0});
  graph.set_fixed(origin, true);
  return origin;
}

void add_fix(Graph& graph, VertexIndex origin, VertexIndex pose) {
  const auto value = graph.value(pose);
  graph.add_edge(EdgeGnssPosition{{value[0], value[1]}, {0, 0}}, {origin, pose}, Eigen::Matrix2d::Identity());
}

/// The distance between two points, m.
struct EdgeDistance {
  static constexpr std::string_view kTag = "EDGE_DISTANCE";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexXy, VertexXy>;
  static constexpr auto fields() { return std::array{field<&EdgeDistance::distance>("distance")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Vector2<T>& one, const Vector2<T>& other) const {
    return Eigen::Matrix<T, 1, 1>((other - one).norm() - T(distance));
  }

  double distance = 0;
};

int held_count(const Gauge& gauge) {
  return static_cast<int>(std::count(gauge.held.begin(), gauge.held.end(), 1));
}

}  // namespace

TEST_CASE("gauge rank 0: the first vertex is held, and it is said") {
  Graph graph;
  const auto chain = add_chain(graph, 10, 5);
  const Gauge gauge = find_gauge(graph);
  CHECK(held_count(gauge) == 1);
  CHECK(gauge.held[static_cast<std::size_t>(chain[0])] == 1);
  REQUIRE(gauge.messages.size() == 1);
  CHECK_THAT(gauge.messages[0], Contains("vertex 10") && Contains("4 vertices") && Contains("held"));
  CHECK_FALSE(graph.fixed(chain[0]));  // not written into the file
}

TEST_CASE("gauge: coordinates of a UTM northing change nothing") {
  Graph graph;
  add_chain(graph, 0, 200, {690000.125, 5701234.567});
  CHECK(find_gauge(graph).messages.size() == 1);
}

TEST_CASE("gauge: a long unanchored chain of strong edges is still of rank 0") {
  Graph graph = waymark_test::grid_walk(3000, 40);
  CHECK(find_gauge(graph).messages.size() == 1);
}

TEST_CASE("gauge rank 3: a fixed vertex, a prior, or two fixes at different places hold nothing") {
  SECTION("fixed vertex") {
    Graph graph;
    graph.set_fixed(add_chain(graph, 0, 5)[2], true);
    CHECK(held_count(find_gauge(graph)) == 0);
  }
  SECTION("pose prior") {
    Graph graph;
    const auto chain = add_chain(graph, 0, 5);
    graph.add_edge(EdgePriorSe2{}, {chain[3]}, Eigen::Matrix3d::Identity());
    CHECK(held_count(find_gauge(graph)) == 0);
    CHECK(find_gauge(graph).messages.empty());
  }
  SECTION("two fixes") {
    Graph graph;
    const auto chain = add_chain(graph, 0, 5);
    const VertexIndex origin = add_fixed_origin(graph, 100);
    add_fix(graph, origin, chain[0]);
    add_fix(graph, origin, chain[4]);
    CHECK(held_count(find_gauge(graph)) == 0);
  }
  SECTION("weak fixes of a kilometre's accuracy") {
    Graph graph;
    const auto chain = add_chain(graph, 0, 5);
    const VertexIndex origin = add_fixed_origin(graph, 100);
    for (const VertexIndex v : {chain[0], chain[4]}) {
      graph.add_edge(EdgeGnssPosition{}, {origin, v}, 1e-6 * Eigen::Matrix2d::Identity());
    }
    CHECK(held_count(find_gauge(graph)) == 0);
  }
}

TEST_CASE("gauge rank 2: beside a single fix a heading is held, and the message names both") {
  Graph graph;
  const auto chain = add_chain(graph, 40, 5);
  add_fix(graph, add_fixed_origin(graph, 100), chain[2]);
  const Gauge gauge = find_gauge(graph);
  CHECK(gauge.held[static_cast<std::size_t>(chain[0])] == mark_of_coordinate(2));
  CHECK(std::count(gauge.held.begin(), gauge.held.end(), 0) == 5);
  REQUIRE(gauge.messages.size() == 1);
  CHECK_THAT(gauge.messages[0], Contains("2 of 3 rigid motions") &&
                                    Contains("heading of vertex 40 is held at its present value"));
}

TEST_CASE("gauge rank 2: a drive with a single fix is refused, because its heading is a result") {
  Graph graph;
  const auto chain = add_chain(graph, 40, 5);
  for (const VertexIndex v : chain) graph.set_stamp(v, Stamp{1'000'000'000LL * v});
  add_fix(graph, add_fixed_origin(graph, 100), chain[2]);
  CHECK_THROWS_AS(find_gauge(graph), InputError);
  CHECK_THROWS_WITH(find_gauge(graph), Contains("vertex 40") && Contains("2 of 3") && Contains("FIX") &&
                                           Contains("another place"));
}

TEST_CASE("gauge rank 2: a single pose with a single fix keeps its heading") {
  Graph graph;
  const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{3}, {4, 5, 0.5});
  add_fix(graph, add_fixed_origin(graph, 100), pose);
  CHECK(find_gauge(graph).held[static_cast<std::size_t>(pose)] == mark_of_coordinate(2));
}

TEST_CASE(
    "gauge rank 2: the minimum satisfies the fix, the held heading stays, and chi2 is that without a fix") {
  const TypeRegistry registry = waymark_test::full_registry();
  Graph free = waymark_test::noisy_circle(20);
  Graph graph = free;
  const VertexIndex origin = add_fixed_origin(graph, 100);
  graph.add_edge(EdgeGnssPosition{{50, -30}, {0, 0}}, {origin, 7}, Eigen::Matrix2d::Identity());
  const double heading = graph.value(0)[2];
  for (const char* name : {"gauss_newton", "levenberg_marquardt", "dogleg"}) {
    INFO(name);
    const auto algorithm = registry.make_algorithm(name);
    const auto solver = registry.make_linear_solver("eigen");
    Graph fixed = graph;
    Graph unfixed = free;
    const Summary summary = optimize(fixed, *algorithm, *solver, {});
    CHECK(summary.converged());
    CHECK(summary.unknowns == 59);  // 20 poses of 3, less the heading
    CHECK(summary.final_chi2 == Approx(optimize(unfixed, *algorithm, *solver, {}).final_chi2).epsilon(1e-9));
    CHECK(fixed.value(7)[0] == Approx(50).epsilon(1e-9));
    CHECK(fixed.value(7)[1] == Approx(-30).epsilon(1e-9));
    CHECK(fixed.value(0)[2] == Approx(heading).margin(1e-9));
  }
}

TEST_CASE("gauge rank 2: covariances are those of the graph whose heading is known by a strong prior") {
  Graph graph;
  const auto chain = add_chain(graph, 0, 6);
  add_fix(graph, add_fixed_origin(graph, 100), chain[3]);
  Graph with_prior = graph;
  const double heading = graph.value(chain[0])[2];
  with_prior.add_edge(EdgePriorSe2{{0, 0, heading}}, {chain[0]}, Eigen::Vector3d(0, 0, 1e14).asDiagonal());
  const CovarianceBlocks held = marginal_covariances(graph, chain);
  const CovarianceBlocks known = marginal_covariances(with_prior, chain);
  for (std::size_t i = 0; i < chain.size(); ++i) CHECK((held[i] - known[i]).norm() < 1e-6 * known[i].norm());
}

TEST_CASE(
    "gauge rank 2: a parked car with many fixes at one place is refused, because elsewhere they would turn it") {
  Graph graph;
  const VertexIndex origin = add_fixed_origin(graph, 100);
  std::vector<VertexIndex> chain;
  for (int i = 0; i < 10; ++i) {
    chain.push_back(graph.add_vertex<VertexSe2>(VertexId(i), {5, 6, 1}));
    if (i > 0) {
      const auto a = static_cast<std::size_t>(i);
      graph.add_edge(EdgeSe2{}, {chain[a - 1], chain[a]}, 1e5 * Eigen::Matrix3d::Identity());
    }
    add_fix(graph, origin, chain.back());
  }
  CHECK_THROWS_WITH(find_gauge(graph), Contains("vertex 0") && Contains("2 of 3") && Contains("FIX") &&
                                           Contains("another place"));
}

TEST_CASE("gauge rank 1: beside a heading the place of a pose is held") {
  Graph graph;
  const auto chain = add_chain(graph, 0, 5);
  graph.add_edge(EdgePriorSe2{}, {chain[0]}, Eigen::Vector3d(0, 0, 100).asDiagonal());
  const Gauge gauge = find_gauge(graph);
  CHECK(gauge.held[static_cast<std::size_t>(chain[0])] == (mark_of_coordinate(0) | mark_of_coordinate(1)));
  CHECK_THAT(gauge.messages.at(0), Contains("1 of 3") && Contains("x and y of vertex 0 are held"));
}

TEST_CASE("gauge: a position beside a heading make rank 3 together") {
  Graph graph;
  const auto chain = add_chain(graph, 0, 5);
  add_fix(graph, add_fixed_origin(graph, 100), chain[2]);
  graph.add_edge(EdgePriorSe2{}, {chain[0]}, Eigen::Vector3d(0, 0, 100).asDiagonal());
  CHECK(held_count(find_gauge(graph)) == 0);
}

TEST_CASE("gauge: a point that known poses see is anchored, though it turns about itself") {
  Graph graph;
  const VertexIndex origin = add_fixed_origin(graph, 0);
  const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId{1}, {3, 3});
  graph.add_edge(EdgeSe2Xy{{5, 5}}, {origin, landmark}, Eigen::Matrix2d::Identity());
  const Gauge gauge = find_gauge(graph);
  CHECK(held_count(gauge) == 0);
  CHECK(gauge.messages.empty());
}

TEST_CASE("gauge: a point that is seen in one direction only is anchored in 1 of 2 motions") {
  Graph graph;
  const VertexIndex origin = add_fixed_origin(graph, 0);
  const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId{1}, {3, 3});
  graph.add_edge(EdgeBearingSe2Xy{0.8}, {origin, landmark}, Eigen::Matrix<double, 1, 1>(1));
  CHECK_THROWS_WITH(find_gauge(graph), Contains("vertex 1") && Contains("1 of 2"));
}

TEST_CASE("gauge: a pose is held, wherever the points stand in the file") {
  Graph graph;
  const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId{0}, {3, 3});
  const auto chain = add_chain(graph, 10, 3);
  for (const VertexIndex pose : chain)
    graph.add_edge(EdgeSe2Xy{{1, 1}}, {pose, landmark}, Eigen::Matrix2d::Identity());
  const Gauge gauge = find_gauge(graph);
  CHECK(held_count(gauge) == 1);
  CHECK(gauge.held[static_cast<std::size_t>(chain[0])] == 1);
  CHECK_THAT(gauge.messages.at(0), Contains("vertex 10 "));
}

TEST_CASE("gauge: points that know only each other would turn about one that is held") {
  Graph graph;
  const VertexIndex first = graph.add_vertex<VertexXy>(VertexId{7}, {0, 0});
  const VertexIndex second = graph.add_vertex<VertexXy>(VertexId{8}, {4, 0});
  graph.add_edge(EdgeDistance{5}, {first, second}, Eigen::Matrix<double, 1, 1>(1));
  CHECK_THROWS_WITH(find_gauge(graph), Contains("vertex 7") && Contains("FIX two"));
  CHECK(held_count(find_gauge(graph, PartlyAnchored::hold_vertex)) == 1);
}

TEST_CASE("gauge: each component is judged by itself") {
  Graph graph;
  const auto first = add_chain(graph, 0, 4);
  const auto second = add_chain(graph, 20, 6, {100, 50});
  const auto third = add_chain(graph, 40, 3);
  graph.add_edge(EdgePriorSe2{}, {third[1]}, Eigen::Matrix3d::Identity());
  graph.add_vertex<VertexSe2>(VertexId{60}, {0, 0, 0});  // without edges: no unknown, nothing to hold
  const Gauge gauge = find_gauge(graph);
  CHECK(held_count(gauge) == 2);
  CHECK(gauge.held[static_cast<std::size_t>(first[0])] == 1);
  CHECK(gauge.held[static_cast<std::size_t>(second[0])] == 1);
  REQUIRE(gauge.messages.size() == 2);
  CHECK_THAT(gauge.messages[0], Contains("vertex 0 "));
  CHECK_THAT(gauge.messages[1], Contains("vertex 20 "));
}

TEST_CASE("gauge: a part with one fix is held beside parts that are anchored and parts that are not") {
  Graph graph;
  const auto anchored = add_chain(graph, 0, 4);
  const auto loose = add_chain(graph, 20, 6, {100, 50});
  const auto partly = add_chain(graph, 40, 3, {30, 0});
  graph.add_edge(EdgePriorSe2{}, {anchored[1]}, Eigen::Matrix3d::Identity());
  add_fix(graph, add_fixed_origin(graph, 100), partly[1]);
  const Gauge gauge = find_gauge(graph);
  CHECK(gauge.held[static_cast<std::size_t>(loose[0])] == kWhollyHeld);
  CHECK(gauge.held[static_cast<std::size_t>(partly[0])] == mark_of_coordinate(2));
  CHECK(std::count(gauge.held.begin(), gauge.held.end(), 0) == 12);
  REQUIRE(gauge.messages.size() == 2);
  CHECK_THAT(gauge.messages[0], Contains("vertex 20 "));
  CHECK_THAT(gauge.messages[1], Contains("vertex 40 "));
}

TEST_CASE("gauge: components joined only through a fixed vertex are separate and both anchored") {
  Graph graph;
  const auto first = add_chain(graph, 0, 3);
  const auto second = add_chain(graph, 10, 3);
  const VertexIndex middle = add_fixed_origin(graph, 100);
  graph.add_edge(EdgeSe2{}, {first[2], middle}, Eigen::Matrix3d::Identity());
  graph.add_edge(EdgeSe2{}, {middle, second[0]}, Eigen::Matrix3d::Identity());
  CHECK(held_count(find_gauge(graph)) == 0);
}

TEST_CASE("gauge: a prior of run-time arity anchors like any other") {
  const TypeRegistry registry = waymark_test::full_registry();
  Graph graph;
  const auto chain = add_chain(graph, 0, 5);
  const std::array<double, 12> fields = {0, 0, 0, 1, 0.2, 0.1, 0, 0, 0, 0, 0, 0};
  graph.add_edge(*registry.find_edge("EDGE_GAUSSIAN_PRIOR"), std::array{chain[0], chain[1]}, fields,
                 Eigen::MatrixXd::Identity(6, 6));
  CHECK(held_count(find_gauge(graph)) == 0);
}

TEST_CASE("gauge: of very many parts the first ones are named, and the others counted") {
  constexpr int kParts = 1000;
  Graph graph;
  const VertexIndex origin = add_fixed_origin(graph, 1'000'000);
  for (int i = 0; i < kParts; ++i) {
    add_chain(graph, 100 * i, 3, {0, 30.0 * i});
    add_fix(graph, origin, add_chain(graph, 100 * i + 50, 3, {50, 30.0 * i})[1]);
  }
  const Gauge gauge = find_gauge(graph);
  CHECK(held_count(gauge) == kParts);
  CHECK(std::count(gauge.held.begin(), gauge.held.end(), mark_of_coordinate(2)) == kParts);
  REQUIRE(gauge.messages.size() == 12);
  CHECK_THAT(gauge.messages[0], Contains("nothing anchors vertex 0 "));
  CHECK_THAT(gauge.messages[1], Contains("heading of vertex 50 is held"));
  CHECK_THAT(gauge.messages[9], Contains("heading of vertex 450 is held"));
  CHECK_THAT(gauge.messages[10], Contains("further parts that nothing anchors: 995;"));
  CHECK_THAT(gauge.messages[11], Contains("further parts that are anchored in part: 995;"));
}

TEST_CASE("gauge: a part is judged alike alone and among many, whatever the others need") {
  // A parked part, whose fixes stand at one place, is refused; the parts before it are held in part.
  Graph graph;
  const VertexIndex origin = add_fixed_origin(graph, 1'000'000);
  for (int i = 0; i < 20; ++i) add_fix(graph, origin, add_chain(graph, 100 * i, 3, {0, 30.0 * i})[1]);
  const VertexIndex one = graph.add_vertex<VertexSe2>(VertexId{5000}, {7, 7, 0});
  const VertexIndex other = graph.add_vertex<VertexSe2>(VertexId{5001}, {7, 7, 0});
  graph.add_edge(EdgeSe2{{1, 0, 0}}, {one, other}, Eigen::Matrix3d::Identity());
  add_fix(graph, origin, one);
  add_fix(graph, origin, other);
  CHECK_THROWS_WITH(find_gauge(graph), Contains("vertex 5000 ") && Contains("2 of 3"));
}

TEST_CASE("gauge: the time grows with the number of parts, not with its square") {
  const auto seconds_for = [](int parts) {
    Graph graph;
    const VertexIndex origin = add_fixed_origin(graph, 1'000'000'000);
    for (int i = 0; i < parts; ++i) {
      const auto chain = add_chain(graph, 10 * i, 2, {0, 30.0 * i});
      if (i % 2 == 0) add_fix(graph, origin, chain[1]);
    }
    double least = 1e9;
    for (int repetition = 0; repetition < 3; ++repetition) {
      const auto begin = std::chrono::steady_clock::now();
      CHECK(find_gauge(graph).messages.size() == 12);
      least =
          std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    return least;
  };
  // 16 times the parts: 16 times the time, and 256 times if each part looks at all vertices or edges.
  CHECK(seconds_for(8000) < 64 * seconds_for(500));
}

TEST_CASE("gauge: the unknowns are the coordinates that the edges estimate") {
  const TypeRegistry registry = waymark_test::full_registry();
  Graph graph;
  const auto unknowns = [&] {
    Graph copy = graph;
    const Summary summary =
        optimize(copy, *registry.make_algorithm("dogleg"), *registry.make_linear_solver("eigen"), {});
    CHECK(count_unknowns(graph, find_gauge(graph)) == summary.unknowns);
    return summary.unknowns;
  };
  add_chain(graph, 0, 5);  // its first pose is held
  CHECK(unknowns() == 12);
  const VertexIndex origin = add_fixed_origin(graph, 1000);
  add_fix(graph, origin, add_chain(graph, 20, 4, {50, 0})[1]);  // a heading is held
  CHECK(unknowns() == 12 + 11);
  const auto anchored = add_chain(graph, 40, 3, {0, 50});
  graph.add_edge(EdgePriorSe2{}, {anchored[0]}, Eigen::Matrix3d::Identity());
  CHECK(unknowns() == 12 + 11 + 9);
  graph.add_vertex<VertexSe2>(VertexId{60}, {0, 0, 0});  // without edges
  CHECK(unknowns() == 12 + 11 + 9);
  graph.set_fixed(anchored[2], true);
  CHECK(unknowns() == 12 + 11 + 6);
}

TEST_CASE("gauge: optimize says in its notes what was held and leaves it in place") {
  const TypeRegistry registry = waymark_test::full_registry();
  Graph graph = waymark_test::noisy_circle(20);
  const std::vector<double> first(graph.value(0).begin(), graph.value(0).end());
  const Summary summary =
      optimize(graph, *registry.make_algorithm("gauss_newton"), *registry.make_linear_solver("eigen"), {});
  REQUIRE(summary.notes.size() == 1);
  CHECK_THAT(summary.notes[0], Contains("vertex 0"));
  CHECK(std::vector<double>(graph.value(0).begin(), graph.value(0).end()) == first);
  CHECK(summary.unknowns == 57);
}

TEST_CASE("gauge: an anchor counts beside the information of its graph, however faint that is") {
  Graph graph;
  const VertexIndex origin = add_fixed_origin(graph, 0);
  const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{1}, {5, 5, 1});
  graph.add_edge(EdgeSe2{{1, 0, 0}}, {origin, pose}, 1e-20 * Eigen::Matrix3d::Identity());
  const Gauge gauge = find_gauge(graph);
  CHECK(held_count(gauge) == 0);
  CHECK(gauge.messages.empty());
}

}  // namespace gauge_test
