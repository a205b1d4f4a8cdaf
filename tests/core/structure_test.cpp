// The block structure: pattern and scatter against dense assembly, growth against building anew,
// dense columns last, the order of elimination.
#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

#include <catch2/catch.hpp>

#include <waymark/core/linear/detail/factor_work.hpp>
#include <waymark/core/system/gauge.hpp>

#include "support/dense.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/scalar_types.hpp"

namespace structure_test {

using namespace waymark;
using namespace waymark_test;

namespace {

/// H and g of a structure equal H and g assembled edge by edge, and chi2 equals the graph's.
void check_against_dense(const Graph& graph, const Structure& structure, const std::vector<char>& held) {
  NormalEquations equations(graph, structure);
  CHECK(equations.linearize(graph.values()) == Approx(graph.chi2()).epsilon(1e-12));
  const DenseSystem expected = assemble_dense(graph, held);
  const DenseSystem got = spread_out(graph, structure, equations);
  REQUIRE(got.start == expected.start);
  CHECK(relative_difference(got.hessian, expected.hessian) < 1e-13);
  CHECK(relative_difference(got.gradient, expected.gradient) < 1e-12);
}

void check_pattern_is_sound(const BlockPattern& pattern) {
  for (std::size_t j = 0; j < pattern.size.size(); ++j) {
    const auto first = pattern.row.begin() + pattern.column[j];
    const auto last = pattern.row.begin() + pattern.column[j + 1];
    CHECK(std::adjacent_find(first, last, std::greater_equal<>()) == last);
    CHECK(*(last - 1) == static_cast<int>(j));
    CHECK(pattern.value[j + 1] - pattern.value[j] == std::int64_t{pattern.height[j]} * pattern.size[j]);
  }
}

std::vector<char> nobody(const Graph& graph) {
  return std::vector<char>(graph.vertex_count(), 0);
}

/// A chain whose odometry is scaled by one dense state; the state comes first, as calibration
/// states do.
Graph calibrated_chain(int poses) {
  Graph graph;
  const VertexIndex scale = graph.add_vertex<VertexScale>(VertexId{1000}, {1.02});
  VertexIndex last = -1;
  for (int i = 0; i < poses; ++i) {
    const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId(i), {i * 1.01, 0.05 * i, 0.04 * i});
    if (i > 0)
      graph.add_edge(EdgeScaledOdometry{1.0, 0.05}, {last, scale, pose}, pose_information(0.1, 0.02));
    last = pose;
  }
  graph.add_edge(EdgePriorSe2{}, {1}, Eigen::Matrix3d::Identity());
  return graph;
}

}  // namespace

TEST_CASE("structure: normal equations equal dense assembly on a circle with closures") {
  const Graph graph = noisy_circle(40);
  const Gauge gauge = find_gauge(graph);
  Structure structure;
  structure.build(graph, gauge.held);
  check_pattern_is_sound(structure.pattern());
  check_against_dense(graph, structure, gauge.held);
}

TEST_CASE("structure: with fixed vertices, vertices without edges, two components and landmarks") {
  Graph graph = noisy_circle(20);
  graph.set_fixed(7, true);
  graph.set_fixed(8, true);  // an edge between two fixed vertices
  graph.add_vertex<VertexSe2>(VertexId{500}, {1, 2, 3});
  const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId{501}, {4, 4});
  const VertexIndex held_landmark = graph.add_vertex<VertexXy>(VertexId{502}, {5, 4});
  graph.set_fixed(held_landmark, true);
  graph.add_edge(EdgeSe2Xy{{1, 2}}, {3, landmark}, Eigen::Matrix2d::Identity());
  graph.add_edge(EdgeSe2Xy{{1, 1}}, {12, landmark}, Eigen::Matrix2d::Identity());
  graph.add_edge(EdgeSe2Xy{{1, 1}}, {12, held_landmark}, Eigen::Matrix2d::Identity());
  const VertexIndex a = graph.add_vertex<VertexSe2>(VertexId{600}, {0, 0, 0});
  const VertexIndex b = graph.add_vertex<VertexSe2>(VertexId{601}, {1, 0, 0});
  graph.add_edge(EdgeSe2Log{{1.1, 0.1, 0.1}}, {b, a}, Eigen::Matrix3d::Identity());
  std::vector<char> held = nobody(graph);
  held[static_cast<std::size_t>(a)] = 1;
  Structure structure;
  structure.build(graph, held);
  CHECK(structure.column_of(7) == -1);
  CHECK(structure.column_of(20) == -1);
  check_against_dense(graph, structure, held);
}

