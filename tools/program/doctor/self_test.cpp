#include <waymark/tools/program/doctor/self_test.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/tools/drive/description/fusion_settings.hpp>
#include <waymark/types_se2/edge_se2.hpp>

namespace waymark::program {
namespace {

constexpr int kPoses = 40;
constexpr int kClosure = 7;  ///< poses from one end of a closure to the other
constexpr double kRadius_m = 20;
/// Rounding in sums of a hundred squares is far below this.
constexpr double kAgreement = 1e-9;

/// Returns the place of pose i at the minimum.
Pose2<double> pose_at(int i) {
  const double angle = 2 * std::numbers::pi * i / kPoses;
  return {kRadius_m * std::cos(angle), kRadius_m * std::sin(angle), wrap_angle(angle + std::numbers::pi / 2)};
}

SelfTest test_on_known_problem(const std::string& name, const std::string& algorithm,
                               const std::string& solver, const TypeRegistry& registry) {
  SelfTest test{name, 0, {}};
  try {
    KnownProblem problem = known_problem();
    const auto minimizer = registry.make_algorithm(algorithm);
    const auto backend = registry.make_linear_solver(solver);
    OptimizerOptions options;
    options.decrement_tolerance = 1e-12;
    const Summary summary = optimize(problem.graph, *minimizer, *backend, options);
    test.chi2 = summary.final_chi2;
    if (!summary.converged()) {
      test.problem = "did not converge: " + summary.message;
    } else if (!(std::abs(test.chi2 - problem.minimum) <= kAgreement * problem.minimum)) {
      test.problem = fmt::format("ended at chi2 {:.12g}; the minimum is {:.12g}", test.chi2, problem.minimum);
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // plugins may throw anything
    test.problem = error.what();
  }
  return test;
}

}  // namespace

KnownProblem known_problem() {
  KnownProblem problem;
  const Eigen::Vector3d weights(400, 400, 9000);
  const Eigen::Matrix3d information = weights.asDiagonal();
  for (int i = 0; i < kPoses; ++i) {
    const Pose2<double> pose = pose_at(i);
    const double away =
        // the initial guess is wrong by some decimetres and degrees
        i == 0 ? 0 : 0.3 * std::sin(1.7 * i);
    problem.graph.add_vertex<VertexSe2>(VertexId(i), {pose.position[0] + away, pose.position[1] - away,
                                                      wrap_angle(pose.heading + 0.2 * away)});
  }
  problem.graph.set_fixed(0, true);
  for (int i = 0; i + 1 < kPoses; ++i) {
    const Eigen::Vector3d mean = between(pose_at(i), pose_at(i + 1)).vector();
    const Eigen::Vector3d apart(0.02 * std::sin(i), 0.02 * std::cos(i), 0.005 * std::sin(2 * i));
    problem.graph.add_edge(EdgeSe2{mean + apart}, {i, i + 1}, information);
    problem.graph.add_edge(EdgeSe2{mean - apart}, {i, i + 1}, information);
    problem.minimum += 2 * apart.dot(weights.cwiseProduct(apart));
  }
  for (int i = 0; i + kClosure < kPoses; i += 3) {
    problem.graph.add_edge(EdgeSe2{between(pose_at(i), pose_at(i + kClosure)).vector()}, {i, i + kClosure},
                           information);
  }
  return problem;
}

std::vector<SelfTest> test_solvers(const TypeRegistry& registry) {
  std::vector<SelfTest> tests;
  for (const auto& [solver, origin] : registry.linear_solvers())
    tests.push_back(
        test_on_known_problem(solver.name, drive::Minimization().algorithm, solver.name, registry));
  return tests;
}

std::vector<SelfTest> test_algorithms(const TypeRegistry& registry) {
  std::vector<SelfTest> tests;
  const std::string solver = registry.linear_solvers().front().type.name;
  for (const auto& [algorithm, origin] : registry.algorithms())
    tests.push_back(test_on_known_problem(algorithm.name, algorithm.name, solver, registry));
  return tests;
}

}  // namespace waymark::program
