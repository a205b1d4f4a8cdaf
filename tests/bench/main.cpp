// Benchmarks of the hot paths by name: see README.md.
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
#include <waymark/core/system/gauge.hpp>
#include <waymark/core/window/incremental.hpp>
#include <waymark/formats/graph/graph_document.hpp>

#include "bench/logs.hpp"
#include "support/problems.hpp"
#include "support/registry.hpp"
#include "support/replay.hpp"

using namespace waymark;
using namespace waymark::formats;

namespace {

enum class Problem { drive, grid };

const TypeRegistry& registry() {
  static const TypeRegistry value = waymark_test::full_registry();
  return value;
}

/// A G1 drive with a fix every 25 poses, or a grid pose graph; made once per size.
const Graph& problem(Problem kind, std::int64_t poses) {
  static std::map<std::pair<Problem, std::int64_t>, Graph> made;
  const auto [place, fresh] = made.try_emplace({kind, poses});
  if (!fresh) return place->second;
  const int count = static_cast<int>(poses);
  if (kind == Problem::drive) {
    waymark_test::Drive drive = waymark_test::make_drive(registry(), count);
    drive.add_fixes(registry(), "g1");
    place->second = std::move(drive.graph);
  } else {
    place->second = waymark_test::grid_walk(count, static_cast<int>(std::sqrt(static_cast<double>(count))));
  }
  return place->second;
}

/// A problem ready for numbers.
struct Prepared {
  explicit Prepared(const Graph& g) : graph(g), equations(graph, structure) {
    structure.build(graph, find_gauge(graph).held);
    equations.linearize(graph.values());
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  const Graph& graph;
  Structure structure;
  NormalEquations equations;
};

void linearize(benchmark::State& state, Problem kind) {
  Prepared prepared(problem(kind, state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(prepared.equations.linearize(prepared.graph.values()));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(prepared.graph.edge_count()));
}

void chi2(benchmark::State& state, Problem kind) {
  const Graph& graph = problem(kind, state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(graph.chi2());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(graph.edge_count()));
}

void gauge(benchmark::State& state, Problem kind) {
  const Graph& graph = problem(kind, state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(find_gauge(graph));
}

void structure(benchmark::State& state, Problem kind) {
  const Graph& graph = problem(kind, state.range(0));
  const std::vector<char> held = find_gauge(graph).held;
  for (auto _ : state) {
    Structure made;
    made.build(graph, held);
    benchmark::DoNotOptimize(made.pattern().value_count());
  }
}

void analyze(benchmark::State& state, Problem kind, const std::string& name) {
  const Prepared prepared(problem(kind, state.range(0)));
  const auto solver = registry().make_linear_solver(name);
  for (auto _ : state) solver->analyze(prepared.structure.pattern());
}

void factorize(benchmark::State& state, Problem kind, const std::string& name) {
  const Prepared prepared(problem(kind, state.range(0)));
  const auto solver = registry().make_linear_solver(name);
  solver->analyze(prepared.structure.pattern());
  for (auto _ : state) {
    if (solver->factorize(prepared.equations.hessian()) != FactorStatus::ok)
      state.SkipWithError("not definite");
  }
  state.counters["factor"] = static_cast<double>(solver->factor_size());
}

void solve(benchmark::State& state, Problem kind, const std::string& name) {
  const Prepared prepared(problem(kind, state.range(0)));
  const auto solver = registry().make_linear_solver(name);
  solver->analyze(prepared.structure.pattern());
  if (solver->factorize(prepared.equations.hessian()) != FactorStatus::ok)
    state.SkipWithError("not definite");
  Eigen::VectorXd x = prepared.equations.gradient();
  const std::span<const double> b(prepared.equations.gradient().data(), static_cast<std::size_t>(x.size()));
  for (auto _ : state) solver->solve(b, {x.data(), static_cast<std::size_t>(x.size())});
}

void run_optimizer(benchmark::State& state, Problem kind, const std::string& algorithm,
                   const std::string& solver) {
  const Graph& start = problem(kind, state.range(0));
  Summary summary;
  for (auto _ : state) {
    state.PauseTiming();
    Graph graph = start;
    state.ResumeTiming();
    summary =
        optimize(graph, *registry().make_algorithm(algorithm), *registry().make_linear_solver(solver), {});
  }
  if (!summary.converged()) state.SkipWithError(summary.message.c_str());
  state.counters["iterations"] = summary.iterations;
  state.counters["chi2"] = summary.final_chi2;
}

void read(benchmark::State& state, Problem kind) {
  GraphDocument document;
  document.graph = problem(kind, state.range(0));
  const std::string text = write_graph(document, registry());
  for (auto _ : state) benchmark::DoNotOptimize(read_graph(text, "bench.graph", registry()));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}

/// The yardstick of `read` on any machine: every number of the same text by strtod, kept nowhere.
void read_strtod(benchmark::State& state, Problem kind) {
  GraphDocument document;
  document.graph = problem(kind, state.range(0));
  const std::string text = write_graph(document, registry());
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
    write_graph(document, registry(), [&size](std::string_view piece) { size += piece.size(); });
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
    return IncrementalOptimizer(graph, registry().make_algorithm("gauss_newton"),
                                registry().make_linear_solver("block_cholesky"), options);
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

/// NAME/PROBLEM[/PARAMETERS]/POSES, each at a small size and at that of the key workload.
void register_all() {
  struct Sized {
    Problem kind;
    const char* name;
    std::array<std::int64_t, 2> poses;
  };
  constexpr Sized kProblems[] = {{Problem::drive, "drive", {2000, 105'000}},
                                 {Problem::grid, "grid", {2000, 20'000}}};
  for (const Sized& sized : kProblems) {
    const auto add = [&](const std::string& name, auto run, auto... parameter) {
      const std::string full = name + "/" + sized.name + (std::string() + ... + ("/" + parameter));
      auto* made = benchmark::RegisterBenchmark(
          full.c_str(), [=, kind = sized.kind](benchmark::State& state) { run(state, kind, parameter...); });
      made->Unit(benchmark::kMillisecond);
      for (const std::int64_t poses : sized.poses) made->Arg(poses);
    };
    add("linearize", &linearize);
    add("chi2", &chi2);
    add("gauge", &gauge);
    add("structure", &structure);
    add("read", &read);
    add("read_strtod", &read_strtod);
    add("write", &write);
    add("marginals", &marginals);
    add("copy", &copy_graph);
    for (const auto& [solver, origin] : registry().linear_solvers()) {
      add("analyze", &analyze, solver.name);
      add("factorize", &factorize, solver.name);
      add("solve", &solve, solver.name);
    }
    for (const auto& [algorithm, origin] : registry().algorithms()) {
      add("optimize", &run_optimizer, algorithm.name, std::string("eigen"));
    }
    for (const auto& [solver, origin] : registry().linear_solvers()) {
      if (solver.name != "eigen") add("optimize", &run_optimizer, std::string("gauss_newton"), solver.name);
    }
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
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