TEST_CASE("structure: held vertices smaller than their neighbours write nowhere else") {
  // The sums of a held vertex are thrown away, in blocks as large as the blocks of its largest
  // neighbour: into a place that must hold them, or the sums of dense columns just behind it would
  // be spoilt.
  Graph graph = calibrated_chain(20);
  for (int i = 0; i < 20; i += 3) {
    const VertexIndex point = graph.add_vertex<VertexXy>(VertexId(2000 + i), {0.5 * i, 1});
    graph.set_fixed(point, true);
    graph.add_edge(EdgeSe2Xy{{0.3, 0.7}}, {*graph.find(VertexId(i)), point}, Eigen::Matrix2d::Identity());
  }
  Structure structure;
  structure.build(graph, nobody(graph));
  REQUIRE(structure.dense_columns() == 1);
  check_against_dense(graph, structure, nobody(graph));

  // The calibration state itself held: a block of 1 x 1 beside poses.
  Graph calibrated = calibrated_chain(20);
  calibrated.set_fixed(0, true);
  const VertexIndex second = calibrated.add_vertex<VertexScale>(VertexId{3000}, {1});
  calibrated.add_edge(EdgeScaledOdometry{1.0, 0.05}, {1, second, 2}, Eigen::Matrix3d::Identity());
  structure.build(calibrated, nobody(calibrated));
  REQUIRE(structure.dense_columns() == 1);
  check_against_dense(calibrated, structure, nobody(calibrated));
}

TEST_CASE("structure: two edges between the same vertices, in both directions, share one block") {
  Graph graph = noisy_circle(10);
  graph.add_edge(EdgeSe2{{1, 0, 0.1}}, {4, 3}, pose_information(1, 2));
  graph.add_edge(EdgeSe2{{1, 0, 0.1}}, {3, 4}, pose_information(2, 1));
  Structure structure;
  structure.build(graph, nobody(graph));
  check_pattern_is_sound(structure.pattern());
  check_against_dense(graph, structure, nobody(graph));
}

TEST_CASE("structure: a prior of run-time arity over mixed types") {
  const TypeRegistry registry = full_registry();
  Graph graph = calibrated_chain(8);
  const std::array<VertexIndex, 3> vertices = {3, 0, 7};
  const std::vector<double> fields = {1, 0, 0.1, 1, 5, 0, 0.2, 0, 0, 0, 0, 0, 0, 0};
  Eigen::MatrixXd root = Eigen::MatrixXd::Identity(7, 7);
  root(0, 3) = root(1, 4) = root(6, 2) = 0.4;
  graph.add_edge(*registry.find_edge("EDGE_GAUSSIAN_PRIOR"), vertices, fields, root * root.transpose());
  Structure structure;
  structure.build(graph, nobody(graph));
  check_pattern_is_sound(structure.pattern());
  check_against_dense(graph, structure, nobody(graph));
}

TEST_CASE(
    "structure: a calibration state that touches every edge is ordered last, wherever it was inserted") {
  const Graph graph = calibrated_chain(50);
  Structure structure;
  structure.build(graph, nobody(graph));
  CHECK(structure.dense_columns() == 1);
  CHECK(structure.column_of(0) == structure.pattern().columns() - 1);
  CHECK(structure.ordering() == "natural");  // a chain remains
  check_against_dense(graph, structure, nobody(graph));
}

