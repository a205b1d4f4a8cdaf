// Fixed lag: a prefix is replaced by a prior, structure and optimiser follow, and the window has the
// estimates of the whole graph.
#include <array>
#include <numeric>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/window/incremental.hpp>
#include <waymark/formats/graph/graph_document.hpp>

#include "support/dense.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/replay.hpp"
#include "support/scalar_types.hpp"

namespace incremental_test {

using namespace waymark;
using namespace waymark::formats;
using namespace waymark_test;

namespace {

/// p_b - p_a = measured: linear.
struct EdgeStep {
  static constexpr std::string_view kTag = "EDGE_STEP";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexXy, VertexXy>;
  static constexpr auto fields() { return std::array{field<&EdgeStep::measured>("measured")}; }
  template <typename T>
  Vector2<T> error(const Vector2<T>& a, const Vector2<T>& b) const {
    return Vector2<T>(b - a) - constant_vector<T>(measured);
  }
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
};

/// p = measured.
struct EdgePosition {
  static constexpr std::string_view kTag = "EDGE_POSITION";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexXy>;
  static constexpr auto fields() { return std::array{field<&EdgePosition::measured>("measured")}; }
  template <typename T>
  Vector2<T> error(const Vector2<T>& p) const {
    return p - constant_vector<T>(measured);
  }
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
};

/// p_c - 2 p_b + p_a = 0: constant velocity; its remainder joins two vertices.
struct EdgeSmooth {
  static constexpr std::string_view kTag = "EDGE_SMOOTH";
  static constexpr int kErrorDimension = 2;
  using Vertices = VertexList<VertexXy, VertexXy, VertexXy>;
  static constexpr std::array<Field<EdgeSmooth>, 0> fields() { return {}; }
  template <typename T>
  Vector2<T> error(const Vector2<T>& a, const Vector2<T>& b, const Vector2<T>& c) const {
    return Vector2<T>(c - T(2.0) * b + a);
  }
};

Summary minimise(Graph& graph) {
  OptimizerOptions options;
  options.decrement_tolerance = 1e-18;
  Summary summary = optimize(graph, *registry().make_algorithm("gauss_newton"),
                             *registry().make_linear_solver("eigen"), options);
  REQUIRE((summary.converged() || summary.termination == Termination::stalled));
  return summary;
}

IncrementalOptimizer make_incremental(Graph& graph, OptimizerOptions options = {}) {
  return {graph, registry().make_algorithm("gauss_newton"), registry().make_linear_solver("block_cholesky"),
          std::move(options)};
}

Eigen::VectorXd value_of(const Graph& graph, VertexId id) {
  const auto value = graph.value(*graph.find(id));
  return Eigen::Map<const Eigen::VectorXd>(value.data(), static_cast<Eigen::Index>(value.size()));
}

Eigen::MatrixXd covariance_of(const Graph& graph, VertexId id) {
  return marginal_covariances(graph, std::array{*graph.find(id)})[0];
}

/// Positions of a random walk with steps, fixes and smoothness.
Graph linear_walk(int points) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> unit(0, 1);
  Graph graph;
  for (int i = 0; i < points; ++i) {
    graph.add_vertex<VertexXy>(VertexId(i), {1.0 * i, 0.3 * i});
    const Eigen::Matrix2d information{{4, 1}, {1, 3 + 0.1 * i}};
    if (i > 0) graph.add_edge(EdgeStep{{1 + 0.1 * unit(random), unit(random)}}, {i - 1, i}, information);
    if (i > 1) graph.add_edge(EdgeSmooth{}, {i - 2, i - 1, i}, 2 * information);
    if (i % 5 == 0) graph.add_edge(EdgePosition{{i + unit(random), unit(random)}}, {i}, 0.3 * information);
  }
  return graph;
}

std::vector<VertexIndex> in_order(const Graph& graph) {
  std::vector<VertexIndex> order(graph.vertex_count());
  std::iota(order.begin(), order.end(), 0);
  return order;
}

/// The vertices of a drive as they come: the origin, then each pose followed by its GNSS nodes.
std::vector<VertexIndex> as_driven(const Drive& drive, int poses) {
  std::vector<VertexIndex> order;
  std::vector<VertexIndex> later;
  for (VertexIndex v = poses; v < static_cast<VertexIndex>(drive.graph.vertex_count()); ++v)
    (drive.graph.fixed(v) ? order : later).push_back(v);
  auto node = later.begin();
  for (VertexIndex pose = 0; pose < poses; ++pose) {
    order.push_back(pose);
    if (pose % 25 == 0 && node != later.end()) order.push_back(*node++);
  }
  return order;
}

Drive gnss_drive(std::string_view modeling, int poses) {
  Drive drive = make_drive(registry(), poses);
  drive.add_fixes(registry(), modeling);
  return drive;
}

/// Marginalises the first vertices of a graph at its minimum; the remaining graph has the same minimum,
/// chi2 and covariances.
void check_minimum_stays(Graph graph, std::initializer_list<VertexIndex> counts) {
  minimise(graph);
  const Graph whole = graph;
  const std::vector<char> held = find_gauge(whole).held;
  std::vector<VertexIndex> all(whole.vertex_count());
  std::iota(all.begin(), all.end(), 0);
  const CovarianceBlocks covariances = marginal_covariances(whole, all);
  double constant = 0;
  std::vector<char> known = held;
  for (const VertexIndex count : counts) {
    const Marginalization result = marginalize_prefix(graph, count, known);
    known.assign(graph.vertex_count(), 0);
    constant += result.constant;
    CHECK(graph.chi2() + constant == Approx(whole.chi2()).epsilon(1e-8));
  }
  minimise(graph);
  CHECK(graph.chi2() + constant == Approx(whole.chi2()).epsilon(1e-8));
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v) {
    const VertexIndex before = *whole.find(graph.id(v));
    INFO("vertex " << to_string(graph.id(v)));
    CHECK((value_of(graph, graph.id(v)) - value_of(whole, graph.id(v))).norm() < 1e-7);
    const Eigen::MatrixXd& expected = covariances[static_cast<std::size_t>(before)];
    CHECK((covariance_of(graph, graph.id(v)) - expected).norm() <= 1e-8 * expected.norm());
  }
}

