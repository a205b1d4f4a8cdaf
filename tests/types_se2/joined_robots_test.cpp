// Robots that have nothing in common but the landmarks that they see: every start finds where they are to each other.
// The measurements are exact, so that chi2 is zero there.
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/plugins/landmarks/landmarks.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/g2o_edges.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

namespace joined_robots_test {

using namespace waymark;
using namespace waymark_test;

namespace {

using Pose = Pose2<double>;
using plugins::landmarks::EdgeSe2XyRangeBearing;

enum class Seen { place, range_and_bearing, bearing };

std::vector<Pose> bow(const Pose& begin, double turn) {
  std::vector<Pose> track{begin};
  for (int i = 1; i < 30; ++i) track.push_back(compose(track.back(), Pose(1, 0, turn)));
  return track;
}

const std::vector<std::vector<Pose>>& tracks() {
  static const std::vector<std::vector<Pose>> all{bow(Pose(0, 0, 0), 0.1), bow(Pose(3, 12, -2.5), -0.15),
                                                  bow(Pose(-8, 5, 1.2), 0.2)};
  return all;
}

const std::vector<Eigen::Vector2d>& landmarks() {
  static const std::vector<Eigen::Vector2d> all{{4, 5}, {-6, 9}, {8, -3}, {-3, -4}, {12, 10}, {1, 15}};
  return all;
}

void see(Graph& graph, Seen how, const Pose& pose, const Eigen::Vector2d& place, VertexIndex from,
         VertexIndex to) {
  const Eigen::Vector2d z = rotate_back(pose.heading, Eigen::Vector2d(place - pose.position));
  const double bearing = std::atan2(z[1], z[0]);
  const Eigen::Matrix2d information = 25 * Eigen::Matrix2d::Identity();
  if (how == Seen::place) graph.add_edge(EdgeSe2Xy{z}, {from, to}, information);
  if (how == Seen::range_and_bearing)
    graph.add_edge(EdgeSe2XyRangeBearing{{z.norm(), bearing}, {}}, {from, to}, information);
  if (how == Seen::bearing)
    graph.add_edge(EdgeBearingSe2Xy{bearing}, {from, to}, Eigen::Matrix<double, 1, 1>::Constant(2500));
}

/// Each robot sees all landmarks, from every third pose. The values are nonsense.
Graph robots(Seen how) {
  Graph graph;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  VertexIndex first = 0;
  for (const auto& track : tracks()) {
    for (std::size_t i = 0; i < track.size(); ++i) {
      const auto v = first + static_cast<VertexIndex>(i);
      graph.add_vertex<VertexSe2>(VertexId{v},
                                  {40 * uniform(random), 40 * uniform(random), 3 * uniform(random)});
      if (i == 0) continue;
      const Eigen::Vector3d motion = between(track[i - 1], track[i]).vector();
      graph.add_edge(EdgeSe2{motion}, {v - 1, v}, pose_information(0.1, 0.01));
    }
    first += static_cast<VertexIndex>(track.size());
  }
  for (const Eigen::Vector2d& place : landmarks()) {
    const auto point = graph.add_vertex<VertexXy>(VertexId{1000 + first}, {40 * uniform(random), 0});
    VertexIndex v = 0;
    for (const auto& track : tracks())
      for (const Pose& pose : track)
        if (++v % 3 == 0) see(graph, how, pose, place, v - 1, point);
    ++first;
  }
  return graph;
}

}  // namespace

TEST_CASE("joined robots: the landmarks that robots share tell every start where they are to each other") {
  const TypeRegistry registry = full_registry();
  for (const Seen how : {Seen::place, Seen::range_and_bearing, Seen::bearing}) {
    const Graph graph = robots(how);
    REQUIRE(graph.chi2() > 1e4);
    for (const auto& [type, origin] : registry.starts()) {
      const InitialValues start = registry.make_start(type.name, graph);
      INFO(type.name << ", sightings " << static_cast<int>(how) << ": " << start.note);
      REQUIRE(start.values.size() == graph.values().size());
      CHECK(start.apart == 0);
      Graph begun = graph;
      begun.set_values(start.values);
      CHECK(begun.chi2() < 1e-9);
      for (std::size_t k = 0; k < 3; ++k) CHECK(begun.value(0)[k] == graph.value(0)[k]);
    }
  }
}

TEST_CASE("joined robots: bearings to landmarks on a map tell every start where the robots are") {
  const TypeRegistry registry = full_registry();
  Graph graph = robots(Seen::bearing);
  const auto points = static_cast<VertexIndex>(3 * tracks()[0].size());
  for (VertexIndex k = 0; k < static_cast<VertexIndex>(landmarks().size()); ++k) {
    const Eigen::Vector2d& place = landmarks()[static_cast<std::size_t>(k)];
    graph.set_value(points + k, std::array{place[0], place[1]});
    graph.set_fixed(points + k, true);
  }
  for (const auto& [type, origin] : registry.starts()) {
    const InitialValues start = registry.make_start(type.name, graph);
    INFO(type.name << ": " << start.note);
    REQUIRE(start.values.size() == graph.values().size());
    Graph begun = graph;
    begun.set_values(start.values);
    CHECK(begun.chi2() < 1e-9);
    CHECK(std::hypot(begun.value(0)[0], begun.value(0)[1]) < 1e-6);  // the first track begins at the origin
  }
}

TEST_CASE("joined robots: a few false pairs of landmarks do not turn a robot") {
  // Two of six landmarks were taken for others: the trees put robots where the other four are.
  const TypeRegistry registry = full_registry();
  Graph graph = robots(Seen::place);
  const auto count = static_cast<VertexIndex>(tracks()[0].size());
  const VertexIndex points = 3 * count;
  for (const VertexIndex v : {count + 4, count + 9, count + 14}) {
    const Pose& pose = tracks()[1][static_cast<std::size_t>(v - count)];
    for (int k = 0; k < 12; ++k) {
      see(graph, Seen::place, pose, Eigen::Vector2d(-30, 40), v, points);
      see(graph, Seen::place, pose, Eigen::Vector2d(50, 20), v, points + 1);
    }
  }
  for (const std::string name : {"spanning_tree", "odometry"}) {
    graph.set_values(registry.make_start(name, graph).values);
    const auto origin = graph.value(0);
    const auto other = graph.value(count);
    const Pose found = between(Pose(origin[0], origin[1], origin[2]), Pose(other[0], other[1], other[2]));
    INFO(name);
    CHECK((found.position - tracks()[1][0].position).norm() < 1e-3);
    CHECK(std::abs(wrap_angle(found.heading - tracks()[1][0].heading)) < 1e-4);
  }
}

TEST_CASE(
    "joined robots: two landmarks that are not as far apart for one robot as for another tell nothing") {
  // Two tracks of two poses see two landmarks: 4 m apart each, or for the second robot 7 m.
  const TypeRegistry registry = full_registry();
  for (const double apart_m : {4.0, 7.0}) {
    Graph graph;
    for (const VertexIndex v : {0, 1, 2, 3}) graph.add_vertex<VertexSe2>(VertexId{v}, {1.0 * v, 0, 0});
    for (const VertexIndex v : {0, 2})
      graph.add_edge(EdgeSe2{{1, 0, 0}}, {v, v + 1}, pose_information(0.1, 0.01));
    for (const VertexIndex point : {4, 5}) graph.add_vertex<VertexXy>(VertexId{point}, {0, 0});
    const Eigen::Matrix2d information = 25 * Eigen::Matrix2d::Identity();
    graph.add_edge(EdgeSe2Xy{{0, 10}}, {0, 4}, information);
    graph.add_edge(EdgeSe2Xy{{4, 10}}, {0, 5}, information);
    graph.add_edge(EdgeSe2Xy{{-20, 1}}, {2, 4}, information);
    graph.add_edge(EdgeSe2Xy{{-20, 1 + apart_m}}, {2, 5}, information);
    for (const std::string name : {"spanning_tree", "odometry"}) {
      const InitialValues start = registry.make_start(name, graph);
      INFO(name << ", " << apart_m << " m: " << start.note);
      CHECK((start.apart == 0) == (apart_m == 4));
      graph.set_values(start.values);
      if (apart_m == 4) CHECK(graph.chi2() < 1e-9);
    }
  }
}

}  // namespace joined_robots_test
