// Odometry is recognised by the order of the ids, and by evidence that a drive follows this order.
#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/robust/odometry_edges.hpp>
#include <waymark/types_se2/edge_se2.hpp>
#include <waymark/types_se2/g2o_edges.hpp>

#include "support/registry.hpp"

namespace odometry_edges_test {

using namespace waymark;
using namespace waymark_test;

namespace {

using Ids = std::pair<std::int64_t, std::int64_t>;

/// A graph of poses, where only ids and edges matter.
class Poses {
 public:
  VertexIndex add(std::int64_t id) {
    const auto [known, is_new] = index_.try_emplace(id, 0);
    if (is_new) known->second = graph_.add_vertex<VertexSe2>(VertexId{id}, {0, 0, 0});
    return known->second;
  }
  void join(std::int64_t from, std::int64_t to) {
    const VertexIndex first = add(from);
    graph_.add_edge(EdgeSe2{}, {first, add(to)}, Eigen::Matrix3d::Identity());
  }
  void drive(const std::vector<std::int64_t>& ids) {
    for (std::size_t i = 1; i < ids.size(); ++i) join(ids[i - 1], ids[i]);
  }

  /// The ids that odometry joins, the smaller one first.
  [[nodiscard]] std::set<Ids> odometry() const {
    std::set<Ids> result;
    for (const EdgePlace place : odometry_edges(graph_)) {
      const auto vertices = graph_.batch(place.batch).vertices(place.edge);
      result.insert(std::minmax(to_number(graph_.id(vertices[0])), to_number(graph_.id(vertices[1]))));
    }
    return result;
  }
  [[nodiscard]] Graph& graph() { return graph_; }

 private:
  Graph graph_;
  std::map<std::int64_t, VertexIndex> index_;
};

std::vector<std::int64_t> ids(std::int64_t first, std::int64_t step, int count) {
  std::vector<std::int64_t> result;
  for (int i = 0; i < count; ++i) result.push_back(first + step * i);
  return result;
}

std::set<Ids> pairs_of(const std::vector<std::int64_t>& drive) {
  std::set<Ids> result;
  for (std::size_t i = 1; i < drive.size(); ++i) result.insert(std::minmax(drive[i - 1], drive[i]));
  return result;
}

std::set<Ids> both(std::set<Ids> one, const std::set<Ids>& other) {
  one.insert(other.begin(), other.end());
  return one;
}

}  // namespace

TEST_CASE("odometry: joins consecutive free poses, and determines one from the other") {
  Graph graph;
  for (int id : {0, 1, 2, 5}) graph.add_vertex<VertexSe2>(VertexId{id}, {double(id), 0, 0});
  const Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  graph.add_edge(EdgeSe2{}, {0, 1}, information);
  graph.add_edge(EdgeSe2{}, {2, 1}, information);
  graph.add_edge(EdgeSe2{}, {0, 2}, information);
  graph.add_edge(EdgeGnssPosition{}, {0, 1}, Eigen::Matrix2d::Identity());  // does not determine the heading
  const std::vector<EdgePlace> expected = {{0, 0}, {0, 1}};
  CHECK(odometry_edges(graph) == expected);
  graph.set_fixed(0, true);
  CHECK(odometry_edges(graph) == std::vector<EdgePlace>{{0, 1}});  // the other one is absolute, not relative
}

TEST_CASE("odometry: keyframes leave ids out, in equal steps or in any") {
  std::vector<std::int64_t> every_fifth = ids(0, 5, 60);
  std::vector<std::int64_t> with_gaps;
  for (int i = 0; i < 200; ++i) with_gaps.push_back(i + 40 * (i / 10));
  std::vector<std::int64_t> any{7};
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) any.push_back(any.back() + 1 + static_cast<std::int64_t>(random() % 40));
  std::vector<std::int64_t> backwards = ids(1000, -3, 60);
  for (const std::vector<std::int64_t>& drive : {every_fifth, with_gaps, any, backwards}) {
    Poses poses;
    poses.drive(drive);
    for (std::size_t i = 0; i + 20 < drive.size(); i += 7) poses.join(drive[i], drive[i + 20]);
    CHECK(poses.odometry() == pairs_of(drive));
  }
}

TEST_CASE("odometry: landmarks have ids between those of poses") {
  Poses poses;
  const std::vector<std::int64_t> drive = ids(0, 2, 40);
  poses.drive(drive);
  for (int id = 1; id < 80; id += 2) poses.graph().add_vertex<VertexXy>(VertexId{id}, {0, 0});
  CHECK(poses.odometry() == pairs_of(drive));
}

TEST_CASE("odometry: drives that are numbered apart do not continue each other") {
  for (const std::int64_t second : {std::int64_t{1000000}, std::int64_t{'b'} << 56}) {
    Poses poses;
    const std::vector<std::int64_t> one = ids(0, 1, 60);
    const std::vector<std::int64_t> other = ids(second, 1, 60);
    poses.drive(one);
    poses.drive(other);
    poses.join(one.back(), other.front());
    CHECK(poses.odometry() == both(pairs_of(one), pairs_of(other)));
  }
  // The steps of an id may be wider than its type.
  Poses poses;
  constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
  const std::vector<std::int64_t> one = ids(kFirst, 1, 60);
  const std::vector<std::int64_t> other = ids(std::numeric_limits<std::int64_t>::max() - 60, 1, 60);
  poses.drive(one);
  poses.drive(other);
  poses.join(one.back(), other.front());
  CHECK(poses.odometry() == both(pairs_of(one), pairs_of(other)));
}

TEST_CASE("odometry: drives whose ids are interleaved continue themselves, and not each other") {
  for (const int drives : {2, 3}) {
    Poses poses;
    std::set<Ids> expected;
    for (int d = 0; d < drives; ++d) {
      const std::vector<std::int64_t> drive = ids(d, drives, d == 0 ? 200 : 100);  // one goes on alone
      poses.drive(drive);
      expected = both(expected, pairs_of(drive));
    }
    for (int i = 10; i < 90; i += 4) poses.join(drives * i, drives * i + 1);  // they meet
    const std::set<Ids> found = poses.odometry();
    CHECK(std::includes(expected.begin(), expected.end(), found.begin(), found.end()));
    CHECK(found.size() + 60 > expected.size());  // where the others end, the ids tell less
  }
}

TEST_CASE("odometry: nothing is trusted where the ids do not follow the drive") {
  Poses poses;
  std::vector<std::int64_t> drive = ids(0, 1, 500);
  std::shuffle(drive.begin(), drive.end(), std::mt19937_64(1));
  poses.drive(drive);
  CHECK(poses.odometry().empty());
}

}  // namespace odometry_edges_test