/// H, g and chi2 of a structure equal dense assembly, and so does one that is built anew.
void check_against_dense(const Graph& graph, const Structure& structure) {
  const std::vector<char> nobody(graph.vertex_count(), 0);
  NormalEquations equations(graph, structure);
  CHECK(equations.linearize(graph.values()) == Approx(graph.chi2()).epsilon(1e-12));
  const DenseSystem expected = assemble_dense(graph, nobody);
  const DenseSystem got = spread_out(graph, structure, equations);
  REQUIRE(got.start == expected.start);
  CHECK(relative_difference(got.hessian, expected.hessian) < 1e-13);
  CHECK(relative_difference(got.gradient, expected.gradient) < 1e-12);
  Structure anew;
  anew.build(graph, nobody);
  NormalEquations anew_equations(graph, anew);
  anew_equations.linearize(graph.values());
  CHECK(relative_difference(spread_out(graph, anew, anew_equations).hessian, got.hessian) < 1e-13);
}

}  // namespace

TEST_CASE("incremental: a sliding window over a linear problem equals the batch solution at every step") {
  const Graph source = linear_walk(60);
  Replay replay(source, in_order(source));
  Graph batch;
  Replay batch_replay(source, in_order(source));
  Graph window;
  IncrementalOptimizer optimizer = make_incremental(window);
  constexpr std::size_t kWindow = 8;
  for (int newest = 0; !replay.done(); ++newest) {
    replay.append_to(window);
    batch_replay.append_to(batch);
    if (newest < 2) continue;  // a single point tells nothing of the gauge's turn
    INFO("newest point " << newest);
    REQUIRE(optimizer.update().converged());
    minimise(batch);
    CHECK((value_of(window, VertexId{newest}) - value_of(batch, VertexId{newest})).norm() < 1e-9);
    CHECK(relative_difference(covariance_of(window, VertexId{newest}),
                              covariance_of(batch, VertexId{newest})) < 1e-9);
    CHECK(window.chi2() + optimizer.dropped_chi2() == Approx(batch.chi2()).epsilon(1e-9));
    if (window.vertex_count() > kWindow) {
      // The prior joins two points, and replaces the one before.
      CHECK(optimizer.drop_prefix(1).priors >= 1);
      CHECK(window.vertex_count() == kWindow);
    }
  }
}

