// The dogleg's options: its own scaled norm and relative radius, and g2o's.
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/base/error.hpp>
#include <waymark/core/optimize/optimizer.hpp>

#include "support/problems.hpp"
#include "support/registry.hpp"

namespace dogleg_options_test {

using namespace waymark;
using namespace waymark_test;

namespace {

std::vector<IterationRecord> run_dogleg(Graph graph, const Options& options, int iterations) {
  const TypeRegistry registry = full_registry();
  OptimizerOptions limits;
  limits.max_iterations = iterations;
  return optimize(graph, *registry.make_algorithm("dogleg", options),
                  *registry.make_linear_solver("block_cholesky"), limits)
      .records;
}

/// Length of the first step over all unknowns, metres and radians alike.
double first_step_length(const Graph& start, const Options& options) {
  Graph graph = start;
  const TypeRegistry registry = full_registry();
  OptimizerOptions one;
  one.max_iterations = 1;
  const Summary summary = optimize(graph, *registry.make_algorithm("dogleg", options),
                                   *registry.make_linear_solver("eigen"), one);
  REQUIRE(summary.records.front().accepted);
  double square = 0;
  for (std::size_t i = 0; i < graph.values().size(); ++i) {
    const double change = graph.values()[i] - start.values()[i];
    square += std::pow(i % 3 == 2 ? wrap_angle(change) : change, 2);
  }
  return std::sqrt(square);
}

}  // namespace

TEST_CASE("dogleg: an absolute radius in the plain norm is the length of a truncated step") {
  const Graph start = noisy_circle(60);
  for (const std::string radius : {"0.01", "0.1"}) {
    const Options options = {{"scaling", "none"}, {"radius", "absolute"}, {"initial_radius", radius}};
    const double asked = std::stod(radius);
    CHECK(run_dogleg(start, options, 1).front().control == asked);
    CHECK(first_step_length(start, options) == Approx(asked).epsilon(1e-9));
  }
}

TEST_CASE("dogleg: a radius of 1e4 truncates nothing small, so the first step is Gauss-Newton's") {
  const Options g2o = {{"scaling", "none"}, {"radius", "absolute"}, {"initial_radius", "1e4"}};
  const IterationRecord step = run_dogleg(noisy_circle(60), g2o, 1).front();
  CHECK(step.kind == "newton");
  CHECK(step.control == 1e4);
}

TEST_CASE(
    "dogleg: an absolute radius is halved by a poor or failed step and grows to three times a good one") {
  // Headings all over: the model of Gauss-Newton is wrong there.
  Graph start = noisy_circle(60);
  std::vector<double> values = start.values();
  for (std::size_t i = 2; i < values.size(); i += 3) values[i] = wrap_angle(1.7 * static_cast<double>(i));
  start.set_values(values);
  const auto records =
      run_dogleg(start, {{"scaling", "none"}, {"radius", "absolute"}, {"initial_radius", "1e4"}}, 60);
  REQUIRE(records.size() > 2);
  int halved = 0;
  for (std::size_t i = 1; i < records.size(); ++i) {
    const double ratio = records[i - 1].decrease / records[i - 1].predicted_decrease;
    INFO("step " << i << ", gain ratio " << ratio);
    if (!records[i - 1].accepted || ratio < 0.25) {
      CHECK(records[i].control == 0.5 * records[i - 1].control);
      ++halved;
    } else {
      CHECK(records[i].control >= records[i - 1].control);
    }
  }
  CHECK(halved > 0);
}

TEST_CASE("dogleg: options that mean nothing are refused by name") {
  const TypeRegistry registry = full_registry();
  CHECK_THROWS_AS(registry.make_algorithm("dogleg", {{"scaling", "marquardt"}}), UsageError);
  CHECK_THROWS_AS(registry.make_algorithm("dogleg", {{"radius", "relative"}}), UsageError);
  CHECK_THROWS_AS(registry.make_algorithm("dogleg", {{"initial_radius", "1e13"}}), UsageError);
}

}  // namespace dogleg_options_test
