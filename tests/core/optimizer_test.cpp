// The optimisation loop: its behaviour if a step fails, and its messages at the end.
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/detail/jump_watch.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/system/normal_equations.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/scalar_types.hpp"

namespace optimizer_test {

using namespace waymark;
using namespace waymark_test;
using Catch::Contains;

namespace {

std::vector<std::string> algorithm_names() {
  std::vector<std::string> names;
  for (const auto& [type, origin] : registry().algorithms()) names.push_back(type.name);
  return names;
}

Summary run(Graph& graph, const std::string& algorithm, const OptimizerOptions& options = {}) {
  return optimize(graph, *registry().make_algorithm(algorithm), *registry().make_linear_solver("eigen"),
                  options);
}

/// Works like the solver inside until the given number of factorisations, then fails for ever.
class FailingSolver final : public LinearSolver {
 public:
  explicit FailingSolver(int good) : good_(good), inner_(registry().make_linear_solver("eigen")) {}
  void analyze(const BlockPattern& pattern) override { inner_->analyze(pattern); }
  [[nodiscard]] FactorStatus factorize(std::span<const double> values) override {
    if (good_-- > 0) return inner_->factorize(values);
    failed = true;
    return FactorStatus::not_positive_definite;
  }
  void solve(std::span<const double> b, std::span<double> x) override {
    CHECK_FALSE(failed);  // nobody may solve with a factor that is not ok
    inner_->solve(b, x);
  }
  [[nodiscard]] std::int64_t factor_size() const override { return 0; }
  [[nodiscard]] std::string description() const override { return "failing"; }

  bool failed = false;

 private:
  int good_;
  std::unique_ptr<LinearSolver> inner_;
};

/// An error that is 1 at x = 1, hardly less from there on down, and jumps beyond.
struct EdgeJump {
  static constexpr std::string_view kTag = "EDGE_JUMP";
  static constexpr std::string_view kForm = "jump";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexScale>;
  static constexpr auto fields() {
    return std::array{field<&EdgeJump::slope>("slope"), field<&EdgeJump::beyond>("beyond")};
  }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& x) const {
    const T way = x - T(1.0);
    return Eigen::Matrix<T, 1, 1>(way > T(0.0) ? T(beyond) + T(slope) * way : T(1.0) - T(kFaint) * way);
  }

  static constexpr double kFaint = 1e-3;
  double slope = 0;
  double beyond = 0;
};

Graph jump_at_1(const EdgeJump& edge) {
  Graph graph;
  graph.add_vertex<VertexScale>(VertexId{0}, {1});
  graph.add_edge(edge, {0}, Eigen::Matrix<double, 1, 1>::Identity());
  return graph;
}

/// Proposes to go up by 1, after each rejection by half as much. Beyond the jump it goes up by 1, and
/// retreats where all is flat.
class HalvingSteps final : public Algorithm {
 public:
  void reset() override { length_ = 1; }
  [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver&, double,
                                       Step& step) override {
    const double gradient = std::abs(equations.gradient()[0]);
    if (gradient == 0) return ProposalStatus::retreat;
    step.delta = Eigen::VectorXd::Constant(1, gradient > 10 * EdgeJump::kFaint ? 1 : length_);
    step.predicted_decrease = EdgeJump::kFaint;
    step.newton_decrement = 1;
    step.full_newton = false;
    step.kind = "halved";
    return ProposalStatus::ok;
  }
  [[nodiscard]] bool acceptable(double gain_ratio) const override { return gain_ratio > 0; }
  void accepted(const Step&, double) override {}
  void rejected(const Step&, double) override { length_ /= 2; }

 private:
  double length_ = 1;
};

/// A measured scalar: e = x - measured.
struct EdgeMeasuredScale {
  static constexpr std::string_view kTag = "EDGE_MEASURED_SCALE";
  static constexpr std::string_view kForm = "difference";
  static constexpr int kErrorDimension = 1;
  using Vertices = VertexList<VertexScale>;
  static constexpr auto fields() { return std::array{field<&EdgeMeasuredScale::measured>("measured")}; }

  template <typename T>
  Eigen::Matrix<T, 1, 1> error(const T& x) const {
    return Eigen::Matrix<T, 1, 1>(x - T(measured));
  }