TEST_CASE("marginalisation: exact for linear problems wherever they stand, in one go or bit by bit") {
  Graph whole = linear_walk(30);
  Graph at_once = whole;
  Graph in_parts = whole;
  const double constant = marginalize_prefix(at_once, 20).constant;
  double constant_in_parts = 0;
  for (int i = 0; i < 10; ++i) constant_in_parts += marginalize_prefix(in_parts, 2).constant;
  minimise(whole);
  minimise(at_once);
  minimise(in_parts);
  CHECK(at_once.chi2() + constant == Approx(whole.chi2()).epsilon(1e-10));
  CHECK(in_parts.chi2() + constant_in_parts == Approx(whole.chi2()).epsilon(1e-10));
  for (int number = 20; number < 30; ++number) {
    const VertexId id{number};
    CHECK((value_of(at_once, id) - value_of(whole, id)).norm() < 1e-9);
    CHECK((value_of(in_parts, id) - value_of(whole, id)).norm() < 1e-9);
  }
}

TEST_CASE("marginalisation: at the optimum of a drive, optimum, chi2 and covariances of the rest stay") {
  const std::string modeling = GENERATE("g1", "g2", "g3");
  check_minimum_stays(gnss_drive(modeling, 200).graph, {30, 1, 40});
}

TEST_CASE("marginalisation: with loops, and a held first vertex that anchors from then on") {
  check_minimum_stays(noisy_circle(30), {3, 4});
  check_minimum_stays(grid_walk(80, 5), {20, 10});
}

TEST_CASE("marginalisation: robust weights and second-order terms at the optimum are kept") {
  Graph graph = noisy_circle(30);
  graph.batch(0).set_loss(Loss{"cauchy", registry().find_loss("cauchy")->evaluate, 2});
  check_minimum_stays(graph, {5, 3});
}

TEST_CASE("marginalisation: vertices of several sizes, and a dense state that stays though it came first") {
  Graph graph;
  const VertexIndex scale = graph.add_vertex<VertexScale>(VertexId{1000}, {1.02});
  for (int i = 0; i < 30; ++i) {
    const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId(i), {1.01 * i, 0.05 * i, 0.04 * i});
    if (i > 0)
      graph.add_edge(EdgeScaledOdometry{1.0, 0.05}, {pose - 1, scale, pose}, pose_information(0.1, 0.02));
    if (i % 7 == 0)
      graph.add_edge(EdgePriorSe2{{0.9 * i, 0.1 * i, 0.05 * i}}, {pose}, Eigen::Matrix3d::Identity());
  }
  check_minimum_stays(graph, {10, 5});
  const Marginalization result = marginalize_prefix(graph, 10);
  CHECK(result.removal.new_index[0] == 0);
  CHECK(graph.vertex_count() == 22);
  CHECK(graph.batch(graph.batch_count() - 1).vertices(0).size() == 2);  // the next pose and the scale
}

