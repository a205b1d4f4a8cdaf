// The default configuration: its first guess, when it tries others, and that it survives guesses
// that defeat every algorithm.
#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/named_start.hpp>
#include <waymark/types_se2/g2o_edges.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/spoiling.hpp"

namespace multi_start_test {

using namespace waymark;
using namespace waymark_test;

namespace {

MultiStartSummary optimize_default(Graph& graph, const TypeRegistry& registry,
                                   const std::string& algorithm = "dogleg", int max_iterations = 500) {
  OptimizerOptions options;
  options.max_iterations = max_iterations;
  return optimize_from_best_start(graph, registry.starts(), *registry.make_algorithm(algorithm),
                                  *registry.make_linear_solver(registry.linear_solvers().front().type.name),
                                  options);
}

Summary optimize_as_is(Graph& graph, const TypeRegistry& registry, const std::string& algorithm,
                       int max_iterations = 200) {
  OptimizerOptions options;
  options.max_iterations = max_iterations;
  return optimize(graph, *registry.make_algorithm(algorithm),
                  *registry.make_linear_solver(registry.linear_solvers().front().type.name), options);
}

constexpr const char* kAlgorithms[] = {"gauss_newton", "levenberg_marquardt", "dogleg"};
constexpr int kPoses = 4000;

/// A small drive in UTM coordinates, dead-reckoned from its first fix, under a modeling.
Graph utm_drive(const TypeRegistry& registry, const std::string& modeling) {
  const Eigen::Vector2d far(670000, 5700000);
  Drive drive = make_drive(registry, kPoses);
  for (VertexIndex v = 0; v < kPoses; ++v) {
    const auto value = drive.graph.value(v);
    drive.graph.set_value(v, std::array{value[0] + far[0], value[1] + far[1], value[2]});
  }
  for (Fix& fix : drive.fixes) fix.position += far;
  drive.add_fixes(registry, modeling);
  return std::move(drive.graph);
}

/// A chain of 30 poses about a metre apart, with a fix of 2 m at every twentieth and three landmarks of which only the
/// direction is seen. Values begin metres beside the truth.
Graph bearing_drive(unsigned seed) {
  constexpr int kPosesOfChain = 30;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<Pose2<double>> poses = {Pose2<double>(0, 0, 0)};
  for (int i = 1; i < kPosesOfChain; ++i)
    poses.push_back(compose(poses.back(), Pose2<double>(1, 0, 0.02 + 0.05 * normal(random))));
  Graph graph;
  Pose2<double> reckoned(0, 0, 0);
  std::vector<VertexIndex> chain;
  for (int i = 0; i < kPosesOfChain; ++i) {
    const auto at = static_cast<std::size_t>(i);
    Eigen::Vector3d way(0, 0, 0);
    if (i > 0)
      way = between(poses[at - 1], poses[at]).vector() +
            Eigen::Vector3d(0.05 * normal(random), 0.05 * normal(random), 0.01 + 0.02 * normal(random));
    reckoned = compose(reckoned, Pose2<double>(way[0], way[1], way[2]));
    const Eigen::Vector3d begin = reckoned.vector();
    chain.push_back(graph.add_vertex<VertexSe2>(VertexId(i), {begin[0], begin[1], begin[2]}));
    if (i > 0) graph.add_edge(EdgeSe2{way}, {chain[at - 1], chain[at]}, pose_information(0.05, 0.02));
    if (i % 20 == 0)
      graph.add_edge(EdgePriorSe2Xy{poses[at].position + 2 * Eigen::Vector2d(normal(random), normal(random))},
                     {chain[at]}, 0.25 * Eigen::Matrix2d::Identity());
  }
  for (int l = 0; l < 3; ++l) {
    const auto beside = static_cast<std::size_t>(random() % kPosesOfChain);
    const Eigen::Vector2d place =
        poses[beside].position + 8 * Eigen::Vector2d(normal(random), normal(random));
    const Eigen::Vector2d begin = Eigen::Vector2d(10 * normal(random), 10 * normal(random));
    const VertexIndex landmark = graph.add_vertex<VertexXy>(VertexId(100 + l), {begin[0], begin[1]});
    for (std::size_t i = 0; i < poses.size(); i += 2) {
      const Eigen::Vector2d seen = rotate(-poses[i].heading, Eigen::Vector2d(place - poses[i].position));
      graph.add_edge(EdgeBearingSe2Xy{std::atan2(seen[1], seen[0]) + 0.02 * normal(random)},
                     {chain[i], landmark}, Eigen::Matrix<double, 1, 1>(2500));
    }
  }
  return graph;
}

/// Returns by how many standard deviations a note says that chi2 is above what is expected.
double deviations_told(const std::string& note) {
  const std::size_t is = note.find(" is ");
  REQUIRE(is != std::string::npos);
  return std::stod(note.substr(is + 4));
}

}  // namespace

TEST_CASE("default start: a good start is used as it is, and nothing else is tried") {
  const TypeRegistry registry = full_registry();
  Graph graph = utm_drive(registry, "g1");
  const MultiStartSummary result = optimize_default(graph, registry);
  CHECK(result.summary.converged());
  CHECK(result.start == "file");
  CHECK(result.trials.size() == 1);
  CHECK(result.summary.final_chi2 < plausible_chi2(graph));
  CHECK(result.summary.notes.empty());
}

TEST_CASE("default start: loops begin from the linear start, unless the values are good already") {
  const TypeRegistry registry = full_registry();
  Graph graph = noisy_circle(300);
  const MultiStartSummary first = optimize_default(graph, registry);
  CHECK(first.start == "linear");
  CHECK(first.trials.size() == 1);
  REQUIRE(first.summary.converged());
  const MultiStartSummary again = optimize_default(graph, registry);
  CHECK(again.start == "file");
  CHECK(again.summary.iterations <= 1);
}

TEST_CASE("default start: every spoilt start of a drive ends at the optimum, with every algorithm") {
  const TypeRegistry registry = full_registry();
  for (const std::string modeling : {"g1", "g2", "g3"}) {
    const Graph drive = utm_drive(registry, modeling);
    Graph reference = drive;
    const double optimum = optimize_as_is(reference, registry, "dogleg").final_chi2;
    REQUIRE(optimum < plausible_chi2(drive));
    for (const Spoiling& how : kSpoilings) {
      const Graph spoilt = spoil(drive, how, [](VertexIndex v) { return v >= kPoses; });
      for (const std::string algorithm : kAlgorithms) {
        Graph graph = spoilt;
        const MultiStartSummary result = optimize_default(graph, registry, algorithm);
        INFO(modeling << ", " << how.name << ", " << algorithm << ": " << result.summary.message);
        CHECK(result.summary.converged());
        CHECK(result.summary.final_chi2 == Approx(optimum).epsilon(1e-9));
      }
    }
  }
}

TEST_CASE("default start: the linear start serves every modeling and algorithm, and says that it won") {
  const TypeRegistry registry = full_registry();
  for (const std::string modeling : {"g1", "g2", "g3"}) {
    const Graph drive = utm_drive(registry, modeling);
    Graph graph = drive;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (VertexIndex v = 0; v < kPoses; ++v) {  // defeats any algorithm
      const auto value = drive.value(v);
      graph.set_value(
          v, std::array{value[0] + 300 * unit(random), value[1] + 300 * unit(random), 3 * unit(random)});
    }
    const MultiStartSummary result = optimize_default(graph, registry, "levenberg_marquardt");
    INFO(modeling);
    CHECK(result.start == "linear");
    REQUIRE(result.trials.size() == 2);
    CHECK(result.trials[0].start == "file");
    CHECK(result.trials[0].final_chi2 > plausible_chi2(graph));
    const std::string& note = result.summary.notes.back();
    CHECK(note.find("so others were tried: file (chi2 ") != std::string::npos);
    CHECK(note.find("; kept: linear") != std::string::npos);
    for (const std::string algorithm : kAlgorithms) {
      Graph anchored = drive;
      anchored.set_values(registry.make_start("linear", drive).values);
      const Summary summary = optimize_as_is(anchored, registry, algorithm);
      CHECK(summary.converged());
      CHECK(summary.final_chi2 == Approx(result.summary.final_chi2).epsilon(1e-9));
    }
  }
}

TEST_CASE("default start: a minimum that two starts agree on is believed, however high its chi2") {
  // Noise ten times larger than the information states: chi2 is a hundred times the degrees of freedom.
  const TypeRegistry registry = full_registry();
  const Graph drive = utm_drive(registry, "g1");
  Graph graph;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(drive.vertex_count()); ++v) {
    graph.add_vertex(drive.vertex_type(v), drive.id(v), drive.value(v));
    graph.set_fixed(v, drive.fixed(v));
  }
  for (std::size_t b = 0; b < drive.batch_count(); ++b) {
    for (std::size_t e = 0; e < drive.batch(b).size(); ++e) {
      std::vector<double> fields;
      drive.batch(b).fields(e, fields);
      graph.add_edge(drive.edge_type(b), drive.batch(b).vertices(e), fields,
                     100 * drive.batch(b).information(e));
    }
  }
  const MultiStartSummary result = optimize_default(graph, registry);
  CHECK(result.summary.converged());
  CHECK(result.summary.final_chi2 > plausible_chi2(graph));
  REQUIRE(result.trials.size() == 2);
  CHECK(result.trials[0].final_chi2 == Approx(result.trials[1].final_chi2).epsilon(1e-6));

