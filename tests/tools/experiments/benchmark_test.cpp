// Statistics and judgement of the benchmark.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <limits>

#include <waymark/core/base/error.hpp>
#include <waymark/tools/benchmark/benchmark_report.hpp>
#include <waymark/tools/benchmark/process_memory.hpp>
#include <waymark/types_se2/vertex_se2.hpp>

#include "support/skip.hpp"

namespace benchmark_test {

using namespace waymark;
using namespace waymark::benchmark;

TEST_CASE("benchmark: the median is the middle value, or the mean of the two in the middle") {
  const Spread odd = spread_of({5, 1, 3});
  CHECK(odd.median == 3);
  CHECK(odd.least == 1);
  CHECK(odd.largest == 5);
  CHECK(spread_of({4, 1, 2, 100}).median == 3);
  CHECK(index_of_median({5, 1, 3}) == 2);
  CHECK(index_of_median({4, 1, 2, 100}) == 2);
  CHECK_THROWS_AS(spread_of({}), UsageError);
}

TEST_CASE("benchmark: an optimum is reached within a millionth, below it the list is wrong") {
  CHECK(compare_with_optimum(100.00009, 100) == Optimality::reached);
  CHECK(compare_with_optimum(99.99991, 100) == Optimality::reached);
  CHECK(compare_with_optimum(100.0002, 100) == Optimality::above);
  CHECK(compare_with_optimum(99.9998, 100) == Optimality::lower);
  CHECK(compare_with_optimum(std::numeric_limits<double>::quiet_NaN(), 100) == Optimality::above);
  CHECK(compare_with_optimum(7e-13, 5e-13) == Optimality::reached);
  CHECK(compare_with_optimum(1e-6, 0) == Optimality::above);
}

TEST_CASE("benchmark: phases are those of the median run, ratios are paired run by run") {
  Cell own{"dogleg", "eigen", false, {}};
  Cell peer{"ceres", "", true, {}};
  // A slow moment of the machine in the second repetition meets both: the ratio does not see it.
  for (const double slow : {1.0, 10.0, 1.1}) {
    own.runs.push_back({.total_seconds = slow, .structure_seconds = 0.1 * slow, .solve_seconds = 0.5 * slow});
    peer.runs.push_back({.total_seconds = 3 * slow, .setup_seconds = 0.2});
  }
  const std::vector<CellSummary> cells = summarize_cells("file", {own, peer});
  CHECK(cells[0].seconds.median == 1.1);
  CHECK(cells[0].structure_seconds == Approx(0.11));
  CHECK(cells[0].rest_seconds == Approx(0.44));
  REQUIRE(cells[0].peer_ratios.size() == 1);
  CHECK(cells[0].peer_ratios[0].first == "ceres");
  CHECK(cells[0].peer_ratios[0].second == Approx(3));
  CHECK(cells[1].setup_seconds.median == 0.2);
  CHECK(cells[1].peer_ratios.empty());
}

TEST_CASE("benchmark: every run starts from a fresh copy, all contestants in turn") {
  Graph graph;
  graph.add_vertex<VertexXy>(VertexId{0}, {1.0, 2.0});
  std::string order;
  const auto contestant = [&](char name) {
    return Contestant{std::string(1, name), "", false, [&order, name](Graph& g) {
                        order += name;
                        CHECK(g.value(0)[0] == 1);
                        g.set_value(0, std::array{9.0, 9.0});
                        return RunOutcome{};
                      }};
  };
  const std::vector<Contestant> contestants = {contestant('A'), contestant('B')};
  const std::vector<Cell> cells = measure(graph, contestants, {.repetitions = 3});
  CHECK(order == "ABABABAB");  // the first pair measures memory
  REQUIRE(cells.size() == 2);
  CHECK(cells[0].runs.size() == 3);
  const std::atomic<bool> cancel{true};
  CHECK(measure(graph, contestants, {.cancel = &cancel}).empty());
}

TEST_CASE("benchmark: the peak of memory begins anew and sees what was taken and given back") {
  const auto before = restart_peak_memory();
  if (!before) {
    waymark_test::skip("/proc does not let the peak begin anew here");
    return;
  }
  {
    const std::vector<char> taken(50'000'000, 'x');
    REQUIRE(std::count(taken.begin(), taken.end(), 'x') == 50'000'000);
  }
  const auto peak = peak_megabytes();
  REQUIRE(peak);
  CHECK(*peak > *before + 45);
  const auto after = restart_peak_memory();
  REQUIRE(after);
  CHECK(*peak_megabytes() < *after + 25);  // of the memory resident then: a sanitizer keeps freed memory
}

}  // namespace benchmark_test