TEST_CASE("structure: a pose that meets very many others counts as dense without being told") {
  Graph graph;
  const VertexIndex hub = graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
  for (int i = 1; i < 400; ++i) {
    const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId(i), {std::cos(i), std::sin(i), 0});
    graph.add_edge(EdgeSe2{}, {hub, pose}, Eigen::Matrix3d::Identity());
  }
  Structure structure;
  structure.build(graph, nobody(graph));
  CHECK(structure.dense_columns() == 1);
  CHECK(structure.column_of(hub) == structure.pattern().columns() - 1);
}

TEST_CASE("structure: extend after appending poses equals building anew") {
  Graph graph = noisy_circle(30);
  graph.set_fixed(0, true);
  Structure structure;
  structure.build(graph, nobody(graph));
  const auto version = structure.pattern().version;
  for (int i = 30; i < 45; ++i) {
    const VertexIndex v = graph.add_vertex<VertexSe2>(VertexId(i), {1.0 * i, 2, 0.1});
    graph.add_edge(EdgeSe2{{1, 0, 0}}, {v - 1, v}, pose_information(0.1, 0.01));
    if (i % 4 == 0)
      graph.add_edge(EdgeSe2Log{{1, 2, 0}}, {v, 3}, pose_information(0.1, 0.01));  // a new batch
    structure.extend(graph, nobody(graph));
    check_against_dense(graph, structure, nobody(graph));
  }
  CHECK(structure.pattern().version != version);
  check_pattern_is_sound(structure.pattern());
}

TEST_CASE("structure: extend keeps the old order and the old columns") {
  Graph graph = noisy_circle(30);
  Structure structure;
  structure.build(graph, nobody(graph));
  const BlockPattern before = structure.pattern();
  std::vector<int> columns;
  for (VertexIndex v = 0; v < 30; ++v) columns.push_back(structure.column_of(v));
  const VertexIndex v = graph.add_vertex<VertexSe2>(VertexId{30}, {1, 2, 3});
  graph.add_edge(EdgeSe2{}, {4, v}, Eigen::Matrix3d::Identity());
  structure.extend(graph, nobody(graph));
  for (VertexIndex old = 0; old < 30; ++old)
    CHECK(structure.column_of(old) == columns[static_cast<std::size_t>(old)]);
  CHECK(structure.column_of(v) == 30);
  CHECK(std::equal(before.row.begin(), before.row.end(), structure.pattern().row.begin()));
  CHECK(std::equal(before.value.begin(), before.value.end(), structure.pattern().value.begin()));
}

TEST_CASE(
    "structure: extend with a loop closure between old poses, and with a pose that had no edge before") {
  Graph graph = noisy_circle(30);
  const VertexIndex loose = graph.add_vertex<VertexSe2>(VertexId{30}, {1, 2, 3});
  Structure structure;
  structure.build(graph, nobody(graph));
  SECTION("closure") {
    graph.add_edge(EdgeSe2{}, {2, 11}, Eigen::Matrix3d::Identity());
  }
  SECTION("once more where a block is already") {
    graph.add_edge(EdgeSe2{}, {3, 2}, Eigen::Matrix3d::Identity());
  }
  SECTION("loose pose joined") {
    graph.add_edge(EdgeSe2{}, {2, loose}, Eigen::Matrix3d::Identity());
  }
  SECTION("prior on an old pose") {
    graph.add_edge(EdgePriorSe2{}, {2}, Eigen::Matrix3d::Identity());
  }
  structure.extend(graph, nobody(graph));
  check_pattern_is_sound(structure.pattern());
  check_against_dense(graph, structure, nobody(graph));
}