  // chi2 has d degrees of freedom and the standard deviation (2 d)^(1/2)
  double freedom = 0;
  for (VertexIndex v = 0; v < static_cast<VertexIndex>(graph.vertex_count()); ++v)
    freedom -= graph.fixed(v) ? 0 : graph.vertex_type(v).tangent_size;
  for (std::size_t b = 0; b < graph.batch_count(); ++b)
    freedom += graph.edge_type(b).error_dimension * static_cast<double>(graph.batch(b).size());
  const std::string& note = result.summary.notes.back();
  INFO(note);
  CHECK(deviations_told(note) ==
        Approx((result.summary.final_chi2 - freedom) / std::sqrt(2 * freedom)).epsilon(0.005));
  CHECK(note.find("a lower minimum exists") != std::string::npos);
}

TEST_CASE("default start: what the gauge holds is no unknown of the chi2 that is expected") {
  // A triangle of three relative poses measures nine numbers. Six are unknown with its first pose held or fixed, or
  // with one heading held beside a fix that measures two more: three degrees of freedom each time. With priors of two
  // places nothing is held: 13 - 9. Beside a second triangle, and vertices without edges, there are as many again.
  const TypeRegistry registry = full_registry();
  const auto add_triangle = [](Graph& graph, int id) {
    std::vector<VertexIndex> poses;
    const std::array<Eigen::Vector3d, 3> places = {Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {1, 1, 0}};
    for (const Eigen::Vector3d& p : places) {
      poses.push_back(graph.add_vertex<VertexSe2>(VertexId(id), {p[0] + id, p[1], p[2]}));
      ++id;
    }
    const Eigen::Matrix3d information = pose_information(0.1, 0.03);
    graph.add_edge(EdgeSe2{{1, 0, 0}}, {poses[0], poses[1]}, information);
    graph.add_edge(EdgeSe2{{0, 1, 0}}, {poses[1], poses[2]}, information);
    graph.add_edge(EdgeSe2{{-1, -2, 0}}, {poses[2], poses[0]}, information);
    return poses;
  };
  const auto add_prior = [](Graph& graph, VertexIndex v) {
    const auto value = graph.value(v);
    graph.add_edge(EdgePriorSe2Xy{{value[0], value[1]}}, {v}, Eigen::Matrix2d::Identity());
  };
  const auto plausible = [](double freedom) { return Approx(freedom + 6 * std::sqrt(2 * freedom)); };
  Graph graph;
  const std::vector<VertexIndex> poses = add_triangle(graph, 1);
  graph.add_vertex<VertexSe2>(VertexId{1000}, {0, 0, 0});
  CHECK(plausible_chi2(graph) == plausible(3));
  Graph fixed = graph;
  fixed.set_fixed(poses[0], true);
  CHECK(plausible_chi2(fixed) == plausible(3));
  Graph partly = graph;
  add_prior(partly, poses[1]);
  CHECK(plausible_chi2(partly) == plausible(3));
  add_prior(partly, poses[2]);
  CHECK(plausible_chi2(partly) == plausible(4));
  Graph two = graph;
  add_triangle(two, 10);
  CHECK(plausible_chi2(two) == plausible(6));

  for (Graph* contradictory : {&graph, &fixed, &two}) {
    const MultiStartSummary result = optimize_default(*contradictory, registry);
    const double freedom = contradictory == &two ? 6 : 3;
    REQUIRE(result.summary.converged());
    const std::string& note = result.summary.notes.back();
    INFO(note);
    CHECK(deviations_told(note) ==
          Approx((result.summary.final_chi2 - freedom) / std::sqrt(2 * freedom)).epsilon(0.005));
    CHECK(note.find(freedom == 6 ? "above the 6 that are" : "above the 3 that are") != std::string::npos);
  }
}

