// What the algorithms and solvers of plugins tell is not believed blindly: a step or a solution that cannot be right is
// told with its plugin, instead of ending as a minimum.
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/normal_equations.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

namespace guarded_models_test {

using namespace waymark;
using namespace waymark_test;
using Catch::Contains;

namespace {

/// A full Newton step, spoiled afterwards.
class Spoiling final : public Algorithm {
 public:
  using Spoil = std::function<ProposalStatus(Step&)>;
  explicit Spoiling(Spoil spoil) : spoil_(std::move(spoil)) {}
  void reset() override {}
  ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver, double,
                         Step& step) override {
    if (solver.factorize(equations.hessian()) != FactorStatus::ok) return ProposalStatus::singular;
    step.delta = -equations.gradient();
    const std::span<double> delta(step.delta.data(), static_cast<std::size_t>(step.delta.size()));
    solver.solve(delta, delta);
    step.full_newton = true;
    step.kind = "newton";
    step.predicted_decrease = step.newton_decrement = -step.delta.dot(equations.gradient());
    return spoil_(step);
  }
  bool acceptable(double gain_ratio) const override { return gain_ratio > 0; }
  void accepted(const Step&, double) override {}
  void rejected(const Step&, double) override {}

 private:
  Spoil spoil_;
};

/// A solver of ours with a spoiled solution.
class SpoilingSolver final : public LinearSolver {
 public:
  SpoilingSolver(std::unique_ptr<LinearSolver> sound, double factor)
      : sound_(std::move(sound)), factor_(factor) {}
  void analyze(const BlockPattern& pattern) override { sound_->analyze(pattern); }
  FactorStatus factorize(std::span<const double> values) override { return sound_->factorize(values); }
  void solve(std::span<const double> b, std::span<double> x) override {
    sound_->solve(b, x);
    for (double& value : x) value *= factor_;
  }
  std::int64_t factor_size() const override { return sound_->factor_size(); }
  std::string description() const override { return "spoiled"; }

 private:
  std::unique_ptr<LinearSolver> sound_;
  double factor_;
};

Summary optimize_by(const Spoiling::Spoil& spoil) {
  TypeRegistry registry = full_registry();
  registry.set_origin("mine");
  registry.add_algorithm(
      {"spoiled", "", {}, [&](const CheckedOptions&) { return std::make_unique<Spoiling>(spoil); }});
  Graph graph = grid_walk(50, 5);
  OptimizerOptions options;
  options.max_iterations = 20;
  return optimize(graph, *registry.make_algorithm("spoiled"), *registry.make_linear_solver("block_cholesky"),
                  options);
}

Summary optimize_by_solver(double factor) {
  TypeRegistry registry = full_registry();
  registry.set_origin("mine");
  registry.add_linear_solver({"spoiled", "", {}, [factor](const CheckedOptions&) {
                                return std::make_unique<SpoilingSolver>(
                                    full_registry().make_linear_solver("block_cholesky"), factor);
                              }});
  Graph graph = grid_walk(50, 5);
  return optimize(graph, *registry.make_algorithm("gauss_newton"), *registry.make_linear_solver("spoiled"),
                  {});
}

}  // namespace

TEST_CASE("guarded models: an algorithm and a solver of a plugin that are sound reach the minimum") {
  CHECK(optimize_by([](Step&) { return ProposalStatus::ok; }).converged());
  CHECK(optimize_by_solver(1).converged());
}

TEST_CASE("guarded models: a step that cannot be right is told with the plugin, and is no minimum") {
  const auto told = [](const Spoiling::Spoil& spoil, const std::string& what) {
    CHECK_THROWS_MATCHES(optimize_by(spoil), PluginError,
                         Catch::Matchers::Predicate<PluginError>(
                             [&](const PluginError& error) {
                               const std::string message = error.what();
                               return message.starts_with("plugin 'mine': algorithm 'spoiled': ") &&
                                      message.find(what) != std::string::npos;
                             },
                             what));
  };
  told([](Step& step) { return step.delta.resize(0), ProposalStatus::ok; },
       "a step of 0 numbers for 147 unknowns");
  told([](Step& step) { return step.delta.conservativeResize(146), ProposalStatus::ok; },
       "a step of 146 numbers");
  told(
      [](Step& step) { return step.delta[3] = std::numeric_limits<double>::quiet_NaN(), ProposalStatus::ok; },
      "not finite");
  told(
      [](Step& step) {
        step.delta = -step.delta;
        step.predicted_decrease = -step.predicted_decrease;
        return ProposalStatus::ok;
      },
      "raises chi2 by its own model");
  told([](Step& step) { return step.newton_decrement = -1, ProposalStatus::ok; }, "Newton decrement below 0");
  told([](Step&) { return ProposalStatus::retreat; }, "again without a step between");
}

TEST_CASE("guarded models: a solution of the wrong sign, or none, is told with the plugin") {
  CHECK_THROWS_WITH(optimize_by_solver(-1),
                    Contains("plugin 'mine': linear solver 'spoiled': ") && Contains("sign"));
  CHECK_THROWS_WITH(optimize_by_solver(std::nan("")), Contains("'spoiled': ") && Contains("not finite"));
}

}  // namespace guarded_models_test