TEST_CASE("marginalisation: what nothing anchors stays so, for as long as the window slides") {
  Graph graph = noisy_circle(60);
  minimise(graph);
  const double chi2 = graph.chi2();
  double constant = 0;
  for (int i = 0; i < 50; ++i) constant += marginalize_prefix(graph, 1).constant;
  const Gauge gauge = find_gauge(graph);
  CHECK(gauge.messages.size() == 1);
  CHECK(graph.chi2() + constant == Approx(chi2).epsilon(1e-8));
  const std::vector<double> before = graph.values();
  minimise(graph);
  for (std::size_t i = 0; i < before.size(); ++i) CHECK(graph.values()[i] == Approx(before[i]).margin(1e-7));
}

TEST_CASE("marginalisation: parts that are not joined get priors of their own") {
  Graph graph;
  for (int part = 0; part < 2; ++part) {
    for (int i = 0; i < 3; ++i) graph.add_vertex<VertexXy>(VertexId(10 * part + i), {1.0 * i, 5.0 * part});
  }
  for (const int first : {0, 3}) {
    graph.add_edge(EdgePosition{{0, 0}}, {first}, Eigen::Matrix2d::Identity());
    graph.add_edge(EdgeStep{{1, 0}}, {first, first + 1}, Eigen::Matrix2d::Identity());
    graph.add_edge(EdgeStep{{1, 0}}, {first + 1, first + 2}, Eigen::Matrix2d::Identity());
  }
  SECTION("one part goes whole: nothing is left of it") {
    CHECK(marginalize_prefix(graph, 3).priors == 0);
    CHECK(graph.vertex_count() == 3);
    CHECK(graph.edge_count() == 3);
  }
  SECTION("the second is cut") {
    CHECK(marginalize_prefix(graph, 5).priors == 1);
    CHECK(graph.vertex_count() == 1);
    CHECK(graph.id(0) == VertexId{12});
    // A position of variance 1 and two steps of variance 1.
    const EdgeBatchBase& priors = graph.batch(gaussian_prior_type());
    CHECK(relative_difference(priors.information(0), Eigen::Matrix2d(Eigen::Matrix2d::Identity() / 3)) <
          1e-12);
  }
}

TEST_CASE("marginalisation: a fixed origin stays while edges of the window need it") {
  Drive drive = gnss_drive("g1", 60);
  Replay replay(drive.graph, as_driven(drive, 60));
  Graph graph;
  while (!replay.done()) replay.append_to(graph);
  REQUIRE(graph.fixed(0));
  const VertexId origin = graph.id(0);
  SECTION("fixes ahead") {
    const Marginalization result = marginalize_prefix(graph, 30);
    CHECK(graph.id(0) == origin);
    CHECK(graph.fixed(0));
    CHECK(result.removal.new_index[0] == 0);
    CHECK(result.removal.new_index[29] == -1);
    CHECK(result.removal.new_index[30] == 1);
    CHECK(graph.vertex_count() == 32);
  }
  SECTION("no fixes ahead") {
    const Marginalization result = marginalize_prefix(graph, 55);
    CHECK(!graph.find(origin).has_value());
    CHECK(graph.vertex_count() == 6);
  }
}