TEST_CASE("default start: the unknowns are those of the gauge at the values that are kept") {
  // On one heap the fixes seem to leave the turn free, and nothing of it is held at the minimum: the heap is refused,
  // and chi2 is judged by the unknowns of the other start.
  const TypeRegistry registry = full_registry();
  Graph graph = utm_drive(registry, "g1");
  Graph heap = graph;
  for (VertexIndex v = 0; v < kPoses; ++v) heap.set_value(v, std::array{0.0, 0.0, 0.0});
  CHECK(plausible_chi2(heap) == plausible_chi2(graph));
}

TEST_CASE("default start: the message of a run in two parts counts the iterations of both") {
  // Two starts that defeat the algorithm: each is left after 30 steps, and the better one is continued.
  const TypeRegistry registry = full_registry();
  const Graph drive = utm_drive(registry, "g1");
  const auto scattered = [&](const Graph& graph, unsigned seed) {
    Graph values = graph;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (VertexIndex v = 0; v < kPoses; ++v) {
      const auto value = drive.value(v);
      values.set_value(
          v, std::array{value[0] + 300 * unit(random), value[1] + 300 * unit(random), 3 * unit(random)});
    }
    return values;
  };
  const RegistryTable<StartType> starts = {{{"other", "scattered too",
                                             [&](const Graph& graph) {
                                               return InitialValues{.values = scattered(graph, 6).values(),
                                                                    .note = ""};
                                             }},
                                            "test"}};
  Graph graph = scattered(drive, 5);
  OptimizerOptions options;
  options.max_iterations = 70;
  const MultiStartSummary result =
      optimize_from_best_start(graph, starts, *registry.make_algorithm("levenberg_marquardt"),
                               *registry.make_linear_solver("eigen"), options);
  REQUIRE(result.trials.size() == 2);
  REQUIRE(result.summary.termination == Termination::max_iterations);
  CHECK(result.trials[0].iterations + result.trials[1].iterations == 70);
  CHECK(result.summary.iterations == 40);
  CHECK(result.summary.message.find(
            "not converged after 40 iterations (70 with those from other initial guesses)") == 0);
}