TEST_CASE("structure: extend past a fixed or held new vertex") {
  Graph graph = noisy_circle(30);
  Structure structure;
  structure.build(graph, nobody(graph));
  const VertexIndex v = graph.add_vertex<VertexSe2>(VertexId{30}, {1, 2, 3});
  graph.set_fixed(v, true);
  graph.add_edge(EdgeSe2{}, {v, 4}, Eigen::Matrix3d::Identity());
  structure.extend(graph, nobody(graph));
  CHECK(structure.column_of(v) == -1);
  check_against_dense(graph, structure, nobody(graph));
}

TEST_CASE("structure: extend a calibrated chain, the dense column stays last") {
  Graph graph = calibrated_chain(20);
  Structure structure;
  structure.build(graph, nobody(graph));
  for (int i = 0; i < 3; ++i) {
    const VertexIndex v = graph.add_vertex<VertexSe2>(VertexId(200 + i), {1, 2, 3});
    graph.add_edge(EdgeScaledOdometry{1, 0}, {v - 1, 0, v}, Eigen::Matrix3d::Identity());
    structure.extend(graph, nobody(graph));
    CHECK(structure.column_of(0) == structure.pattern().columns() - 1);
    check_against_dense(graph, structure, nobody(graph));
  }
}

TEST_CASE("structure: a dense state that comes with an extension goes last, too") {
  Graph graph = noisy_circle(30);
  Structure structure;
  structure.build(graph, nobody(graph));
  VertexIndex last = 29;
  const VertexIndex scale = graph.add_vertex<VertexScale>(VertexId{1000}, {1});
  for (int i = 0; i < 4; ++i) {
    const VertexIndex v = graph.add_vertex<VertexSe2>(VertexId(200 + i), {1, 2, 3});
    graph.add_edge(EdgeScaledOdometry{1, 0}, {last, scale, v}, Eigen::Matrix3d::Identity());
    last = v;
  }
  structure.extend(graph, nobody(graph));
  CHECK(structure.dense_columns() == 1);
  CHECK(structure.column_of(scale) == structure.pattern().columns() - 1);
  check_against_dense(graph, structure, nobody(graph));
}

TEST_CASE("ordering: a chain keeps its natural order, a grid fills less under minimum degree") {
  const auto order = [](const Graph& graph) {
    Structure structure;
    structure.build(graph, nobody(graph));
    return structure.ordering();
  };
  Graph chain;
  for (int i = 0; i < 100; ++i) {
    chain.add_vertex<VertexSe2>(VertexId(i), {0, 0, 0});
    if (i > 0) chain.add_edge(EdgeSe2{}, {i - 1, i}, Eigen::Matrix3d::Identity());
  }
  CHECK(order(chain) == "natural");
  CHECK(order(grid_walk(1500, 20)) == "amd");
}

TEST_CASE("ordering: an order is a permutation, and its fill is that of elimination") {
  // Upper triangles, column by column. A ring fills one block a column; a hub that is eliminated
  // first joins all its neighbours; between dense columns nothing is counted.
  struct Pattern {
    std::vector<std::int64_t> begin{0};
    std::vector<int> rows;
    void add_column(std::vector<int> above) {
      rows.insert(rows.end(), above.begin(), above.end());
      begin.push_back(static_cast<std::int64_t>(rows.size()));
    }
  };
  constexpr int kNodes = 41;
  Pattern star;
  star.add_column({});
  for (int i = 1; i < kNodes; ++i) star.add_column({0});
  const std::vector<char> none(kNodes, 0);
  CHECK(count_fill(star.begin, star.rows, none, 1'000'000) == (kNodes - 1) * kNodes / 2);
  CHECK(count_fill(star.begin, star.rows, none, 100) == -1);
  std::vector<char> without_hub(kNodes, 0);
  without_hub[0] = 1;
  CHECK(count_fill(star.begin, star.rows, without_hub, 1'000'000) == 0);

  const auto check_permutation = [](std::vector<int> order) {
    std::sort(order.begin(), order.end());
    for (int i = 0; i < kNodes; ++i) CHECK(order[static_cast<std::size_t>(i)] == i);
  };
  // The hub's leaves come first: no fill at all.
  const BlockOrder best = order_blocks(star.begin, star.rows, none);
  CHECK(best.method == "leaves first");
  CHECK(best.order.back() == 0);
  check_permutation(best.order);
  const BlockOrder dense_hub = order_blocks(star.begin, star.rows, without_hub);
  CHECK(dense_hub.method == "natural");
  CHECK(dense_hub.order.back() == 0);
  check_permutation(dense_hub.order);
}

