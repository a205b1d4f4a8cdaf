#include <waymark/tools/benchmark/benchmark_report.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::benchmark {
namespace {

std::vector<double> collect(const std::vector<RunOutcome>& runs, double RunOutcome::*member) {
  std::vector<double> values;
  for (const RunOutcome& run : runs) values.push_back(run.*member);
  return values;
}

CellSummary summarize_cell(const std::string& start, const Cell& cell) {
  CellSummary s;
  s.start = start;
  s.name = cell.name;
  s.solver = cell.solver;
  s.peer = cell.peer;
  s.memory_before_mb = cell.memory_before_mb;
  s.memory_peak_mb = cell.memory_peak_mb;
  s.run_seconds = collect(cell.runs, &RunOutcome::total_seconds);
  s.seconds = spread_of(s.run_seconds);
  s.setup_seconds = spread_of(collect(cell.runs, &RunOutcome::setup_seconds));
  const RunOutcome& middle = cell.runs[index_of_median(s.run_seconds)];
  s.structure_seconds = middle.structure_seconds;
  s.linearize_seconds = middle.linearize_seconds;
  s.solve_seconds = middle.solve_seconds;
  s.rest_seconds = std::max(
      0.0, middle.total_seconds - middle.structure_seconds - middle.linearize_seconds - middle.solve_seconds);
  s.solver_description = middle.solver_description;
  s.iterations = middle.iterations;
  s.converged = middle.converged;
  s.message = middle.message;
  s.notes = middle.notes;
  s.initial_chi2 = middle.initial_chi2;
  s.final_chi2 = middle.final_chi2;
  return s;
}

}  // namespace

std::vector<CellSummary> summarize_cells(const std::string& start, const std::vector<Cell>& cells) {
  std::vector<CellSummary> summaries;
  for (const Cell& cell : cells) summaries.push_back(summarize_cell(start, cell));
  for (const CellSummary& peer : summaries) {
    if (!peer.peer) continue;
    for (CellSummary& own : summaries) {
      if (own.peer) continue;
      std::vector<double> ratios;
      for (std::size_t r = 0; r < own.run_seconds.size(); ++r)
        ratios.push_back(peer.run_seconds[r] / own.run_seconds[r]);
      own.peer_ratios.emplace_back(peer.name, spread_of(std::move(ratios)).median);
    }
  }
  return summaries;
}

void judge_cells(FileSummary& file, const KnownOptima& known) {
  const auto listed = known.find(file.file);
  file.optimum_listed = listed != known.end();
  file.optimum = file.optimum_listed ? listed->second : std::numeric_limits<double>::infinity();
  for (const CellSummary& cell : file.cells) {
    if (!file.optimum_listed && std::isfinite(cell.final_chi2))
      file.optimum = std::min(file.optimum, cell.final_chi2);
  }
  for (CellSummary& cell : file.cells) cell.optimality = compare_with_optimum(cell.final_chi2, file.optimum);
}

}  // namespace waymark::benchmark