  double measured = 0;
};

/// One scalar unknown at x, e = x / sqrt(1 + x^2).
Graph sigmoid_at(double x) {
  Graph graph;
  const VertexIndex v = graph.add_vertex<VertexScale>(VertexId{0}, {x});
  graph.add_edge(EdgeSigmoid{}, {v}, Eigen::Matrix<double, 1, 1>::Identity());
  return graph;
}

}  // namespace

TEST_CASE("optimizer: no step of a failed factorisation is applied") {
  for (const std::string& name : algorithm_names()) {
    for (const int good : {0, 1, 2}) {
      INFO(name << ", factorisations before the failure: " << good);
      Graph graph = noisy_circle(30);
      const double start = graph.chi2();
      FailingSolver solver(good);
      const Summary summary = optimize(graph, *registry().make_algorithm(name), solver, {});
      CHECK(solver.failed);
      CHECK_FALSE(summary.converged());
      CHECK((summary.termination == Termination::singular || summary.termination == Termination::stalled));
      CHECK(summary.final_chi2 == Approx(graph.chi2()).epsilon(1e-13));
      CHECK(summary.final_chi2 <= start);
      CHECK(summary.iterations == static_cast<int>(summary.records.size()));
      if (good == 0) {
        CHECK(summary.iterations == 0);
        CHECK(graph.values() == noisy_circle(30).values());
      }
    }
  }
}

TEST_CASE("optimizer: a singular problem is named with its vertex") {
  Graph graph;
  const VertexIndex v = graph.add_vertex<VertexScale>(VertexId{77}, {0.5});
  graph.add_edge(EdgeSigmoid{}, {v}, Eigen::Matrix<double, 1, 1>::Zero());
  // g = 0 is a minimum already: give it a gradient by a second vertex.
  const VertexIndex w = graph.add_vertex<VertexScale>(VertexId{78}, {0.5});
  graph.add_edge(EdgeSigmoid{}, {w}, Eigen::Matrix<double, 1, 1>::Identity());
  const Summary summary = run(graph, "gauss_newton");
  CHECK(summary.termination == Termination::singular);
  CHECK_THAT(summary.message, Contains("not positive definite") && Contains("VERTEX_SCALE 77"));
}

TEST_CASE("optimizer: full steps that climb do not spoil the result") {
  // From x = 2 the Newton step of e = x / sqrt(1 + x^2) leads to -x^3 = -8, then to 512, ...
  Graph graph = sigmoid_at(2);
  const double start = graph.chi2();
  OptimizerOptions options;
  options.max_iterations = 2;
  const Summary summary = run(graph, "gauss_newton", options);
  REQUIRE(summary.records.size() == 2);
  CHECK(summary.records[0].decrease < 0);
  CHECK(summary.termination == Termination::max_iterations);
  CHECK(graph.value(0)[0] == 2);
  CHECK(summary.final_chi2 == start);
}

TEST_CASE("optimizer: a stationary point above the best values is no convergence") {
  // The same steps go on to infinity, where the sigmoid is flat; returned is the start, which is no
  // minimum.
  Graph graph = sigmoid_at(2);
  const double start = graph.chi2();
  const Summary summary = run(graph, "gauss_newton");
  CHECK_FALSE(summary.converged());
  CHECK_THAT(summary.message, Contains("the lowest chi2 on the way"));
  CHECK(graph.value(0)[0] == 2);
  CHECK(summary.final_chi2 == start);
}

TEST_CASE("optimizer: an algorithm that climbed goes back to the lowest chi2 by retreating") {
  // Full steps from x = 2 climb: -8, 512. The next proposal must see x = 2 again.
  class Climber final : public Algorithm {
   public:
    void reset() override { proposals_ = 0; }
    [[nodiscard]] ProposalStatus propose(const NormalEquations& equations, LinearSolver& solver, double,
                                         Step& step) override {
      gradients.push_back(equations.gradient()[0]);
      if (++proposals_ == 3) return ProposalStatus::retreat;
      if (proposals_ > 3 || solver.factorize(equations.hessian()) != FactorStatus::ok)
        return ProposalStatus::exhausted;
      step.delta = -equations.gradient();
      solver.solve({equations.gradient().data(), 1}, {step.delta.data(), 1});
      step.delta = -step.delta;
      step.predicted_decrease = 1;
      step.full_newton = false;
      return ProposalStatus::ok;
    }
    [[nodiscard]] bool acceptable(double) const override { return true; }
    void accepted(const Step&, double) override {}
    void rejected(const Step&, double) override {}

    std::vector<double> gradients;

   private:
    int proposals_ = 0;
  };
  Graph graph = sigmoid_at(2);
  Climber climber;
  const Summary summary = optimize(graph, climber, *registry().make_linear_solver("eigen"), {});
  REQUIRE(climber.gradients.size() == 4);
  CHECK(climber.gradients[1] != climber.gradients[0]);
  CHECK(climber.gradients[3] == climber.gradients[0]);
  CHECK(summary.termination == Termination::stalled);
  CHECK(graph.value(0)[0] == 2);
}