TEST_CASE("default start: max_iterations bounds all runs together, and a cancelled run is the last") {
  const TypeRegistry registry = full_registry();
  const Graph spoilt = spoil(utm_drive(registry, "g1"), {"heading +180", 180, false},
                             [](VertexIndex v) { return v >= kPoses; });
  for (const int limit : {0, 1, 7}) {
    Graph graph = spoilt;
    const MultiStartSummary result = optimize_default(graph, registry, "dogleg", limit);
    CHECK(result.trials.size() == 1);
    CHECK(result.summary.iterations == limit);
    CHECK(result.summary.termination == Termination::max_iterations);
    CHECK(graph.chi2() == Approx(result.summary.final_chi2));
  }
  std::atomic<bool> cancel = true;
  OptimizerOptions options;
  options.cancel = &cancel;
  Graph graph = spoilt;
  const MultiStartSummary result =
      optimize_from_best_start(graph, registry.starts(), *registry.make_algorithm("dogleg"),
                               *registry.make_linear_solver("eigen"), options);
  CHECK(result.summary.termination == Termination::interrupted);
  CHECK(result.trials.size() == 1);
}

TEST_CASE(
    "default start: poses on one heap are no obstacle, and a single fix leaves the heading to the gauge") {
  const TypeRegistry registry = full_registry();
  const Graph drive = utm_drive(registry, "g1");
  Graph reference = drive;
  const double optimum = optimize_as_is(reference, registry, "dogleg").final_chi2;
  Graph heap = drive;
  for (VertexIndex v = 0; v < kPoses; ++v) heap.set_value(v, std::array{0.0, 0.0, 0.0});
  CHECK_THROWS_WITH(optimize_as_is(heap, registry, "dogleg"), Catch::Contains("2 of 3 rigid motions"));
  const MultiStartSummary result = optimize_default(heap, registry);
  CHECK(result.start == "linear");
  CHECK(result.summary.final_chi2 == Approx(optimum).epsilon(1e-9));
  CHECK(heap.chi2() == Approx(optimum).epsilon(1e-9));
  CHECK(result.summary.notes.front().find("initial guess file cannot be used: ") == 0);

  Graph one_fix = make_drive(registry, 100).graph;
  const VertexIndex origin = one_fix.add_vertex<VertexSe2>(VertexId{1000}, {0, 0, 0});
  one_fix.set_fixed(origin, true);
  one_fix.add_edge(EdgeGnssPosition{{5, 6}, {0, 0}}, {origin, 4}, Eigen::Matrix2d::Identity());
  // Such a graph has a minimum of 0 wherever its heading is.
  const MultiStartSummary turned = optimize_default(one_fix, registry);
  CHECK(turned.summary.converged());
  CHECK_THAT(turned.summary.notes.back(), Catch::Contains("2 of 3 rigid motions"));
  CHECK(one_fix.value(4)[0] == Approx(5));
}

