#include <waymark/tools/benchmark/measure.hpp>

#include <waymark/tools/benchmark/process_memory.hpp>

namespace waymark::benchmark {
namespace {

void measure_memory(const Graph& start, const Contestant& contestant, Cell& cell) {
  Graph graph = start;
  cell.memory_before_mb = restart_peak_memory();
  (void)contestant.run(graph);
  if (cell.memory_before_mb) cell.memory_peak_mb = peak_megabytes();
}

}  // namespace

std::vector<Cell> measure(const Graph& start, std::span<const Contestant> contestants,
                          const MeasureOptions& options) {
  std::vector<Cell> cells;
  const auto cancelled = [&] { return options.cancel != nullptr && *options.cancel; };
  for (const Contestant& contestant : contestants) {
    options.progress("memory " + contestant.name);
    Cell& cell = cells.emplace_back(Cell{contestant.name, contestant.solver, contestant.peer, {}});
    measure_memory(start, contestant, cell);
    if (cancelled()) return {};
  }
  for (int r = 1; r <= options.repetitions; ++r) {
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      options.progress(std::to_string(r) + "/" + std::to_string(options.repetitions) + " " +
                       contestants[c].name);
      Graph graph = start;
      cells[c].runs.push_back(contestants[c].run(graph));
      if (cancelled()) return {};
    }
  }
  return cells;
}

}  // namespace waymark::benchmark