TEST_CASE(
    "marginalisation: a landmark stays while the window sees it, and what the map says of it counts once") {
  // Nodes a second apart before one landmark, whose place the map knows to 0.5 m. However many are dropped, the
  // landmark is known as from all of them together.
  Graph graph;
  const Eigen::Matrix2d unit = Eigen::Matrix2d::Identity();
  constexpr int kNodes = 30;
  VertexIndex landmark = -1;
  for (int i = 0; i < kNodes; ++i) {
    const VertexIndex node = graph.add_vertex<VertexXy>(graph.free_id(), {0.1 * i, 0});
    graph.set_stamp(node, Stamp::from_seconds(i));
    if (i == 0) {
      graph.add_edge(EdgePosition{{0, 0}}, {node}, unit);
      landmark = graph.add_vertex<VertexXy>(graph.free_id(), {10, 0});
      graph.add_edge(EdgePosition{{10, 0}}, {landmark}, 4 * unit);
    } else {
      graph.add_edge(EdgeStep{{0.1, 0}}, {i == 1 ? 0 : node - 1, node}, 100 * unit);
    }
    graph.add_edge(EdgeStep{{10 - 0.1 * i, 0}}, {node, landmark}, 25 * unit);
  }
  const VertexId id = graph.id(landmark);
  const VertexIndex last = static_cast<VertexIndex>(graph.vertex_count()) - 1;
  const Eigen::MatrixXd expected = marginal_covariances(graph, std::array{landmark})[0];
  const Eigen::MatrixXd pose = marginal_covariances(graph, std::array{last})[0];
  for (int dropped = 0; dropped < 20; ++dropped) {
    const VertexIndex first = graph.find(id) == 0 ? 1 : 0;
    (void)marginalize_prefix(graph, first == 0 ? 1 : 2);
  }
  const std::optional<VertexIndex> kept = graph.find(id);
  REQUIRE(kept);
  CHECK(graph.vertex_count() < kNodes - 15);
  const VertexIndex newest = static_cast<VertexIndex>(graph.vertex_count()) - 1;
  CHECK((marginal_covariances(graph, std::array{*kept})[0] - expected).norm() < 1e-9);
  CHECK((marginal_covariances(graph, std::array{newest})[0] - pose).norm() < 1e-9);
}

TEST_CASE("incremental: a window running along a drive stays close to the batch solution") {
  // The drive's first 2 s come at once: a single fix leaves the heading undetermined. 16 s of drive
  // in the window, two steps an update. Bound: a tenth of the batch solution's own standard
  // deviation, for the last pose, which both know from the same measurements.
  const std::string modeling = GENERATE("g1", "g2");
  constexpr int kPoses = 1500;
  constexpr std::int64_t kWindow = 400;
  const Drive drive = gnss_drive(modeling, kPoses);
  Graph batch = drive.graph;
  minimise(batch);
  Replay replay(drive.graph, as_driven(drive, kPoses));
  Graph window;
  OptimizerOptions options;
  options.max_iterations = 2;
  IncrementalOptimizer optimizer = make_incremental(window, options);
  std::int64_t newest = 0;
  while (!replay.done()) {
    const VertexIndex added = replay.append_to(window);
    if (window.id(added) < VertexId{kPoses} && !window.fixed(added)) newest = to_number(window.id(added));
    if (newest < 50 || newest % 5 != 0) continue;
    const Summary summary = optimizer.update();
    REQUIRE((summary.converged() || summary.termination == Termination::max_iterations));
    if (newest >= kWindow) {
      if (const auto oldest = window.find(VertexId{newest - kWindow})) (void)optimizer.drop_prefix(*oldest);
    }
  }
  CHECK(window.vertex_count() < kWindow + 30);
  CHECK(optimizer.structure().ordering() != "amd");
  REQUIRE(optimizer.update().unknowns > 0);
  constexpr VertexId kNewest{kPoses - 1};
  const Eigen::Vector3d difference = value_of(window, kNewest) - value_of(batch, kNewest);
  const Eigen::Matrix3d covariance = covariance_of(batch, kNewest);
  CHECK(std::sqrt(difference.dot(covariance.ldlt().solve(difference))) < 0.1);
  CHECK(relative_difference(covariance_of(window, kNewest), covariance) < 0.05);
}

