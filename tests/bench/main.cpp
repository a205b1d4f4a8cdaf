// Benchmarks of everything but optimisation, by name: see README.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numeric>
#include <optional>
#include <string>

#include <benchmark/benchmark.h>

#include <waymark/core/covariance/marginals.hpp>
#include <waymark/core/optimize/optimizer.hpp>
#include <waymark/core/window/incremental.hpp>
#include <waymark/formats/graph/graph_document.hpp>

#include "bench/live.hpp"
#include "bench/logs.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/replay.hpp"

using namespace waymark;
using namespace waymark::formats;

namespace {

enum class Problem { drive, grid };

/// A G1 drive with a fix every 25 poses, or a grid pose graph; made once per size.
const Graph& problem(Problem kind, std::int64_t poses) {
  static std::map<std::pair<Problem, std::int64_t>, Graph> made;
  const auto [place, fresh] = made.try_emplace({kind, poses});
  if (!fresh) return place->second;
  const int count = static_cast<int>(poses);
  if (kind == Problem::drive) {
    waymark_test::Drive drive = waymark_test::make_drive(waymark_test::registry(), count);
    drive.add_fixes(waymark_test::registry(), "g1");
    place->second = std::move(drive.graph);
  } else {
    place->second = waymark_test::grid_walk(count, static_cast<int>(std::sqrt(static_cast<double>(count))));
  }
  return place->second;
}

void read(benchmark::State& state, Problem kind) {
  GraphDocument document;
  document.graph = problem(kind, state.range(0));
  const std::string text = write_graph(document, waymark_test::registry());
  for (auto _ : state) benchmark::DoNotOptimize(read_graph(text, "bench.graph", waymark_test::registry()));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}

/// The yardstick of `read` on any machine: every number of the same text by strtod, kept nowhere.
void read_strtod(benchmark::State& state, Problem kind) {
  GraphDocument document;
  document.graph = problem(kind, state.range(0));
  const std::string text = write_graph(document, waymark_test::registry());
  for (auto _ : state) {
    double sum = 0;
    for (const char* place = text.c_str(); *place != '\0';) {
      char* stop = nullptr;
      const double number = std::strtod(place, &stop);
      if (stop == place) {  // a word, or the end of the text
        place += std::strcspn(place, " \n");
        place += std::strspn(place, " \n");
      } else {
        sum += number;
        place = stop;
      }
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}

void write(benchmark::State& state, Problem kind) {
  GraphDocument document;
  document.graph = problem(kind, state.range(0));
  std::size_t size = 0;
  for (auto _ : state) {
    size = 0;
    write_graph(document, waymark_test::registry(),
                [&size](std::string_view piece) { size += piece.size(); });
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(size));
}

void marginals(benchmark::State& state, Problem kind) {
  const Graph& graph = problem(kind, state.range(0));
  std::vector<VertexIndex> all(graph.vertex_count());
  std::iota(all.begin(), all.end(), 0);
  for (auto _ : state) benchmark::DoNotOptimize(marginal_covariances(graph, all));
}

void copy_graph(benchmark::State& state, Problem kind) {
  const Graph& graph = problem(kind, state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(Graph(graph));
}

/// One pose more, one step of Gauss-Newton, and the oldest pose marginalised, in a window of so many poses:
/// with the structure that follows, or started over at every pose.
void window(benchmark::State& state, Problem kind, const std::string& how) {
  const Graph& source = problem(kind, 105'000);
  std::vector<VertexIndex> order(source.vertex_count());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(), [&](VertexIndex v) { return source.fixed(v); });
  const auto last = static_cast<VertexIndex>(state.range(0));
  OptimizerOptions options;
  options.max_iterations = 1;
  waymark_test::Replay replay(source, order);
  Graph graph;
  const auto make = [&] {
    return IncrementalOptimizer(graph, waymark_test::registry().make_algorithm("gauss_newton"),
                                waymark_test::registry().make_linear_solver("block_cholesky"), options);
  };
  std::optional<IncrementalOptimizer> optimizer(make());
  while (static_cast<VertexIndex>(graph.vertex_count()) <= last) replay.append_to(graph);
  for (auto _ : state) {
    (void)replay.append_to(graph);
    if (how == "anew") optimizer.emplace(make());
    if (!std::isfinite(optimizer->update().final_chi2)) state.SkipWithError("not finite");
    optimizer->drop_prefix(static_cast<VertexIndex>(graph.vertex_count()) - last);
    if (replay.done()) {
      state.SkipWithError("the drive is over");
      break;
    }
  }
}

/// NAME/PROBLEM/POSES, each at a small size and at the size of an hour and more of driving.
void register_all() {
  struct Sized {
    Problem kind;
    const char* name;
    std::array<std::int64_t, 2> poses;
  };
  constexpr Sized kProblems[] = {{Problem::drive, "drive", {2000, 105'000}},
                                 {Problem::grid, "grid", {2000, 20'000}}};
  for (const Sized& sized : kProblems) {
    const auto add = [&](const std::string& name, auto run) {
      auto* made =
          benchmark::RegisterBenchmark((name + "/" + sized.name).c_str(),
                                       [=, kind = sized.kind](benchmark::State& state) { run(state, kind); });
      made->Unit(benchmark::kMillisecond);
      for (const std::int64_t poses : sized.poses) made->Arg(poses);
    };
    add("read", &read);
    add("read_strtod", &read_strtod);
    add("write", &write);
    add("marginals", &marginals);
    add("copy", &copy_graph);
  }
  for (const std::string how : {"follow", "anew"}) {
    auto* made =
        benchmark::RegisterBenchmark(("window/drive/" + how).c_str(),
                                     [how](benchmark::State& state) { window(state, Problem::drive, how); });
    made->Unit(benchmark::kMillisecond)->Arg(1000)->Arg(2000);
  }
}

}  // namespace

int main(int argc, char** argv) {
  register_all();
  waymark_bench::register_log_benchmarks();
  waymark_bench::register_live_benchmarks();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