TEST_CASE("ordering: the work of a factorisation is that of the heights of its columns") {
  // A star of five nodes of two numbers each. From the leaves: four pairs of columns of height 4, one of 2. From
  // the hub: every column meets all later ones.
  const std::vector<std::int64_t> begin = {0, 0, 1, 2, 3, 4};
  const std::vector<int> rows = {0, 0, 0, 0};
  const std::vector<int> sizes(5, 2);
  const std::vector<int> leaves_first = {1, 2, 3, 4, 0};
  const std::vector<int> hub_first = {0, 1, 2, 3, 4};
  CHECK(detail::factor_work(begin, rows, leaves_first, sizes, 1e9) == 4 * 2 * 16 + 2 * 4);
  CHECK(detail::factor_work(begin, rows, hub_first, sizes, 1e9) ==
        2 * (10 * 10 + 8 * 8 + 6 * 6 + 4 * 4 + 2 * 2));
  // Beyond the limit it stops.
  const double part = detail::factor_work(begin, rows, hub_first, sizes, 100);
  CHECK(part > 100);
  CHECK(part < 2 * (10 * 10 + 8 * 8 + 6 * 6 + 4 * 4 + 2 * 2));
}

namespace {

/// A part of what a satellite's range is wrong by, for some time.
struct VertexRangeBias : ScalarState {
  static constexpr std::string_view kTag = "VERTEX_RANGE_BIAS";
  static constexpr std::array<std::string_view, 1> value_names() { return {"range_bias"}; }
};

struct EdgeRangeBiasStep {
  static constexpr std::string_view kTag = "EDGE_RANGE_BIAS_STEP";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexRangeBias, VertexRangeBias>;
  static constexpr std::array<Field<EdgeRangeBiasStep>, 0> fields() { return {}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& from, const T& to) const {
    return Eigen::Matrix<T, 1, 1>(T(to - from));
  }
};

struct EdgeBiasedRange {
  static constexpr std::string_view kTag = "EDGE_BIASED_RANGE";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexSe2, VertexRangeBias, VertexRangeBias>;
  static constexpr std::array<Field<EdgeBiasedRange>, 0> fields() { return {}; }
  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const Pose2<T>& pose, const T& bias, const T& slow) const {
    return Eigen::Matrix<T, 1, 1>(T(pose.position[0] + bias + slow));
  }
};

/// The values of one bias: each holds for some poses, and is joined with the next one.
class RangeBias {
 public:
  explicit RangeBias(int poses) : poses_(poses) {}
  VertexIndex at(int pose, Graph& graph) {
    if (vertex_ < 0 || pose >= since_ + poses_) {
      const VertexIndex next = graph.add_vertex<VertexRangeBias>(graph.free_id(), {0});
      graph.set_stamp(next, *graph.stamp(pose));
      if (vertex_ >= 0) graph.add_edge(EdgeRangeBiasStep{}, {vertex_, next}, Eigen::Matrix<double, 1, 1>(1));
      vertex_ = next;
      since_ = pose;
    }
    return vertex_;
  }

 private:
  int poses_;
  int since_ = 0;
  VertexIndex vertex_ = -1;
};

}  // namespace