TEST_CASE("default start: a start from which landmarks run away costs no graph that another one solves") {
  const TypeRegistry registry = full_registry();
  for (unsigned seed = 0; seed < 60; ++seed) {
    Graph graph = bearing_drive(seed);
    const MultiStartSummary result = optimize_default(graph, registry);
    CHECK(result.summary.final_chi2 <= 1e3 * plausible_chi2(graph));
  }
}

TEST_CASE("default start: without registered starts the values given are all there is") {
  const TypeRegistry registry = full_registry();
  Graph graph = noisy_circle(100);
  const MultiStartSummary result = optimize_from_best_start(graph, {}, *registry.make_algorithm("dogleg"),
                                                            *registry.make_linear_solver("eigen"), {});
  CHECK(result.start == "file");
  CHECK(result.summary.converged());
}

TEST_CASE("named start: each name begins where it says, with a search in place of the optimizer too") {
  const TypeRegistry registry = full_registry();
  const auto algorithm = registry.make_algorithm("dogleg");
  const auto solver = registry.make_linear_solver("eigen");
  const Graph given = noisy_circle(60);
  const double given_chi2 = given.chi2();
  std::vector<double> begun_at;
  const Minimizer search = [&](Graph& graph, Algorithm&, LinearSolver&, const OptimizerOptions&) {
    begun_at.push_back(graph.chi2());
    return Summary();
  };
  const auto from = [&](std::string_view start, const Minimizer& with) {
    Graph graph = noisy_circle(60);
    return optimize_from(start, graph, registry, *algorithm, *solver, {}, with);
  };
  CHECK(from(kFileStart, {}).start == "file");
  CHECK(from(kFileStart, {}).summary.initial_chi2 == Approx(given_chi2));
  CHECK(from("linear", {}).start == "linear");
  CHECK(from("linear", {}).summary.initial_chi2 < 0.5 * given_chi2);
  CHECK(from(kAutoStart, {}).trials.size() == 1);
  // chi2 of all edges is no judge of a search for outliers: it begins at the values of the graph.
  CHECK(from(kAutoStart, search).start == "file");
  CHECK(from("linear", search).start == "linear");
  REQUIRE(begun_at.size() == 2);
  CHECK(begun_at[0] == Approx(given_chi2));
  CHECK(begun_at[1] < 0.5 * given_chi2);
  CHECK_THROWS_WITH(
      from("nowhere", {}),
      "unknown initial guess 'nowhere'; there are: auto, file, linear, spanning_tree, odometry");
}

TEST_CASE("named start: one that cannot be computed is refused, parts that are apart are noted") {
  const TypeRegistry registry = full_registry();
  const auto algorithm = registry.make_algorithm("dogleg");
  const auto solver = registry.make_linear_solver("eigen");
  Graph lonely;
  lonely.add_vertex<VertexSe2>(VertexId{0}, {1, 2, 3});
  CHECK_THROWS_AS(optimize_from("odometry", lonely, registry, *algorithm, *solver, {}), InputError);
  Graph parts = noisy_circle(20);
  for (int i = 0; i < 3; ++i) parts.add_vertex<VertexSe2>(VertexId(100 + i), {0, 0, 0});
  for (VertexIndex v = 20; v < 22; ++v)
    parts.add_edge(EdgeSe2{{1, 0, 0}}, {v, v + 1}, pose_information(0.1, 0.1));
  const MultiStartSummary result = optimize_from("odometry", parts, registry, *algorithm, *solver, {});
  CHECK(result.summary.converged());
  CHECK_THAT(result.summary.notes.back(), Catch::StartsWith("3 vertices are not joined"));
}
}  // namespace multi_start_test
