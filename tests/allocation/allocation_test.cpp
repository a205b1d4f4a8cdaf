// After the first iteration nothing is allocated any more: requests for memory counted between iterations.
#include <cstdlib>
#include <vector>

#include <catch2/catch.hpp>

#include <waymark/core/optimize/optimizer.hpp>

#include "allocation/calibrated_problem.hpp"
#include "allocation/counting_allocator.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"

using namespace waymark;
using namespace waymark_test;

namespace {

constexpr int kIterations = 6;

/// Requests for memory in each iteration but the first.
std::vector<long> requests_per_iteration(const TypeRegistry& registry, Graph graph,
                                         const std::string& algorithm, const std::string& solver,
                                         int threads = 1) {
  std::vector<long> counts;
  counts.reserve(kIterations + 1);
  OptimizerOptions options;
  options.threads = threads;
  options.max_iterations = kIterations;
  options.decrement_tolerance = 1e-300;  // never converged: the message would be allocated
  options.gradient_tolerance = 0;
  options.step_tolerance = 0;
  options.observer = [&](const IterationRecord&) { counts.push_back(memory_requests()); };
  const auto method = registry.make_algorithm(algorithm);
  const auto backend = registry.make_linear_solver(solver);
  const Summary summary = optimize(graph, *method, *backend, options);
  INFO(summary.message);
  REQUIRE(counts.size() >= 3);
  std::vector<long> differences;
  for (std::size_t i = 1; i < counts.size(); ++i) differences.push_back(counts[i] - counts[i - 1]);
  return differences;
}

struct Problem {
  const char* name;
  Graph graph;
};

std::vector<Problem> problems(const TypeRegistry& registry) {
  std::vector<Problem> made;
  for (const char* modeling : {"g1", "g2"}) {
    Drive drive = make_drive(registry, 9000);
    drive.add_fixes(registry, modeling);
    made.push_back({modeling, std::move(drive.graph)});
  }
  made.push_back({"loops", grid_walk(3000, 50)});
  Graph robust = made.back().graph;
  robust.batch(0).set_loss(Loss{"huber", registry.find_loss("huber")->evaluate, 1});
  made.push_back({"loops with a robust loss", std::move(robust)});
  made.push_back({"dense calibration state", calibrated_problem(registry)});
  return made;
}

}  // namespace

TEST_CASE("allocation: the counter sees new, malloc and aligned_alloc") {
  const long before = memory_requests();
  const std::vector<double> numbers(100);
  const LargeArray<double> large(1'000'000);
  void* volatile memory = std::malloc(7);  // volatile: or the compiler leaves the pair out
  CHECK(memory_requests() - before >= 3);
  std::free(memory);
  CHECK(numbers.size() + large.size() == 1'000'100);
}

TEST_CASE("block Cholesky: no allocation in an iteration after the first, for any algorithm") {
  const TypeRegistry registry = full_registry();
  for (const Problem& problem : problems(registry)) {
    for (const auto& [algorithm, origin] : registry.algorithms()) {
      for (const int threads : {1, 2}) {
        INFO(problem.name << ", " << algorithm.name << ", " << threads << " threads");
        for (const long count :
             requests_per_iteration(registry, problem.graph, algorithm.name, "block_cholesky", threads))
          CHECK(count == 0);
      }
    }
  }
}