TEST_CASE("incremental: appended, removed, appended: the structure equals one built anew") {
  const unsigned seed = GENERATE(range(1u, 13u));
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const Eigen::Matrix3d information = pose_information(0.1, 0.05);
  Graph graph;
  const bool calibrated = seed % 3 == 0;
  const bool with_origin = seed % 2 == 0;
  const bool leaves = seed % 4 < 2;
  int next_id = 0;
  if (with_origin) {
    graph.add_vertex<VertexSe2>(VertexId{next_id++}, {0, 0, 0});
    graph.set_fixed(0, true);
  }
  const VertexId scale{next_id};
  if (calibrated) graph.add_vertex<VertexScale>(VertexId{next_id++}, {1.0});
  std::vector<VertexId> poses;
  const auto append_pose = [&] {
    const double t = static_cast<double>(next_id);
    const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{next_id}, {t, std::sin(t), 0.1 * t});
    const auto last = poses.empty() ? std::nullopt : graph.find(poses.back());
    if (!last || below(15) == 0) {  // a component of its own
      graph.add_edge(EdgePriorSe2{{t, 0, 0}}, {pose}, information);
    } else if (calibrated) {
      graph.add_edge(EdgeScaledOdometry{1, 0.1}, {*last, *graph.find(scale), pose}, information);
    } else {
      graph.add_edge(EdgeSe2{{1, 0, 0.1}}, {*last, pose}, information);
    }
    poses.push_back(VertexId{next_id++});
    if (with_origin && below(4) == 0) graph.add_edge(EdgeSe2Log{{t, 0, 0}}, {0, pose}, information);
    if (leaves && below(3) == 0) {
      const VertexIndex node = graph.add_vertex<VertexSe2>(VertexId{next_id++}, {t, 0, 0});
      graph.add_edge(EdgeSe2{}, {node, pose}, information);
      graph.add_edge(EdgePriorSe2{{t, 0, 0}}, {node}, information);
    }
    if (below(5) == 0) {
      const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId{next_id++}, {t, 2});
      graph.add_edge(EdgeSe2Xy{{0, 2}}, {pose, landmark}, Eigen::Matrix2d::Identity());
    }
    if (below(6) == 0) graph.add_vertex<VertexSe2>(VertexId{next_id++}, {0, 0, 0});  // without edges
    const auto other = static_cast<VertexIndex>(below(graph.vertex_count()));
    if (other != pose && graph.vertex_type(other).tag == VertexXy::kTag)
      graph.add_edge(EdgeSe2Xy{{1, 2}}, {pose, other}, Eigen::Matrix2d::Identity());
    if (other != pose && graph.vertex_type(other).tag == VertexSe2::kTag && below(3) == 0)
      graph.add_edge(EdgeSe2{{1, 2, 0}}, {pose, other}, information);
  };
  for (int i = 0; i < 25; ++i) append_pose();
  const auto nobody = [&] { return std::vector<char>(graph.vertex_count(), 0); };
  Structure structure;
  structure.build(graph, nobody());
  for (int round = 0; round < 12; ++round) {
    const auto version = structure.pattern().version;
    if (below(2) == 0) {
      for (std::size_t k = below(5) + 1; k > 0; --k) append_pose();
      structure.extend(graph, nobody());
    } else {
      const auto count = static_cast<VertexIndex>(below(graph.vertex_count() / 2 + 1));
      const Marginalization result = marginalize_prefix(graph, count);
      structure.remove(graph, result.removal, nobody());
    }
    CHECK(structure.pattern().version != version);
    check_against_dense(graph, structure);
  }
}

TEST_CASE(
    "incremental: the columns that stay keep their order, and their pattern where no prior joins them") {
  Graph graph = grid_walk(300, 15);
  Structure structure;
  structure.build(graph, std::vector<char>(graph.vertex_count(), 0));
  REQUIRE(structure.ordering() == "amd");
  std::vector<VertexId> order;
  for (int j = 0; j < structure.pattern().columns(); ++j) order.push_back(graph.id(structure.vertex_of(j)));
  const Marginalization result = marginalize_prefix(graph, 60);
  structure.remove(graph, result.removal, std::vector<char>(graph.vertex_count(), 0));
  int column = 0;
  for (const VertexId id : order) {
    if (const auto v = graph.find(id)) CHECK(structure.column_of(*v) == column++);
  }
  CHECK(column == structure.pattern().columns());
  check_against_dense(graph, structure);
}