TEST_CASE("optimizer: a crossing of a jump that ends where all is flat is counted as futile") {
  // Steps are rejected 11 times, until there is no progress of 10 steps; then once and 6 times, then once and
  // 12 times.
  Graph graph = jump_at_1({.slope = 0, .beyond = 2});
  HalvingSteps steps;
  const Summary summary = optimize(graph, steps, *registry().make_linear_solver("eigen"), {});
  CHECK(summary.termination == Termination::stalled);
  CHECK_THAT(summary.message, Contains("chi2 jumps by 3"));  // 2^2 - 1^2
  CHECK(summary.iterations == 11 + 7 + 13);
  CHECK(graph.value(0)[0] == 1);
}

TEST_CASE("optimizer: steps beyond a jump that were undone are no progress on this side") {
  // Beyond the jump 15 steps lower chi2 from 3^2 to 2.25^2 and are undone. The next crossing is as soon as
  // the watch has patience for, once and 6 times.
  Graph graph = jump_at_1({.slope = -0.05, .beyond = 3});
  HalvingSteps steps;
  const Summary summary = optimize(graph, steps, *registry().make_linear_solver("eigen"), {});
  std::vector<int> crossings;
  for (const IterationRecord& record : summary.records)
    if (record.accepted && record.decrease < 0) crossings.push_back(record.iteration);
  CHECK(crossings == std::vector{11, 11 + 15 + 7, 11 + 15 + 7 + 15 + 13});
}

TEST_CASE(
    "jump watch: rejections begin anew after a noticeable progress, not after steps that crawl to the jump") {
  detail::JumpWatch watch;
  for (const double length : {1.0, 0.4, 0.2}) CHECK_FALSE(watch.rejected(length, 5, 100));
  for (const double length : {0.1, 0.04, 0.02}) CHECK_FALSE(watch.rejected(length, 5, 98));
  CHECK(watch.rejected(0.01, 5, 97.5));  // the third one shorter than half the first at 98
}

TEST_CASE("optimizer: damped and truncated methods find the minimum where full steps diverge") {
  for (const std::string name : {"levenberg_marquardt", "dogleg"}) {
    INFO(name);
    Graph graph = sigmoid_at(2);
    const Summary summary = run(graph, name);
    CHECK(summary.converged());
    CHECK(graph.value(0)[0] == Approx(0).margin(1e-5));
    for (const IterationRecord& record : summary.records) {  // full steps may climb on trial
      if (record.accepted && record.kind != "newton") CHECK(record.decrease >= 0);
    }
  }
}

TEST_CASE("optimizer: convergence is declared on full Newton steps or at the gradient only") {
  for (const std::string& name : algorithm_names()) {
    for (const double start : {0.1, 0.5, 2.0}) {
      INFO(name << " from " << start);
      Graph graph = sigmoid_at(start);
      const Summary summary = run(graph, name);
      if (!summary.converged()) continue;
      if (summary.termination == Termination::converged_gradient) {
        CHECK_THAT(summary.message, Contains("gradient"));
      } else {
        REQUIRE_FALSE(summary.records.empty());
        CHECK(summary.records.back().kind == "newton");
        CHECK(summary.records.back().newton_decrement <=
              OptimizerOptions().decrement_tolerance * (1 + summary.final_chi2) * 1.0001);
      }
    }
    Graph circle = noisy_circle(40);
    const Summary summary = run(circle, name);
    REQUIRE(summary.converged());
    CHECK(summary.records.back().kind == "newton");
  }
}