TEST_CASE("ordering: states that begin and end are eliminated in the order of time") {
  // Five poses a second; every fifth sees half of 18 satellites, whose biases last. All poses come first.
  // Minimum degree needs ten times the work of the order of time.
  constexpr int kPoses = 4000;
  constexpr int kRate = 5;
  constexpr int kSatellites = 18;
  const auto is_seen = [](int pose, int satellite) {
    return (pose * 7919 + satellite * 104'729) % 1009 < 500;
  };
  Graph drive;
  for (int i = 0; i < kPoses; ++i) {
    const VertexIndex pose = drive.add_vertex<VertexSe2>(VertexId(i), {0, 0, 0});
    drive.set_stamp(pose, Stamp::from_seconds(0.2 * i));
    if (i > 0) drive.add_edge(EdgeSe2{}, {pose - 1, pose}, Eigen::Matrix3d::Identity());
  }
  std::vector<RangeBias> reflections(kSatellites, RangeBias(kRate));
  std::vector<RangeBias> orbits(kSatellites, RangeBias(120 * kRate));
  for (int i = 0; i < kPoses; i += kRate) {
    for (int satellite = 0; satellite < kSatellites; ++satellite) {
      const auto s = static_cast<std::size_t>(satellite);
      if (is_seen(i, satellite))
        drive.add_edge(EdgeBiasedRange{}, {i, reflections[s].at(i, drive), orbits[s].at(i, drive)},
                       Eigen::Matrix<double, 1, 1>(1));
    }
  }
  Structure structure;
  structure.build(drive, nobody(drive));
  CHECK(structure.ordering() == "time");
}

TEST_CASE("ordering: GNSS nodes of a drive are eliminated just before their poses") {
  Graph drive;
  for (int i = 0; i < 100; ++i) {
    drive.add_vertex<VertexSe2>(VertexId(i), {0, 0, 0});
    if (i > 0) drive.add_edge(EdgeSe2{}, {i - 1, i}, Eigen::Matrix3d::Identity());
  }
  for (int i = 0; i < 100; i += 10) {
    const VertexIndex node = drive.add_vertex<VertexSe2>(VertexId(1000 + i), {0, 0, 0});
    drive.add_edge(EdgeSe2{}, {node, i}, Eigen::Matrix3d::Identity());
    drive.add_edge(EdgePriorSe2{}, {node}, Eigen::Matrix3d::Identity());
  }
  Structure structure;
  structure.build(drive, nobody(drive));
  CHECK(structure.ordering() == "leaves first");
  for (int i = 0; i < 100; i += 10) {
    CHECK(structure.column_of(100 + i / 10) == structure.column_of(i) - 1);
  }
  check_against_dense(drive, structure, nobody(drive));
}

TEST_CASE("normal equations: multiply, diagonal and damping agree with the dense matrix") {
  const Graph graph = calibrated_chain(12);
  Structure structure;
  structure.build(graph, nobody(graph));
  NormalEquations equations(graph, structure);
  equations.linearize(graph.values());
  const ScalarPattern<int> scalar = to_scalar<int>(structure.pattern());
  const auto n = static_cast<Eigen::Index>(structure.pattern().dimension());
  const auto dense = [&](std::span<const double> values) {
    Eigen::MatrixXd upper = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      for (int k = scalar.column[static_cast<std::size_t>(j)];
           k < scalar.column[static_cast<std::size_t>(j) + 1]; ++k)
        upper(scalar.row[static_cast<std::size_t>(k)], j) = values[static_cast<std::size_t>(k)];
    }
    return Eigen::MatrixXd(upper.selfadjointView<Eigen::Upper>());
  };
  const Eigen::MatrixXd h = dense(equations.hessian());
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, -1, 2);
  Eigen::VectorXd product;
  equations.multiply(x, product);
  CHECK(relative_difference(product, h * x) < 1e-14);
  CHECK(equations.diagonal() == h.diagonal());
  std::vector<double> damped;
  equations.add_to_diagonal(x, damped);
  CHECK(relative_difference(dense(damped), h + Eigen::MatrixXd(x.asDiagonal())) < 1e-15);
}

}  // namespace structure_test