TEST_CASE(
    "incremental: past the chunks of a long chain, same bits as built anew, for any number of threads") {
  Drive drive = make_drive(registry(), 10'000);
  drive.graph.add_edge(EdgePriorSe2{}, {0}, Eigen::Matrix3d::Identity());
  Graph graph = std::move(drive.graph);
  Structure structure;
  structure.build(graph, std::vector<char>(graph.vertex_count(), 0));
  for (const VertexIndex count : {1500, 3000}) {
    const Marginalization result = marginalize_prefix(graph, count);
    structure.remove(graph, result.removal, std::vector<char>(graph.vertex_count(), 0));
  }
  Structure anew;
  anew.build(graph, std::vector<char>(graph.vertex_count(), 0));
  NormalEquations followed(graph, structure);
  NormalEquations expected(graph, anew);
  ThreadPool pool(2);
  followed.set_threads(&pool);
  CHECK(followed.linearize(graph.values()) == expected.linearize(graph.values()));
  CHECK(structure.pattern().row == anew.pattern().row);
  REQUIRE(followed.hessian().size() == expected.hessian().size());
  CHECK(std::equal(followed.hessian().begin(), followed.hessian().end(), expected.hessian().begin()));
  CHECK(followed.gradient() == expected.gradient());
}

TEST_CASE("incremental: ids, stamps, fixed marks and losses of what stays are as they were") {
  Graph graph;
  const std::array<VertexId, 6> ids = {VertexId{7}, VertexId{-3}, VertexId{1LL << 40},
                                       VertexId{2}, VertexId{1},  VertexId{0}};
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto v = graph.add_vertex<VertexXy>(ids[i], {1.0 * static_cast<double>(i), 2});
    if (i % 2 == 0) graph.set_stamp(v, Stamp{static_cast<std::int64_t>(100 + i)});
  }
  graph.set_fixed(5, true);
  const auto evaluate = registry().find_loss("huber")->evaluate;
  for (int i = 0; i < 5; ++i) {
    graph.add_edge(EdgeStep{{i + 0.5, 0}}, {i, i + 1}, Eigen::Matrix2d::Identity());
    if (i != 2) graph.batch(0).set_loss(static_cast<std::size_t>(i), Loss{"huber", evaluate, 1.0 + i});
  }
  graph.add_edge(EdgePosition{{1, 1}}, {4}, Eigen::Matrix2d::Identity());
  const auto version = graph.structure_version();
  std::vector<char> gone(6, 0);
  gone[0] = gone[1] = 1;
  const Removal removal = graph.remove_vertices(gone);
  CHECK(graph.structure_version() != version);
  CHECK(removal.new_index == std::vector<VertexIndex>{-1, -1, 0, 1, 2, 3});
  CHECK(removal.kept_edges == std::vector<std::size_t>{3, 1});
  REQUIRE(graph.vertex_count() == 4);
  for (VertexIndex v = 0; v < 4; ++v) {
    const auto old = static_cast<std::size_t>(v) + 2;
    CHECK(graph.id(v) == ids[old]);
    CHECK(graph.find(ids[old]) == v);
    CHECK(graph.value(v)[0] == static_cast<double>(old));
    CHECK(graph.stamp(v).has_value() == (old % 2 == 0));
    if (old % 2 == 0) CHECK(graph.stamp(v)->nanoseconds == static_cast<std::int64_t>(100 + old));
    CHECK(graph.fixed(v) == (old == 5));
  }
  CHECK(!graph.find(VertexId{7}).has_value());
  CHECK(!graph.find(VertexId{-3}).has_value());
  for (std::size_t e = 0; e < 3; ++e) {
    std::vector<double> fields;
    graph.batch(0).fields(e, fields);
    CHECK(fields[0] == static_cast<double>(e) + 2.5);
    CHECK(graph.batch(0).vertices(e)[0] == static_cast<VertexIndex>(e));
    if (e == 0) {
      CHECK(graph.batch(0).loss(e) == nullptr);
    } else {
      REQUIRE(graph.batch(0).loss(e) != nullptr);
      CHECK(graph.batch(0).loss(e)->scale == 3.0 + static_cast<double>(e));
    }
  }
  // An id that went may come again.
  CHECK(graph.add_vertex<VertexXy>(VertexId{7}, {0, 0}) == 4);
  CHECK(graph.find(VertexId{7}) == 4);
}