TEST_CASE("optimizer: records and summary agree with each other and with the graph") {
  for (const std::string& name : algorithm_names()) {
    INFO(name);
    Graph graph = noisy_circle(40);
    const double start = graph.chi2();
    std::vector<int> seen;
    OptimizerOptions options;
    options.observer = [&](const IterationRecord& record) { seen.push_back(record.iteration); };
    const Summary summary = run(graph, name, options);
    CHECK(summary.initial_chi2 == Approx(start).epsilon(1e-13));
    CHECK(summary.final_chi2 == Approx(graph.chi2()).epsilon(1e-13));
    CHECK(summary.vertices == 40);
    CHECK(summary.edges == 47);
    CHECK(summary.unknowns == 117);
    CHECK(summary.error_forms == "EDGE_SE2 (t, theta)");
    CHECK_THAT(summary.solver, Contains("eigen"));
    CHECK(summary.factor_size >= 117);
    REQUIRE(seen.size() == summary.records.size());
    for (std::size_t i = 0; i < seen.size(); ++i) CHECK(seen[i] == static_cast<int>(i) + 1);
    double chi2 = start;
    for (const IterationRecord& record : summary.records) {
      CHECK(record.decrease == Approx(chi2 - record.chi2).epsilon(1e-9).margin(1e-9));
      CHECK(record.predicted_decrease > 0);
      if (record.accepted) chi2 = record.chi2;
    }
  }
}

TEST_CASE("optimizer: where reweighting converges slowly, the whole curvature of the losses ends the run") {
  // Cauchy's loss of two values at -0.9 and 0.9: log(1 + (x - 0.9)^2) + log(1 + (x + 0.9)^2) has its minimum at 0.
  // Reweighted steps leave 1 - (1 - 0.81) / 1.81 = 0.9 of the distance there.
  for (const std::string& name : algorithm_names()) {
    INFO(name);
    Graph graph;
    const VertexIndex x = graph.add_vertex<VertexScale>(VertexId{0}, {0.3});
    for (const double measured : {-0.9, 0.9})
      graph.add_edge(EdgeMeasuredScale{measured}, {x}, Eigen::Matrix<double, 1, 1>::Identity(),
                     builtin_loss("cauchy", 1));
    const Summary summary = run(graph, name);
    CHECK(summary.converged());
    CHECK(summary.iterations < 25);  // reweighted ones to the same tolerance: 0.3 0.9^n < 0.01 from n = 32 on
    CHECK(std::abs(graph.value(x)[0]) < 1e-4);
    CHECK(summary.final_chi2 == Approx(2 * std::log(1.81)));
  }
}

TEST_CASE("optimizer: an outlier that makes up all of chi2 ends no run far from the minimum") {
  // The same two values, whose minimum is x = 0, beside y, which is drawn from 0 to 10,000 by a loss: y = 1 there, and
  // chi2 is 20,000. A millionth of it is more than all steps of x together can gain.
  for (const std::string& name : algorithm_names()) {
    INFO(name);
    const auto unit = Eigen::Matrix<double, 1, 1>::Identity();
    Graph graph;
    const VertexIndex x = graph.add_vertex<VertexScale>(VertexId{0}, {0.3});
    const VertexIndex y = graph.add_vertex<VertexScale>(VertexId{1}, {0.9});
    for (const double measured : {-0.9, 0.9})
      graph.add_edge(EdgeMeasuredScale{measured}, {x}, unit, builtin_loss("cauchy", 1));
    graph.add_edge(EdgeMeasuredScale{0}, {y}, unit);
    graph.add_edge(EdgeMeasuredScale{1e4}, {y}, unit, builtin_loss("huber", 1));
    const Summary summary = run(graph, name);
    CHECK(summary.converged());
    CHECK(std::abs(graph.value(x)[0]) < 0.01);
    CHECK(graph.value(y)[0] == Approx(1).epsilon(1e-4));
  }
}

TEST_CASE("optimizer: the cancel token ends the run with the best values so far") {
  for (const std::string& name : algorithm_names()) {
    INFO(name);
    Graph graph = noisy_circle(60);
    const double start = graph.chi2();
    std::atomic<bool> cancel = false;
    OptimizerOptions options;
    options.cancel = &cancel;
    options.observer = [&](const IterationRecord& record) { cancel = record.iteration >= 2; };
    const Summary summary = run(graph, name, options);
    CHECK(summary.termination == Termination::interrupted);
    CHECK_FALSE(summary.converged());
    CHECK(summary.iterations == 2);
    CHECK_THAT(summary.message, Contains("interrupted after 2"));
    CHECK(summary.final_chi2 == Approx(graph.chi2()).epsilon(1e-13));
    CHECK(summary.final_chi2 < start);
  }
}

TEST_CASE("optimizer: cancelled before the first step nothing has moved") {
  Graph graph = noisy_circle(20);
  const std::atomic<bool> cancel = true;
  OptimizerOptions options;
  options.cancel = &cancel;
  CHECK(run(graph, "dogleg", options).termination == Termination::interrupted);
  CHECK(graph.values() == noisy_circle(20).values());
}

TEST_CASE("optimizer: max_iterations is kept and said, zero means only looking") {
  for (const std::string& name : algorithm_names()) {
    for (const int most : {0, 1, 2}) {
      INFO(name << " " << most);
      Graph graph = noisy_circle(40);
      OptimizerOptions options;
      options.max_iterations = most;
      const Summary summary = run(graph, name, options);
      CHECK(summary.termination == Termination::max_iterations);
      CHECK_FALSE(summary.converged());
      CHECK(summary.iterations == most);
      CHECK_THAT(summary.message, Contains("not converged after " + std::to_string(most)));
      if (most == 0) CHECK(graph.values() == noisy_circle(40).values());
    }
  }
}

TEST_CASE("optimizer: a start that is not finite is said and left as it is") {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Graph graph = sigmoid_at(1);
    graph.set_value(0, std::array{bad});
    const Summary summary = run(graph, "levenberg_marquardt");
    CHECK(summary.termination == Termination::non_finite);
    CHECK_THAT(summary.message, Contains("the initial guess is not finite"));
    CHECK(summary.iterations == 0);

    Graph circle = noisy_circle(10);
    circle.set_value(4, std::array{1.0, bad, 0.0});
    CHECK(run(circle, "gauss_newton").termination == Termination::non_finite);
  }
}

TEST_CASE("optimizer: a step into values that are not finite is never kept") {
  // e = sqrt(x) - 0.2: the full step from x = 4 leads to x = -3.2, where the error is NaN.
  for (const std::string& name : algorithm_names()) {
    INFO(name);
    Graph graph;
    const VertexIndex v = graph.add_vertex<VertexScale>(VertexId{0}, {4});
    graph.add_edge(EdgeRoot{0.2}, {v}, Eigen::Matrix<double, 1, 1>::Identity());
    const Summary summary = run(graph, name);
    CHECK(std::isfinite(graph.value(v)[0]));
    CHECK(std::isfinite(summary.final_chi2));
    if (name != "gauss_newton") {
      CHECK(summary.converged());
      CHECK(graph.value(v)[0] == Approx(0.04).epsilon(1e-4));
    } else {
      CHECK_FALSE(summary.converged());
      CHECK(graph.value(v)[0] == 4);
    }
  }
}

TEST_CASE("optimizer: nothing to do is an outcome of its own") {
  SECTION("every vertex fixed") {
    Graph graph = noisy_circle(5);
    for (VertexIndex v = 0; v < 5; ++v) graph.set_fixed(v, true);
    const Summary summary = run(graph, "dogleg");
    CHECK(summary.termination == Termination::nothing_to_do);
    CHECK(summary.final_chi2 == Approx(graph.chi2()));
    CHECK(summary.unknowns == 0);
  }
  SECTION("vertices without edges") {
    Graph graph;
    graph.add_vertex<VertexSe2>(VertexId{0}, {1, 2, 3});
    CHECK(run(graph, "gauss_newton").termination == Termination::nothing_to_do);
  }
  SECTION("empty graph") {
    Graph graph;
    CHECK(run(graph, "levenberg_marquardt").termination == Termination::nothing_to_do);
  }
}