TEST_CASE("incremental: errors say what is wrong and leave the graph as it was") {
  Graph graph;
  for (int i = 0; i < 4; ++i) graph.add_vertex<VertexSe2>(VertexId(10 + i), {1.0 * i, 0, 0});
  graph.add_edge(EdgeSe2{{1, 0, 0}}, {0, 1}, Eigen::Matrix3d::Identity());
  graph.add_edge(EdgeSe2{{1, 0, 0}}, {2, 3}, Eigen::Matrix3d::Identity());
  SECTION("a count beyond the graph") {
    CHECK_THROWS_AS(marginalize_prefix(graph, 5), UsageError);
    CHECK_THROWS_AS(marginalize_prefix(graph, -1), UsageError);
  }
  SECTION("a part that nothing determines") {
    CHECK_THROWS_WITH(marginalize_prefix(graph, 2),
                      Catch::Contains("vertex 11 cannot be marginalised") && Catch::Contains("find_gauge"));
    // Held, it is known.
    CHECK(marginalize_prefix(graph, 2, find_gauge(graph).held).priors == 0);
    CHECK(graph.vertex_count() == 2);
    return;
  }
  SECTION("a long part that nothing determines") {
    Graph circle = noisy_circle(100);
    CHECK_THROWS_WITH(marginalize_prefix(circle, 100), Catch::Contains("vertex 99 cannot be marginalised"));
  }
  SECTION("an error that is not finite") {
    graph.set_value(0, std::array<double, 3>{std::nan(""), 0, 0});
    CHECK_THROWS_WITH(marginalize_prefix(graph, 1), Catch::Contains("EDGE_SE2 at vertex 10"));
  }
  SECTION("a loss on all priors") {
    graph.batch(gaussian_prior_type()).set_loss(Loss{"huber", registry().find_loss("huber")->evaluate, 1});
    CHECK_THROWS_AS(marginalize_prefix(graph, 1), UsageError);
  }
  SECTION("a structure that is behind") {
    Structure structure;
    structure.build(graph, std::vector<char>(4, 0));
    const VertexIndex late = graph.add_vertex<VertexSe2>(VertexId{20}, {4, 0, 0});
    graph.add_edge(EdgeSe2{{1, 0, 0}}, {3, late}, Eigen::Matrix3d::Identity());
    Graph copy = graph;
    const Marginalization result = marginalize_prefix(copy, 1);
    CHECK_THROWS_AS(structure.remove(copy, result.removal, std::vector<char>(4, 0)), UsageError);
    return;
  }
  CHECK(graph.vertex_count() == 4);
  CHECK(graph.batch(0).size() == 2);
}

TEST_CASE("incremental: a window with its prior passes through a .graph file unchanged") {
  GraphDocument document;
  document.graph = gnss_drive("g1", 80).graph;
  (void)marginalize_prefix(document.graph, 27);
  const std::string text = write_graph(document, registry());
  CHECK(text.find("EDGE_GAUSSIAN_PRIOR 1 27 ") != std::string::npos);
  GraphDocument again = read_graph(text, "window.graph", registry());
  CHECK(again.graph.chi2() == document.graph.chi2());
  CHECK(again.graph.values() == document.graph.values());
  CHECK(write_graph(again, registry()) == text);
  minimise(document.graph);
  minimise(again.graph);
  CHECK(again.graph.values() == document.graph.values());
}

}  // namespace incremental_test