TEST_CASE("optimizer: a start that is the minimum ends without moving far") {
  for (const std::string& name : algorithm_names()) {
    INFO(name);
    Graph graph = noisy_circle(40);
    run(graph, name);
    const std::vector<double> minimum = graph.values();
    const Summary again = run(graph, name);
    CHECK(again.converged());
    CHECK(again.iterations <= 1);
    for (std::size_t i = 0; i < minimum.size(); ++i)
      CHECK(graph.values()[i] == Approx(minimum[i]).margin(1e-6));
  }
}

TEST_CASE("optimizer: equal input gives equal bits, also with algorithm and solver used before") {
  for (const std::string& name : algorithm_names()) {
    INFO(name);
    const auto algorithm = registry().make_algorithm(name);
    const auto solver = registry().make_linear_solver("eigen");
    Graph first = noisy_circle(40);
    Graph second = noisy_circle(40);
    optimize(first, *algorithm, *solver, {});
    Graph other = noisy_circle(25, 9);
    optimize(other, *algorithm, *solver, {});
    optimize(second, *algorithm, *solver, {});
    CHECK(first.values() == second.values());
  }
}

TEST_CASE("optimizer: wrong options are named with value and rule") {
  Graph graph = noisy_circle(5);
  OptimizerOptions options;
  SECTION("max_iterations") {
    options.max_iterations = -1;
    CHECK_THROWS_WITH(run(graph, "dogleg", options), Contains("max_iterations = -1") && Contains(">= 0"));
  }
  SECTION("decrement_tolerance") {
    options.decrement_tolerance = 0;
    CHECK_THROWS_WITH(run(graph, "dogleg", options), Contains("decrement_tolerance = 0") && Contains("> 0"));
  }
  SECTION("gradient_tolerance") {
    options.gradient_tolerance = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(run(graph, "dogleg", options), UsageError);
  }
  SECTION("step_tolerance") {
    options.step_tolerance = -1e-3;
    CHECK_THROWS_WITH(run(graph, "dogleg", options), Contains("step_tolerance"));
  }
}

TEST_CASE("options of algorithms: unknown names, words and numbers out of range are explained") {
  CHECK_THROWS_WITH(registry().make_algorithm("newton"),
                    Contains("unknown algorithm 'newton'") && Contains("gauss_newton") && Contains("dogleg"));
  CHECK_THROWS_WITH(registry().make_linear_solver("lu"),
                    Contains("unknown linear solver 'lu'") && Contains("eigen"));
  CHECK_THROWS_WITH(registry().make_algorithm("gauss_newton", {{"radius", "1"}}),
                    Contains("gauss_newton: unknown option 'radius'") && Contains("none"));
  CHECK_THROWS_WITH(registry().make_algorithm("dogleg", {{"trust", "1"}}), Contains("initial_radius"));
  CHECK_THROWS_WITH(registry().make_algorithm("dogleg", {{"initial_radius", "1e13"}}),
                    Contains("'initial_radius' must lie in [1e-6, 1e12], got 1e13"));
  CHECK_THROWS_WITH(registry().make_algorithm("levenberg_marquardt", {{"initial_damping", "much"}}),
                    Contains("'initial_damping' must be a number, got 'much'"));
  CHECK_THROWS_WITH(registry().make_algorithm("levenberg_marquardt", {{"scaling", "none"}}),
                    Contains("'marquardt' or 'identity'") && Contains("got 'none'"));
}

TEST_CASE("optimizer: a graph of faint edges has the minimum of the same graph with strong ones") {
  for (const std::string& name : algorithm_names()) {
    for (const double information : {1e-20, 1e-200, 1e20}) {
      INFO(name << ", information " << information);
      Graph graph;
      const VertexIndex origin = graph.add_vertex<VertexSe2>(VertexId{0}, {0, 0, 0});
      const VertexIndex pose = graph.add_vertex<VertexSe2>(VertexId{1}, {5, 5, 1});
      graph.set_fixed(origin, true);
      graph.add_edge(EdgeSe2{{1, 2, 0.5}}, {origin, pose}, information * Eigen::Matrix3d::Identity());
      const Summary summary = run(graph, name);
      INFO(summary.message);
      CHECK(summary.converged());
      CHECK(graph.value(pose)[0] == Approx(1).margin(1e-6));
      CHECK(graph.value(pose)[1] == Approx(2).margin(1e-6));
      CHECK(graph.value(pose)[2] == Approx(0.5).margin(1e-6));
    }
  }
}

}  // namespace optimizer_test
